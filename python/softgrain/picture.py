"""What a picture of a snapshot consists of, in metres: surfaces that carry a field, outlines, force chains, walls.

`softgrain plot` draws these with Matplotlib, `softgrain export --to svg` writes them; the page follows the same rules."""

from typing import NamedTuple

import numpy as np

from . import measure
from .run import NotRecorded, Snapshot

MOST_GRAINS_WITH_FIELDS = 60  # beyond, cells are too small to be seen: each grain has its mean
POINT_COVER = 1.25  # radius of a material point's disk that leaves no holes between neighbours, over that of its area
CHAIN_WIDTH, CHAIN_WIDTH_OF_GRAINS = 0.9, 0.3  # of the widest chain, over the radius of a body
CORNERS = 16  # of a primary among cells, which are polygons
FAINTEST, DARKEST = 0.12, 0.9  # opacity of chains
NOWHERE = np.empty((0, 2))
STRONG_FORCE = 0.99  # share of all forces below the one that has the full width


class Surface(NamedTuple):
    """Polygons, or disks where there are none, and one value for each."""

    polygons: list | np.ndarray  # (k, 2) each
    centres: np.ndarray  # (n, 2)
    radii: np.ndarray
    values: np.ndarray
    rims: list  # outlines drawn over it


class Chains(NamedTuple):
    """Segments as wide as their force is large."""

    segments: np.ndarray  # (m, 2, 2)
    widths: np.ndarray
    opacities: np.ndarray


class ForceScale(NamedTuple):
    force: float  # [N/m]
    width: float  # [m] at this force


def outlines(snapshot: Snapshot) -> list:
    """(grain, vertices (k, 2)) of each outline."""
    if not snapshot.outlines:
        return []
    grain, position = snapshot.outlines["grain"], snapshot.outlines["position"]
    starts = np.flatnonzero(np.diff(grain)) + 1
    return [(int(part[0]), vertices) for part, vertices in zip(np.split(grain, starts), np.split(position, starts))]


def is_elastic(snapshot: Snapshot) -> bool:
    """Whether the particles are material points, which stand for an area and not for disks."""
    return bool(snapshot.outlines) and "J" in snapshot.particles


def are_points(snapshot: Snapshot) -> np.ndarray:
    """(n,) bool: which particles are material points where bonded grains are among elastic ones, whose primaries come after them."""
    return np.asarray(snapshot.particles.get("primary", np.zeros(len(snapshot.particles["position"])))) == 0


def grain_means(snapshot: Snapshot, values) -> np.ndarray:
    """Mean of a field over each grain, weighted by the areas of its particles."""
    grain, area = snapshot.particles["grain"].astype(int), snapshot.particles["radius"] ** 2
    return np.bincount(grain, area * values) / np.bincount(grain, area)


def pressure(snapshot: Snapshot) -> np.ndarray:
    """The field `pressure`, or what the contact forces alone give [Pa]."""
    values = snapshot.particles.get("pressure")
    values = measure.contact_pressure(snapshot) if values is None else values
    if values is None:
        raise NotRecorded("neither pressure nor contact forces")
    return values


def has_forces(snapshot: Snapshot) -> bool:
    """Whether contacts carry forces yet; true if contacts were not recorded at all.

    Without, attraction alone makes a pressure, which means nothing."""
    return snapshot.contacts.get("force", np.ones(1)).size > 0


def surface(snapshot: Snapshot, values) -> Surface:
    """Where a field of the particles is drawn: disks; of elastic grains their cells; of many grains whole grains; across
    the edges of a periodic cell their images too."""
    return _repeated(snapshot, _surface(snapshot, values))


def _surface(snapshot, values):
    position, radius = snapshot.particles["position"], snapshot.particles["radius"]
    values = np.asarray(values, float)
    if shows_whole_grains(snapshot):
        return _grains(snapshot, grain_means(snapshot, values))
    if not is_elastic(snapshot):
        return Surface([], position, radius, values, [])
    polygons = [vertices for _, vertices in outlines(snapshot)]
    quads, points = cells(snapshot), are_points(snapshot)
    if quads is None:
        return Surface([], position, np.where(points, POINT_COVER, 1) * radius, values, polygons)
    shapes, means = _with_rigid(snapshot, quads), values[points].reshape(-1, 4).mean(axis=1)
    if not points.all():
        corners = np.linspace(0, 2 * np.pi, CORNERS, endpoint=False)
        circle = np.column_stack([np.cos(corners), np.sin(corners)])
        shapes = [*shapes, *(position[~points, None] + radius[~points, None, None] * circle)]
    return Surface(shapes, NOWHERE, np.empty(0), np.concatenate([means, values[~points]]), polygons)


def _with_rigid(snapshot, quads):
    """Cells, but of rigid grains, which have one each, their outlines."""
    grain = snapshot.particles["grain"].astype(int)[are_points(snapshot)][::4]
    alone = np.flatnonzero(np.bincount(grain)[grain] == 1)
    if alone.size == 0:
        return quads
    rims = dict(outlines(snapshot))
    shapes = list(quads)
    for k in alone:
        shapes[k] = rims[grain[k]]
    return shapes


def shows_whole_grains(snapshot: Snapshot) -> bool:
    """Whether there are so many grains with outlines that each is shown by its mean."""
    grain = snapshot.outlines.get("grain")
    return grain is not None and "grain" in snapshot.particles and np.ptp(grain) >= MOST_GRAINS_WITH_FIELDS


def grains(snapshot: Snapshot, values) -> Surface:
    """One value for each outline."""
    return _repeated(snapshot, _grains(snapshot, values))


def _grains(snapshot, values):
    polygons = [vertices for _, vertices in outlines(snapshot)]
    return Surface(polygons, NOWHERE, np.empty(0), np.asarray(values), polygons)


def bodies(snapshot: Snapshot) -> Surface:
    """What force chains are drawn over: disks, or the outlines of grains; without values."""
    if is_elastic(snapshot) or shows_whole_grains(snapshot):
        return grains(snapshot, np.zeros(len(outlines(snapshot))))
    radius = snapshot.particles["radius"]
    return _repeated(snapshot, Surface([], snapshot.particles["position"], radius, np.zeros(len(radius)), []))


def _repeated(snapshot, shapes):
    """With the images of grains that reach into a periodic cell."""
    images = snapshot.images()
    if len(images) == 1:
        return shapes
    rims, particles = outlines(snapshot), snapshot.particles["grain"].astype(int)
    of_rims = np.array([grain for grain, _ in rims])
    shown = [np.array([not shift.any() or _reaches(snapshot.cell, rim + shift) for _, rim in rims]) for shift in images]

    def repeated(grains):
        """(number, shift) of all images that are shown, of things that belong to these grains."""
        return [(k, shift) for shift, known in zip(images, shown) for k in np.flatnonzero(np.isin(grains, of_rims[known]))]

    def moved(items, places):
        return [items[k] + shift for k, shift in places]

    whole = len(shapes.polygons) == len(rims)
    polygons = repeated(of_rims if whole else particles[::4]) if len(shapes.polygons) else []
    disks = repeated(particles) if len(shapes.centres) else []
    return Surface(moved(shapes.polygons, polygons), np.array(moved(shapes.centres, disks)).reshape(-1, 2),
                   np.asarray(shapes.radii)[[k for k, _ in disks]], np.asarray(shapes.values)[[k for k, _ in polygons or disks]],
                   moved(shapes.rims, repeated(of_rims)) if shapes.rims else [])


def _reaches(cell, points):
    """Whether points span a part of the cell (along the axes that repeat)."""
    along = np.array([vector if vector.any() else unit for vector, unit in zip(cell, np.eye(2))])
    shares = points @ np.linalg.inv(along)
    return all(shares[:, k].max() > 0 and shares[:, k].min() < 1 for k in range(2) if cell[k].any())


def cells(snapshot: Snapshot) -> np.ndarray | None:
    """(n, 4, 2): the cells whose Gauss points the material points are, four after four; None where they are not.

    A corner lies sqrt(3) times as far from the middle as the point beside it."""
    of_points = are_points(snapshot)
    position, radius, grain = (snapshot.particles[name][of_points] for name in ("position", "radius", "grain"))
    if len(position) % 4:
        return None
    points, first = position.reshape(-1, 4, 2), radius[::4]
    reach = np.hypot(*np.moveaxis(points - points[:, :1], 2, 0)).max(axis=1)
    if (np.ptp(grain.reshape(-1, 4), axis=1) > 0).any() or (reach > 8 * first).any():
        return None
    middle = points.mean(axis=1, keepdims=True)
    away = points - middle
    order = np.argsort(np.arctan2(away[..., 1], away[..., 0]), axis=1)
    return middle + np.sqrt(3) * np.take_along_axis(away, order[..., None], axis=1)


def force_scale(snapshots: list) -> ForceScale:
    """Of all snapshots together. Raises NotRecorded where no contact carries a force."""
    forces = np.concatenate([_pushing(s)[1] for s in snapshots]) if snapshots else np.empty(0)
    if forces.size == 0:
        raise NotRecorded("no contact forces")
    share = CHAIN_WIDTH_OF_GRAINS if is_elastic(snapshots[0]) else CHAIN_WIDTH
    return ForceScale(float(np.quantile(forces, STRONG_FORCE)), share * float(np.median(snapshots[0].body_radii())))


def chains(snapshot: Snapshot, scale: ForceScale) -> Chains:
    """From centre to centre; a wall is met at the foot of the centre. Weak ones first, so that strong ones lie above."""
    pair, force = _pushing(snapshot)
    order = np.argsort(force, kind="stable")
    pair, force = pair[order], force[order]
    position = snapshot.bodies()
    width = scale.width * np.minimum(force / scale.force, 1.5)
    start, end = position[pair[:, 0]], np.empty((len(pair), 2))
    inside = pair[:, 1] < len(position)
    end[inside] = position[pair[inside, 1]]
    images = snapshot.images()
    ways = end[inside, None] + images - start[inside, None]
    nearest = np.argmin(np.hypot(*np.moveaxis(ways, 2, 0)), axis=1)
    end[inside] += images[nearest]
    for c in np.flatnonzero(~inside):
        end[c] = _foot(snapshot.walls[pair[c, 1] - len(position)], start[c], width[c] / 2)
    opacity = np.clip(force / scale.force, FAINTEST, DARKEST)
    crossing = np.flatnonzero(inside)[nearest > 0]  # from the other side too
    back = position[pair[crossing, 1]] - end[crossing]
    other = np.stack([start[crossing] + back, position[pair[crossing, 1]]], axis=1)
    return Chains(np.concatenate([np.stack([start, end], axis=1), other]), np.concatenate([width, width[crossing]]),
                  np.concatenate([opacity, opacity[crossing]]))


def _is_edge(snapshot):
    """Of each of the walls: whether it is an edge of a periodic cell. The first two face along y."""
    across = [row.any() for row in snapshot.cell] or [False, False]
    return np.array([across[1 if k < 2 else 0] for k in range(len(snapshot.walls))], bool)


def walls(snapshot: Snapshot) -> np.ndarray:
    """(n, 2, 2): from where to where each goes."""
    return snapshot.walls.reshape(-1, 2, 2)[~_is_edge(snapshot)]


def cell_edges(snapshot: Snapshot) -> np.ndarray:
    """The same of the edges of a periodic cell."""
    return snapshot.walls.reshape(-1, 2, 2)[_is_edge(snapshot)]


def box(snapshots: list) -> tuple:
    """((x0, x1), (y0, y1)) [m] around all bodies and walls of all snapshots; walls of a single grain are longer than it."""
    corners, heights = [], []
    for s in snapshots:
        position, radius = s.particles["position"], s.particles["radius"][:, None]
        corners += [position - radius, position + radius, s.outlines.get("position", NOWHERE)]
        walls = s.walls.reshape(-1, 2)
        heights.append(walls[:, 1])
        corners += [walls] if len(s.walls) > 2 else []
    corners, heights = np.concatenate(corners), np.concatenate(heights)
    (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
    return (x0, x1), (min(y0, heights.min(initial=y0)), max(y1, heights.max(initial=y1)))


def _pushing(snapshot):
    """(pair (m, 2), force (m,)) of the contacts that push, walls included; empty if not recorded."""
    if not {"pair", "force"} <= snapshot.contacts.keys():
        return np.empty((0, 2), int), np.empty(0)
    pair, force = snapshot.contacts["pair"].astype(int), snapshot.contacts["force"]
    count = len(snapshot.bodies())
    known = (pair >= 0).all(axis=1) & (pair[:, 0] < count) & (pair[:, 1] < count + len(snapshot.walls)) & (force > 0)
    return pair[known], force[known]


def _foot(wall, point, before):
    """The point of a wall that is nearest, or `before` it, so that a round end does not stand out."""
    a, b = wall.reshape(2, 2)
    along = (point - a) @ (b - a) / ((b - a) @ (b - a) or 1)
    foot = a + np.clip(along, 0, 1) * (b - a)
    return foot + before * (point - foot) / (np.hypot(*(point - foot)) or 1)
