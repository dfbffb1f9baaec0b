"""What a box holds and bears by height: density of horizontal slabs, stress of the side walls."""

from typing import NamedTuple

import numpy as np

from .export.contacts import contact_table
from .run import NotRecorded

SLABS = 8
PARTS_OF_SPAN = 8
LEFT_WALL, RIGHT_WALL = 2, 3


class Density(NamedTuple):
    height: np.ndarray  # of the middle of each slab above the bottom wall [m]
    density: np.ndarray  # share of the slab that the outlines of grains cover


class WallStress(NamedTuple):
    height: np.ndarray  # as in Density [m]
    normal: np.ndarray  # mean of both side walls, compression positive [Pa]
    shear: np.ndarray  # of the grains on the walls, mean of both, upwards positive [Pa]


def density_by_height(snapshot, slabs=SLABS):
    """Density of `slabs` equal slabs between bottom and top wall.

    The area of a polygon below a level is the integral of x dy along what of its boundary lies below: what closes it runs
    along the level and adds nothing. Raises NotRecorded without outlines or in a periodic cell."""
    left, right, bottom, top = _box(snapshot)
    if not len(snapshot.outlines.get("position", ())):
        raise NotRecorded(f"the snapshot of step {snapshot.step} has no outlines")
    (x0, y0), (x1, y1) = (ends.T for ends in _edges(snapshot))
    rise = np.where(y1 == y0, 1, y1 - y0)
    levels = np.linspace(bottom, top, slabs + 1)
    below = []
    for level in levels:
        low, high = np.minimum(y0, level), np.minimum(y1, level)
        middle = x0 + (x1 - x0) * ((low + high) / 2 - y0) / rise
        below.append(np.sum(middle * (high - low)))
    area = (right - left) * (top - bottom) / slabs
    return Density((levels[:-1] + levels[1:]) / 2 - bottom, np.diff(below) / area)


def wall_stress_by_height(snapshot, slabs=SLABS):
    """Forces of the contacts with the side walls, over the height of their slab.

    Raises NotRecorded without contacts or in a periodic cell."""
    _, _, bottom, top = _box(snapshot)
    table = contact_table(snapshot)
    levels = np.linspace(bottom, top, slabs + 1)
    normal, shear = np.zeros((2, slabs))
    for wall, upwards in ((LEFT_WALL, -1), (RIGHT_WALL, 1)):  # e_z x normal, which points from the grain to the wall
        rows = table["wall"] == wall
        slab = np.clip(np.searchsorted(levels, table["y"][rows], "right") - 1, 0, slabs - 1)
        normal += np.bincount(slab, table["normal_force"][rows], slabs)
        if "tangential_force" in table:
            shear += np.bincount(slab, upwards * table["tangential_force"][rows], slabs)
    thickness = (top - bottom) / slabs
    return WallStress((levels[:-1] + levels[1:]) / 2 - bottom, normal / (2 * thickness), shear / (2 * thickness))


def _edges(snapshot):
    """Begin and end of all edges (n, 2) [m]: of polygons, or of the smooth curves of elastic grains in parts."""
    points, grain = snapshot.outlines["position"], snapshot.outlines["grain"]
    first = np.flatnonzero(np.r_[True, grain[1:] != grain[:-1]])
    last = np.r_[first[1:], len(grain)] - 1
    following, previous = np.arange(1, len(grain) + 1), np.arange(-1, len(grain) - 1)
    following[last], previous[first] = first, last
    begin, end = points, points[following]
    if not snapshot.contacts_of_grains:
        return begin, end
    before, after = points[previous], end[following]
    b, d = (end - before) / 2, (after - before) / 2 + 1.5 * (begin - end)  # as the contact of outlines has it
    xi = np.linspace(0, 1, PARTS_OF_SPAN + 1)[:, None, None]
    curve = begin + xi * (b + xi * (end - begin - b - d + xi * d))
    return curve[:-1].reshape(-1, 2), curve[1:].reshape(-1, 2)


def _box(snapshot):
    """Left, right, bottom and top [m]."""
    if len(snapshot.walls) < 4 or np.any(snapshot.cell):
        raise NotRecorded(f"the snapshot of step {snapshot.step} is of no box with four walls")
    x, y = snapshot.walls[:, [0, 2]], snapshot.walls[:, [1, 3]]
    return x.min(), x.max(), y.min(), y.max()
