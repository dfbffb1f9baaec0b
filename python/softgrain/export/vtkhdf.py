"""Frames as one VTKHDF file, which VTK and ParaView open with all its times: particles and the shapes of grains."""

import itertools
from typing import NamedTuple

import numpy as np

from ..picture import outlines

VERTEX, POLYGON, QUAD = 1, 7, 9  # cell types of VTK
STATIC, TEMPORAL = (1, 0), (2, 0)  # version of the format: steps came with 2.0
NO_FIELDS = ("position", "radius", "grain")


class Grid(NamedTuple):
    """An unstructured grid: particles as vertices, then outlines as polygons, in space surfaces as quadrilaterals."""

    points: np.ndarray  # (n, 3) [m]
    connectivity: np.ndarray  # points of all cells, one cell after the other
    offsets: np.ndarray  # (cells + 1,): where those of each cell begin
    types: np.ndarray  # (cells,)
    point_data: dict  # name -> (n,) or (n, k)
    cell_data: dict  # name -> (cells,)


def write_vtkhdf(snapshots, path):
    """An UnstructuredGrid of one frame (format 1.0: VTK 9.1), or of many with their times [s] (2.0: VTK 9.3).

    Points carry radius [m], grain, and the fields that all frames have; a vertex of an outline has radius 0 and the
    means of its grain. Cells carry grain, shape (0 particle, 1 outline) and, where one knows it, pressure [Pa]; in space
    only surfaces have one.
    Source: VTKHDF format specification, sections "Unstructured grid" and "Temporal Data" (docs.vtk.org)."""
    import h5py

    fields = set.intersection(*(set(s.particles) for s in snapshots)).difference(NO_FIELDS)
    grids = [grid_of(snapshot, sorted(fields)) for snapshot in snapshots]
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array(TEMPORAL if len(grids) > 1 else STATIC, "i8")
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        counts = {"Points": [len(g.points) for g in grids], "Cells": [len(g.types) for g in grids],
                  "ConnectivityIds": [len(g.connectivity) for g in grids]}
        for name, count in counts.items():
            root[f"NumberOf{name}"] = np.array(count, "i8")
        for name in ("points", "connectivity", "offsets", "types"):
            _put(root, name.capitalize(), [getattr(g, name) for g in grids])
        for group, data in (("PointData", [g.point_data for g in grids]), ("CellData", [g.cell_data for g in grids])):
            for name in data[0]:
                _put(root, f"{group}/{name}", [values[name] for values in data])
        if len(grids) > 1:
            _put_steps(root, [s.time for s in snapshots], counts)


def grid_of(snapshot, fields=()):
    """Of one frame; a plane one lies at z = 0."""
    particles = snapshot.particles
    count = len(particles["position"])
    grain = np.asarray(particles.get("grain", np.zeros(count))).astype("i8")
    corners, shapes, owner, kind = _shapes(snapshot)
    points = np.concatenate([_in_space(particles["position"]), _in_space(corners)])
    offsets = np.cumsum([0, *itertools.repeat(1, count), *map(len, shapes)])
    connectivity = np.concatenate([np.arange(count), *(count + shape for shape in shapes)])
    of_corner = np.zeros(len(corners), "i8")
    for shape, number in zip(shapes, owner):
        of_corner[shape] = number
    radius = np.asarray(particles.get("radius", np.zeros(count)), float)
    point_data = {"radius": np.append(radius, np.zeros(len(corners))), "grain": np.append(grain, of_corner)}
    for name in fields:
        values = np.asarray(particles[name])
        point_data[name] = np.concatenate([values, _means(grain, radius, values)[of_corner]]) if len(corners) else values
    cell_data = {"grain": np.append(grain, owner), "shape": np.repeat(np.array([0, 1], "u1"), [count, len(shapes)])}
    pressure = _pressure_of_shapes(snapshot, grain, radius, owner)
    if pressure is not None:
        cell_data["pressure"] = np.append(particles.get("pressure", np.full(count, np.nan)), pressure)
    types = np.repeat(np.array([VERTEX, kind], "u1"), [count, len(shapes)])
    return Grid(points, connectivity.astype("i8"), offsets.astype("i8"), types, point_data, cell_data)


def _shapes(snapshot):
    """Corners, the numbers of those of each shape, its grain, and the type of its cell."""
    if "quad" in snapshot.surface:
        owner = snapshot.surface.get("grain", np.zeros(len(snapshot.surface["quad"])))
        return snapshot.outlines["position"], list(snapshot.surface["quad"].astype("i8")), owner.astype("i8"), QUAD
    rims = outlines(snapshot)
    corners = np.concatenate([rim for _, rim in rims]) if rims else np.empty((0, 2))
    begins = np.cumsum([0] + [len(rim) for _, rim in rims])
    shapes = [np.arange(*ends) for ends in itertools.pairwise(begins)]
    return corners, shapes, np.array([grain for grain, _ in rims], "i8"), POLYGON


def _pressure_of_shapes(snapshot, grain, radius, owner):
    """That of a surface, or the mean of its grain [Pa]; None where no pressure is known."""
    if "pressure" in snapshot.surface:
        return snapshot.surface["pressure"]
    pressure = snapshot.particles.get("pressure")
    return None if pressure is None else _means(grain, radius, pressure)[owner]


def _means(grain, radius, values):
    """Of a field over each grain, by the sizes of its particles; whole numbers, which are marks, stay whole."""
    weight = np.maximum(radius, np.finfo(float).tiny) ** 2
    total = np.bincount(grain, weight)
    columns = [np.bincount(grain, weight * column) / np.where(total > 0, total, 1) for column in np.atleast_2d(values.T)]
    means = np.column_stack(columns) if values.ndim > 1 else columns[0]
    return np.rint(means).astype(values.dtype) if np.issubdtype(values.dtype, np.integer) else means


def _in_space(positions):
    return np.column_stack([positions, np.zeros((len(positions), 3 - positions.shape[1]))])


def _put(root, name, parts):
    values = np.concatenate(parts)
    root.create_dataset(name, data=values, compression="gzip" if len(values) > 1000 else None)


def _put_steps(root, times, counts):
    """Where each frame begins in arrays that hold all of them, one part a frame."""
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = len(times)
    steps["Values"] = np.array(times, float)
    steps["PartOffsets"] = np.arange(len(times))
    steps["NumberOfParts"] = np.ones(len(times), "i8")
    starts = {name: np.cumsum([0, *count[:-1]]) for name, count in counts.items()}
    steps["PointOffsets"] = starts["Points"]
    steps["CellOffsets"] = starts["Cells"][:, None]
    steps["ConnectivityIdOffsets"] = starts["ConnectivityIds"][:, None]
    for name in root["PointData"]:
        steps[f"PointDataOffsets/{name}"] = starts["Points"]
    for name in root["CellData"]:
        steps[f"CellDataOffsets/{name}"] = starts["Cells"]
