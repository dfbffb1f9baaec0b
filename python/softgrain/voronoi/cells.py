"""Set-Voronoi cells of the grains of a snapshot: of all places, those that are nearer to a grain's surface than to any other's.

Points on the surfaces have Voronoi cells; those of one grain together are its cell (Schaller et al., Set Voronoi
diagrams of 3D assemblies of aspherical particles, Philosophical Magazine 93, 3993, 2013)."""

from typing import NamedTuple

import numpy as np

from .. import patches, solids
from ..run import NotRecorded, Snapshot
from .tessellation import Domain, Faces, tessellate

POINTS = 200  # on a grain, at least
DEPTH, LEAST_DEPTH = 0.5, 0.05  # of the points below the surface: over their distance, over the smallest grain's radius
LEAST_FACE = 0.01  # of a cell's surface: what counts as a neighbour
WALLS = {2: {1: (0, 1), 0: (2, 3)}, 3: {2: (0, 1), 1: (2, 3), 0: (4, 5)}}  # of each direction, by their numbers in a snapshot


class Cells(NamedTuple):
    """One entry for each grain; in the plane volumes are areas [m^2] and areas lengths [m]."""

    grain_volume: np.ndarray  # (n,) [m^3]
    volume: np.ndarray  # (n,) of the cell [m^3]
    neighbours: np.ndarray  # (n,): grains with which the cell shares at least 1 % of its surface
    faces: dict  # columns grain_a, grain_b (-1 for a wall), wall (as in tables of contacts; -1 for none), area, share
    #              (of the surface of a's cell), normal_x, normal_y, normal_z; one row for each side of a face

    @property
    def phi(self) -> np.ndarray:
        """(n,): local packing fraction, volume of the grain over that of its cell."""
        return self.grain_volume / self.volume


def cells_of(snapshot: Snapshot, points: int = POINTS) -> Cells:
    """Cells of all grains of a box with walls all round, or a periodic cell.

    points: on each grain at least; as many on all quads of its surface, or edges of its outline in the plane.
    Raises NotRecorded without outlines or where the grains are not enclosed, ModuleNotFoundError without SciPy."""
    domain = domain_of(snapshot)
    place, grain = surface_points(snapshot, points)
    volume = grain_volumes(snapshot)
    if np.bincount(grain, minlength=len(volume)).min() == 0:
        raise NotRecorded(f"the snapshot of step {snapshot.step} has grains without outlines")
    dimension = place.shape[1]
    reach = _radius_of(volume.max(), dimension)
    found = tessellate(_inside(place, domain), grain, domain, reach)
    return Cells(volume, found.volume, *_neighbours(found.faces, len(volume), dimension))


def domain_of(snapshot: Snapshot) -> Domain:
    """The box. Raises NotRecorded where it is open."""
    dimension = snapshot.particles["position"].shape[1]
    faces = snapshot.surface.get("walls", np.empty((0, 12))) if dimension == 3 else snapshot.walls
    if len(faces) < 2 * dimension:
        raise NotRecorded(f"the snapshot of step {snapshot.step} has no walls all round: cells would not end")
    corners = faces.reshape(len(faces), -1, dimension)
    origin, vectors, repeats = np.zeros(dimension), np.zeros((dimension, dimension)), np.zeros(dimension, bool)
    for k, pair in WALLS[dimension].items():
        repeats[k] = len(snapshot.cell) > 0 and bool(np.any(snapshot.cell[k]))
        if repeats[k]:
            vectors[k] = snapshot.cell[k]
        else:
            low, high = sorted(corners[wall, :, k].mean() for wall in pair)
            origin[k], vectors[k, k] = low, high - low
    return Domain(origin, vectors, repeats)


def surface_points(snapshot: Snapshot, points: int):
    """Places (n, d) [m] somewhat below the grains' surfaces, and the grain of each.

    Below, so that surfaces that touch keep apart, also where contact leaves them an overlap; all by the same depth: what lies
    half-way between two surfaces lies so between those below them too."""
    at = _places(snapshot, points)
    if solids.in_space(snapshot):
        u, v = (a.ravel() for a in np.meshgrid(at, at))
        place, normal, grain = patches.points_on(snapshot, u, v)
        size = np.linalg.norm(normal, axis=1)
        normal /= size[:, None]
        distance = np.sqrt(size) / len(at)
    else:
        place, normal, grain, size = _on_outlines(snapshot, at)
        distance = size / len(at)
    count = np.bincount(grain)
    least = (np.bincount(grain, distance)[count > 0] / count[count > 0]).min()
    radius = _radius_of(grain_volumes(snapshot).min(), place.shape[1])
    return place - max(DEPTH * least, LEAST_DEPTH * radius) * normal, grain


def _radius_of(volume, dimension):
    """Of a disk or a ball [m]."""
    return (volume / (np.pi if dimension == 2 else 4 / 3 * np.pi)) ** (1 / dimension)


def _places(snapshot, points):
    """Along each edge of a quad, or of an outline, from 0 to 1: so many that no grain has fewer points."""
    solid = solids.in_space(snapshot)
    owner = snapshot.surface["grain"] if solid else snapshot.outlines.get("grain", np.zeros(1))
    fewest = np.unique(owner.astype(int), return_counts=True)[1].min()
    number = int(np.ceil((points / fewest) ** (1 / (2 if solid else 1)) - 1e-9))
    return (np.arange(number) + 0.5) / number


def grain_volumes(snapshot: Snapshot):
    """(n,) [m^3, in the plane m^2], as the column `phi` has them."""
    if solids.in_space(snapshot):
        return patches.measures(snapshot).volume
    if snapshot.contacts_of_grains or "J" in snapshot.particles:
        return np.pi * np.bincount(snapshot.particles["grain"].astype(int), snapshot.particles["radius"] ** 2)
    _, begin, end, _, grain = _edges(snapshot)
    return np.bincount(grain, begin[:, 0] * end[:, 1] - begin[:, 1] * end[:, 0]) / 2


def _edges(snapshot):
    """Of each edge of the outlines: the vertex before it, its ends and the vertex behind it (4, n, 2), then grains (n,)."""
    if not len(snapshot.outlines.get("position", ())):
        raise NotRecorded(f"the snapshot of step {snapshot.step} has no outlines")
    x, grain = snapshot.outlines["position"], snapshot.outlines["grain"].astype(int)
    first = np.flatnonzero(np.diff(grain, prepend=-1))
    last = np.append(first[1:], len(grain)) - 1
    following, previous = np.arange(1, len(grain) + 1), np.arange(-1, len(grain) - 1)
    following[last], previous[first] = first, last
    return x[previous], x, x[following], x[following[following]], grain


def _on_outlines(snapshot, at):
    """On the smooth curve of elastic grains, on the edges of others: place, unit normal outwards, grain, length of the edge."""
    *net, grain = _edges(snapshot)
    if not snapshot.contacts_of_grains:
        net[0], net[3] = 2 * net[1] - net[2], 2 * net[2] - net[1]  # a straight edge
    place, along = (np.einsum("kq,kni->nqi", weights, np.array(net)).reshape(-1, 2)
                    for weights in (patches.curve_weights(at), patches.curve_slopes(at)))
    size = np.linalg.norm(along, axis=1)
    known = size > 0
    normal = np.column_stack([along[:, 1], -along[:, 0]])[known] / size[known, None]
    return place[known], normal, np.repeat(grain, len(at))[known], size[known]


def _inside(place, domain):
    """Points of grains that stick through a wall, a little before it."""
    shares = domain.shares(place)
    margin = 1e-6
    clipped = np.where(domain.repeats, shares, np.clip(shares, margin, 1 - margin))
    return np.where((clipped == shares).all(axis=1)[:, None], place, domain.origin + clipped @ domain.vectors)


def _neighbours(faces: Faces, grains, dimension):
    area = np.linalg.norm(faces.area, axis=1)
    share = area / np.bincount(faces.a, area, grains)[faces.a]
    by_number = np.full(2 * dimension, -1)
    for k, pair in WALLS[dimension].items():
        by_number[2 * k:2 * k + 2] = pair
    wall = np.where(faces.wall < 0, -1, by_number[faces.wall])
    normal = faces.area / np.where(area > 0, area, 1)[:, None]
    columns = {"grain_a": faces.a, "grain_b": faces.b, "wall": wall, "area": area, "share": share,
               **{f"normal_{axis}": column for axis, column in zip("xyz", normal.T)}}
    counted = np.bincount(faces.a[(share >= LEAST_FACE) & (wall < 0)], minlength=grains)
    return counted, columns
