"""Set-Voronoi cells: local packing fractions and neighbours. On the command line: `softgrain voronoi RUN`."""

from .cells import Cells, cells_of
from .tables import write_cells, write_faces

__all__ = ["Cells", "cells_of", "write_cells", "write_faces"]
