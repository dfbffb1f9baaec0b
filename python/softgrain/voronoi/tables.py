"""Cells and their faces as text; headers name columns and units as in series.csv."""

import numpy as np

from .cells import Cells


def write_cells(snapshot, cells: Cells, file):
    """One line for each grain: where it lies, its volume, that of its cell, the one over the other, how many neighbours."""
    place = snapshot.bodies()
    size = "m^3" if place.shape[1] == 3 else "m^2"
    columns = {"grain": np.arange(len(cells.volume)), **{f"{axis}[m]": x for axis, x in zip("xyz", place.T)},
               f"volume[{size}]": cells.grain_volume, f"cell_volume[{size}]": cells.volume, "phi": cells.phi,
               "neighbours": cells.neighbours}
    _write(columns, file)


def write_faces(snapshot, cells: Cells, file):
    """One line for each side of a face that two cells, or a cell and a wall, have in common."""
    units = {"area": "[m^2]" if "normal_z" in cells.faces else "[m]"}
    _write({name + units.get(name, ""): values for name, values in cells.faces.items()}, file)


def _write(columns, file):
    file.write(",".join(columns) + "\n")
    cells = [[f"{value:.9g}" for value in np.asarray(values).tolist()] for values in columns.values()]
    file.writelines(",".join(row) + "\n" for row in zip(*cells))
