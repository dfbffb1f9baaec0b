"""Grains as a table: shape, contacts and stress of each. Of elastic and rigid grains, disks and spheres, and of mixtures with bonded ones."""

import numpy as np

from .. import patches, picture, solids
from ..run import NotRecorded, Snapshot
from ..voronoi.cells import grain_volumes
from .contacts import contact_table

NEAR = 5e-3
PAIRS = {2: ("xx", "yy", "xy"), 3: ("xx", "yy", "zz", "xy", "xz", "yz")}


def grain_table(snapshot: Snapshot) -> dict[str, np.ndarray]:
    """Columns, one row for each grain; in the plane volumes are areas [m^2], areas lengths [m], and forces per depth [N/m]:

    grain, kind        its number, and its kind where there are several
    x, y, z            its centre [m]
    volume, area       within its outline or smooth surface [m^3, m^2]
    sphericity         (36 pi V^2)^(1/3)/A, in the plane 2 sqrt(pi A)/perimeter: 1 for a sphere or disk
    gyration_xx ...    1/V of the integral of (x - x_g)(x - x_g) about the centroid [m^2]: R^2/5 of a sphere, R^2/4 of a disk
    contacts           grains and walls that it touches
    contact_area       of its surface that is nearer than 0.005 of its radius to what it touches [m^2]; in space, left out where the file
                       has no such points
    stress_xx ...      mean Cauchy stress of a grain at rest, -1/V sum of x_v f_v over its vertices [Pa], compression positive
    love_weber_xx ...  the same from whole contacts, -1/V sum of (x_c - x_g) f_c [Pa]

    Volume times love_weber, over the volume of the box, adds up to the columns stress_xx ... of the run, less what the motion
    has in them. Bonded grains have outlines with forces only among elastic ones; the force of a contact then is where the outline is
    nearest to it, so that stress is as good as the outline. Raises NotRecorded where there are none."""
    if "force" not in snapshot.outlines or not snapshot.contacts_of_grains:
        raise NotRecorded(f"the snapshot of step {snapshot.step} has no outlines with forces: those are of elastic and rigid grains")
    centre, owner = snapshot.bodies(), snapshot.outlines["grain"].astype(int)
    count = len(centre)
    volume, area, sphericity, gyration = _shapes(snapshot)
    table = {"grain": np.arange(count)}
    if "kind" in snapshot.particles:
        grains, first = np.unique(snapshot.particles["grain"].astype(int), return_index=True)
        table["kind"] = snapshot.particles["kind"][first].astype(int)
    table |= dict(zip("xyz", centre.T)) | {"volume": volume, "area": area}
    table["sphericity"] = sphericity
    table |= _components("gyration", gyration)
    contacts = contact_table(snapshot)
    sides = [contacts["grain_a"], contacts["grain_b"][contacts["wall"] < 0]]
    table["contacts"] = np.bincount(np.concatenate(sides), minlength=count)
    if snapshot.points:
        table["contact_area"] = contact_areas(snapshot)
    x = snapshot.outlines["position"] - centre[owner]
    table |= _components("stress", -_sums(x, snapshot.outlines["force"], owner, count) / volume[:, None, None])
    return table | _components("love_weber", love_weber(snapshot, centre) / volume[:, None, None])


def love_weber(snapshot: Snapshot, centre):
    """(n, d, d) [J]: of each grain -sum (x_c - x_g) f_c, f_c the force of a contact on it. Symmetric where the grain does not spin up."""
    contacts = snapshot.contacts
    a, b = contacts["pair"].astype(int).T
    total = _sums(contacts["position"] - centre[a], contacts["total_force"], a, len(centre))  # of a on the other
    inner = b < len(centre)
    way = contacts["position"][inner] - centre[b[inner]]
    images = snapshot.images()
    if len(images) > 1:  # b may be met through an image
        ways = way[:, None] + images
        way = ways[np.arange(len(way)), np.argmin((ways**2).sum(axis=2), axis=1)]
    return total - _sums(way, contacts["total_force"][inner], b[inner], len(centre))


def fabric(snapshot: Snapshot) -> np.ndarray:
    """(d, d): F = 1/N sum of n n over the pairs of grains that push; its trace is 1 (theory (64))."""
    table = contact_table(snapshot)
    normal = np.column_stack([table[f"normal_{axis}"] for axis in "xyz" if f"normal_{axis}" in table])[table["wall"] < 0]
    return normal.T @ normal / max(len(normal), 1)


def contact_areas(snapshot: Snapshot) -> np.ndarray:
    """(n,) [m^2]: each point that pushes, or is nearer than NEAR of the grain's radius, stands for its share of the surface: a vertex
    for a sixteenth of each patch round it, the middle of an edge for an eighth of both, that of a patch for a fourth of it. Grains
    that bring no edges have twice as much for the others: rigid ones, and all in older runs; up to version 0.2 elastic spheres met
    each other by vertices alone, which then stand for a fourth. Both grains of a pair have its area, the mean of both sides if both
    bring points.

    Points that push alone say too little: from step to step others of a contact bear its force."""
    points, quad = snapshot.points, snapshot.surface["quad"].astype(int)
    count = len(snapshot.particles["position"])
    own, other, between = points["grain"], points["facing"], points["wall"] < 0
    pair = np.minimum(own, other) * count + np.maximum(own, other)
    half, quarter = ~between | np.isin(pair, pair[between & (points["patch"] >= 0)]), np.isin(own, own[points["edge"] >= 0])
    mutual = between & np.isin(other * count + own, (own * count + other)[between])
    near = points["pushes"] | (points["gap"] < NEAR * snapshot.particles["radius"][own])
    of_patch = patches.patch_areas(snapshot)
    of_vertex = np.bincount(quad.ravel(), np.repeat(of_patch / 4, 4), len(snapshot.outlines["position"]))
    ends = np.sort(np.stack([quad, np.roll(quad, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    of_edge = np.bincount(np.unique(ends, axis=0, return_inverse=True)[1].ravel(), np.repeat(of_patch / 8, 4))  # sorted as points are
    share = np.where(points["patch"] >= 0, of_patch[points["patch"]], of_vertex[points["vertex"]]) / np.where(quarter, 4, np.where(half, 2, 1))
    share = near * np.where(points["edge"] >= 0, of_edge[points["edge"]], share) / np.where(mutual, 2, 1)
    return np.bincount(own, share, count) + np.bincount(other[between], share[between], count)


def write_grains(snapshot, file):
    """One line for each grain; the header names columns and units as in series.csv."""
    table = grain_table(snapshot)
    solid = solids.in_space(snapshot)
    units = {"x": "m", "y": "m", "z": "m", "volume": "m^3" if solid else "m^2", "area": "m^2" if solid else "m", "contact_area": "m^2",
             "gyration": "m^2", "stress": "Pa", "love": "Pa"}

    def headed(name):
        unit = units.get(name) or units.get(name.split("_")[0] if name not in ("contact_area",) else name)
        return f"{name}[{unit}]" if unit else name

    file.write(",".join(map(headed, table)) + "\n")
    columns = [[f"{value:.9g}" for value in np.asarray(values).tolist()] for values in table.values()]
    file.writelines(",".join(row) + "\n" for row in zip(*columns))


def _shapes(snapshot):
    """Volume, area, sphericity, and gyration tensor about the centroid; in the plane all but the volume of the polygon of the vertices."""
    if solids.in_space(snapshot):
        found = patches.measures(snapshot)
        return *found, np.cbrt(36 * np.pi * found.volume**2) / found.area, patches.gyration(snapshot)
    area, length, moments = [], [], []
    for _, rim in picture.outlines(snapshot):
        x, y = rim - rim.mean(axis=0), np.roll(rim, -1, axis=0) - rim.mean(axis=0)
        twice = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
        size = twice.sum() / 2
        s = x + y
        mean = (twice[:, None] * s).sum(axis=0) / (6 * size)
        second = (np.einsum("e,ei,ej->ij", twice, s, s) + np.einsum("e,ei,ej->ij", twice, x, x) + np.einsum("e,ei,ej->ij", twice, y, y)) / 24
        moments.append(second / size - np.outer(mean, mean))
        area.append(size)
        length.append(np.linalg.norm(y - x, axis=1).sum())
    return grain_volumes(snapshot), np.array(length), 2 * np.sqrt(np.pi * np.array(area)) / length, np.array(moments)


def _sums(x, f, owner, count):
    """(count, d, d): sum of x f over what each owner has."""
    axes = range(x.shape[1])
    return np.stack([np.stack([np.bincount(owner, x[:, i] * f[:, j], count) for j in axes], axis=-1) for i in axes], axis=1)


def _components(name, tensor):
    """Columns of the symmetric part."""
    symmetric = (tensor + tensor.transpose(0, 2, 1)) / 2
    return {f"{name}_{pair}": symmetric[:, "xyz".index(pair[0]), "xyz".index(pair[1])] for pair in PAIRS[tensor.shape[1]]}
