"""Figures for publication from the directories of runs. On the command line: `softgrain plot DIR...`."""

from .curve import draw_curve
from .die import draw_die, draw_heckel, draw_kawakita, draw_profile
from .diagnostics import draw_diagnostics
from .grain import draw_grain
from .packing import draw_packing
from .shear import draw_shear
from .space import draw_space
from .style import save, style
from .voronoi import draw_voronoi

__all__ = ["draw_curve", "draw_diagnostics", "draw_die", "draw_grain", "draw_heckel", "draw_kawakita", "draw_packing", "draw_profile", "draw_shear", "draw_space", "draw_voronoi", "save", "style"]
