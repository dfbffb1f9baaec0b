"""Grains in space at chosen moments: their surfaces, shaded, in the colour of the pressure behind them."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from .. import NotRecorded, colours, view
from ..stress_unit import unit_for
from .stages import choose_stages, headings
from .style import DOUBLE_COLUMN, GREY, MM

MOST_PANELS = 4
HEADING, KEY = 9, 16  # [mm]: above the panels, right of them

def draw_space(run):
    """The surfaces of all grains, by parallel projection. Raises NotRecorded where snapshots have none."""
    snapshots = [(stage, run[stage.snapshot]) for stage in choose_stages(run, run.times)] if len(run) else []
    snapshots = [(stage, snapshot) for stage, snapshot in snapshots if "quad" in snapshot.surface]
    if not snapshots:
        raise NotRecorded("no snapshot has surfaces: those are of runs with experiment.dimension = 3")
    if len(snapshots) > MOST_PANELS:
        snapshots = [snapshots[k] for k in np.linspace(0, len(snapshots) - 1, MOST_PANELS).round().astype(int)]
    range_ = range_of_pressures([snapshot for _, snapshot in snapshots])
    x0, x1, y0, y1 = view.extent([snapshot for _, snapshot in snapshots])
    width = (DOUBLE_COLUMN - KEY) / len(snapshots)
    height = min(width * (y1 - y0) / (x1 - x0), 120)
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, (height + HEADING) * MM))
    page = DOUBLE_COLUMN, height + HEADING
    for column, (words, (_, snapshot)) in enumerate(zip(headings([stage for stage, _ in snapshots]), snapshots)):
        axes = figure.add_axes((column * width / page[0], 0, width / page[0], height / page[1]))
        axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
        axes.set_axis_off()
        draw_surfaces(axes, snapshot, range_)
        figure.text((column + 0.5) * width / page[0], 0.99, words, ha="center", va="top")
    add_key(figure, range_, ((DOUBLE_COLUMN - KEY + 1) / page[0], 0.15, 2.5 / page[0], 0.6))
    return figure


def range_of_pressures(snapshots):
    """One range of colours [Pa] for all of them, without the outermost 1 %. Raises NotRecorded where none has surfaces."""
    pressures = [snapshot.surface["pressure"] for snapshot in view.with_surfaces(snapshots)]
    low, high = np.quantile(np.concatenate(pressures), (0.01, 0.99))
    return colours.Range("viridis", min(0.0, low), max(high, 1e-6))


def add_key(figure, range_, place):
    """The colours and their pressures, at (x, y, width, height) as shares of the figure."""
    shades = ListedColormap(range_.rgb(np.linspace(range_.low, range_.high, 256)))
    unit = unit_for(range_.low, range_.high)
    scale = Normalize(range_.low / unit.pascal, range_.high / unit.pascal)
    figure.colorbar(ScalarMappable(scale, shades), cax=figure.add_axes(place), label=f"pressure [{unit.name}]")


def draw_surfaces(axes, snapshot, range_, **look):
    """Faces that look at us, the farthest first; behind them the edges of the walls. look: of all collections."""
    walls = view.walls(snapshot)
    if len(walls) > 2:
        axes.add_collection(LineCollection([face[list(edge)] for face in walls for edge in view.EDGES], colors=GREY, linewidths=0.4, **look))
    else:
        axes.add_collection(PolyCollection(walls, facecolors="#DDDDDD", edgecolors=GREY, linewidths=0.4, **look))
    faces = view.faces(snapshot)
    colour = range_.rgb(snapshot.surface["pressure"][faces.quad]) * faces.shade[:, None]
    axes.add_collection(PolyCollection(faces.corners, facecolors=colour, edgecolors=colour, linewidths=0.15, **look))
