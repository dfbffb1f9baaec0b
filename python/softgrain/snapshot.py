"""The state of a run at one time. SI units."""

import itertools
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from . import voronoi


@dataclass(frozen=True, repr=False)
class Snapshot:
    """The state at one time: what can be drawn. Arrays are indexed by particle, by contact or by wall.

    `contacts["pair"]` counts particles, then walls; of elastic grains, whose particles are material points, grains, then walls."""

    step: int
    time: float  # [s]
    particles: dict  # position (n, 2) [m], radius (n,) [m], and any field by particle
    contacts: dict = field(default_factory=dict)  # pair (m, 2), force (m,), tangential_force (m,) [N/m];
    #                                               of elastic grains total_force, normal, position (m, 2) instead of the last
    walls: np.ndarray = field(default_factory=lambda: np.empty((0, 4)))  # x0 y0 x1 y1 [m], or edges of a periodic cell
    outlines: dict = field(default_factory=dict)  # position (v, 2) [m], grain (v,): counter-clockwise polygons
    surface: dict = field(default_factory=dict)  # in space: quad (q, 4) of the outlines' vertices, grain (q,), pressure (q,) [Pa];
    #                                              walls (w, 12): four corners each [m]
    points: dict = field(default_factory=dict)  # in space, of surfaces near others: vertex (k,) and grain (k,) of each, patch (k,) or
    #                                             edge (k,), sorted by its ends, whose middle it is, or -1, facing (k,) grain or -1,
    #                                             wall (k,) or -1, gap (k,) [m], pushes (k,)
    cell: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))  # lattice vectors of a periodic cell, one a row [m]

    @property
    def contacts_of_grains(self) -> bool:
        """Whether contacts are between grains instead of between particles."""
        return "position" in self.contacts

    def __repr__(self) -> str:
        """Names and sizes, no arrays."""
        parts = [f"{name}: {', '.join(arrays)} ({len(next(iter(arrays.values())))})" for name, arrays in
                 (("particles", self.particles), ("contacts", self.contacts), ("outlines", self.outlines)) if arrays]
        return f"<Snapshot of step {self.step}, {self.time:.6g} s; {'; '.join([*parts, f'walls: {len(self.walls)}'])}>"

    def contact_table(self) -> dict[str, np.ndarray]:
        """Columns a, b, wall, grain_a, grain_b, normal_x, normal_y, x, y [m], normal_force, tangential_force [N/m], in space [N]:
        `pandas.DataFrame(snapshot.contact_table())`; what they mean: softgrain.export.contacts."""
        from .export.contacts import contact_table

        return contact_table(self)

    def voronoi(self, points: int | None = None) -> "voronoi.Cells":
        """Set-Voronoi cells of the grains: volumes, local packing fractions, neighbours (softgrain.voronoi). Needs SciPy."""
        from .voronoi import cells

        return cells.cells_of(self, points or cells.POINTS)

    def images(self) -> np.ndarray:
        """(m, 2) or (m, 3) [m]: from what is shown to its next images across the edges of a periodic cell, the first of all itself."""
        steps = [(0, 1, -1) if np.any(vector) else (0,) for vector in self.cell]
        return np.array([np.array(n) @ self.cell for n in itertools.product(*steps)]) if steps else np.zeros_like(self.particles["position"][:1])

    def bodies(self) -> np.ndarray:
        """Where what `contacts["pair"]` counts lies, walls left out (n, 2) [m]: particles, or the centres of elastic grains."""
        position = self.particles["position"]
        if not self.contacts_of_grains:
            return position
        grain, area = self.particles["grain"], self.particles["radius"] ** 2
        sums = [np.bincount(grain, area * x) for x in position.T]
        return np.column_stack(sums) / np.bincount(grain, area)[:, None]

    def body_radii(self) -> np.ndarray:
        """Radii of bodies() [m]; of an elastic grain that of a disk of its present area."""
        radius = self.particles["radius"]
        return np.sqrt(np.bincount(self.particles["grain"], radius**2)) if self.contacts_of_grains else radius

    @classmethod
    def read(cls, path: str | Path) -> "Snapshot":
        """Reads one snapshot file. Raises OSError if it is damaged or missing."""
        with open_hdf5(path) as file:
            if "scene/particles/position" not in file:
                raise OSError(f"{path}: no snapshot: it has no /scene/particles/position")
            scene = file["scene"]
            walls = scene["walls"][()] if "walls" in scene else ()
            contacts = _arrays(scene, "contacts")
            if "checkpoint/contact_impulse" in file and "force" in contacts:
                contacts |= _tangential_force(contacts["force"], file["checkpoint/contact_impulse"][()])
            outlines, surface = _arrays(scene, "outlines"), _arrays(scene, "surface")
            return cls(
                step=int(file.attrs.get("step", 0)),
                time=float(file.attrs.get("time", 0)),
                particles=_arrays(scene, "particles"),
                contacts=contacts,
                walls=np.asarray(walls, float).reshape(-1, 4),
                outlines=outlines,
                surface=surface,
                points=_points_near_others(file, outlines, surface) if "quad" in surface else {},
                cell=scene["cell"][()] if "cell" in scene else np.empty((0, 2)),
            )


def open_hdf5(path):
    """To read, without a lock: snapshots never change, and not every file system has locks."""
    import h5py

    try:
        return h5py.File(path, "r", locking=False)
    except (TypeError, ValueError):  # h5py before 3.5, HDF5 before 1.10.7: the environment may say so
        return h5py.File(path, "r")


def _arrays(scene, name):
    if name not in scene:
        return {}
    arrays = {key: data[()] for key, data in scene[name].items()}
    # A scalar field may be stored as one column.
    return {key: a[:, 0] if a.ndim == 2 and a.shape[1] == 1 else a for key, a in arrays.items()}


def _points_near_others(file, outlines, surface):
    """From the checkpoint of grains in space, whose contacts are (point, vertex, wall, 16 vertices of the patch that it faces).

    Up to version 0.2 the middle of a patch that met a rigid sphere had the sphere's centre as its vertex, and its own patch."""
    if not {"contact_bodies", "contact_impulse", "contact_places"} <= file.get("checkpoint", {}).keys():
        return {}
    bodies = file["checkpoint/contact_bodies"][()].astype(int).reshape(-1, 19)
    point, vertex, wall, patch_vertex = bodies[:, 0], bodies[:, 1], bodies[:, 2], bodies[:, 3 + 5]
    grain, vertices, patches = outlines["grain"].astype(int), len(outlines["grain"]), len(surface["grain"])
    patch = np.where((point >= vertices) & (point < vertices + patches), point - vertices, -1)
    edge = np.where(point >= vertices + patches, point - vertices - patches, -1)
    turned = (patch >= 0) & (surface["grain"].astype(int)[patch] != grain[vertex])
    own, facing = np.where(turned, patch_vertex, vertex), np.where(turned, vertex, patch_vertex)
    return {"vertex": own, "grain": grain[own], "patch": patch, "edge": edge, "wall": wall,
            "pushes": file["checkpoint/contact_impulse"][()].reshape(-1, 3)[:, 0] > 0,
            "gap": file["checkpoint/contact_places"][()].reshape(-1, 20)[:, 3],
            "facing": np.where(wall < 0, grain[facing], -1)}


def _tangential_force(force, impulse):
    """Of bonded grains, whose scene has the normal forces of the contacts that push, from all impulses (p_n, p_t)."""
    pushing = impulse[impulse[:, 0] > 0] if impulse.ndim == 2 and impulse.shape[1] == 2 else np.empty((0, 2))
    if len(pushing) != len(force):
        return {}
    return {"tangential_force": force * pushing[:, 1] / pushing[:, 0]}
