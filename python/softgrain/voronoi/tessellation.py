"""Voronoi cells of points in a box of walls or a cell that repeats, merged by the label of the points; in the plane and in space."""

import itertools
import sys
from typing import NamedTuple

import numpy as np

CLOSE = 1e-9  # of the box: what round-off may leave of a wall, or of the sum of all cells
MOST_WIDENINGS = 8
COARSER, ENOUGH = 4, 1.1  # fewer points first; room beyond what they needed


class Domain(NamedTuple):
    """A parallelepiped. Its faces are walls, but along directions that repeat."""

    origin: np.ndarray  # (d,) [m]
    vectors: np.ndarray  # (d, d) [m], one a row; one between walls lies along its axis
    repeats: np.ndarray  # (d,) bool

    @property
    def volume(self) -> float:
        return float(abs(np.linalg.det(self.vectors)))

    @property
    def heights(self):
        """(d,) [m]: distance of the two faces that each vector joins."""
        return 1 / np.linalg.norm(np.linalg.inv(self.vectors), axis=0)

    def shares(self, points):
        """(n, d): coordinates along the vectors, 0 to 1 inside."""
        return (points - self.origin) @ np.linalg.inv(self.vectors)


class Faces(NamedTuple):
    """Between cells of different labels, one row for each side: what a has in common with an image of b, or with a wall."""

    a: np.ndarray  # (m,)
    b: np.ndarray  # (m,); -1 for a wall
    wall: np.ndarray  # (m,): 2 k below and 2 k + 1 above along vector k; -1 for none
    image: np.ndarray  # (m, d): b is met moved by image @ vectors
    area: np.ndarray  # (m, d) [m^2, in the plane m]: sum of area times unit normal from a to b


class Tessellation(NamedTuple):
    volume: np.ndarray  # (labels,) [m^3, in the plane m^2]
    faces: Faces


class _Crowd(NamedTuple):
    """Points with their images: the first are the points themselves."""

    place: np.ndarray
    owner: np.ndarray  # which point this is an image of
    shift: np.ndarray  # (n, d) whole vectors by which it was moved
    wall: np.ndarray  # in which it is mirrored; -1 for none


def tessellate(points, label, domain: Domain, reach: float) -> Tessellation:
    """Cells of (n, d) points inside the domain.

    A cell that ends at a wall is bounded by the mirror image of its own point, one that crosses a face that repeats by
    images of others. Images are made of what lies near a face: a fourth of the points, with images as far as `reach` [m] and
    further until no cell can lack one, shows how near. Raises ValueError where the whole box is not far enough. Qhull makes
    the diagram of all points."""
    points, label = np.asarray(points, float), np.asarray(label)
    start = np.where(domain.repeats, np.floor(domain.shares(points)), 0)
    points = points - start @ domain.vectors
    reach = _diagram(points[::COARSER], domain, reach)[2] * ENOUGH
    crowd, diagram, _ = _diagram(points, domain, reach)
    return _merge(diagram, crowd._replace(shift=crowd.shift - start[crowd.owner]), label, domain, len(points))


def _diagram(points, domain, reach):
    """The points with their images, the diagram of all, and how far from a face the images are that it needs [m]."""
    try:
        from scipy.spatial import Voronoi
    except ImportError as missing:
        raise ValueError(f"Voronoi cells need SciPy for {sys.executable}: {missing}; on Debian: apt install python3-scipy, "
                         "with pip: pip install scipy") from missing
    for _ in range(MOST_WIDENINGS):
        crowd = _with_images(points, domain, reach)
        diagram = Voronoi(crowd.place)
        needed = _reach_needed(diagram, crowd, len(points), domain)
        if needed <= reach:
            return crowd, diagram, needed
        reach = min(2 * reach, ENOUGH * needed)
    raise ValueError("the points are too few for their box: cells reach through all of it")


def _with_images(points, domain, reach):
    count, dimension = points.shape
    place, owner, shift = [points], [np.arange(count)], [np.zeros((count, dimension))]
    shares, band = domain.shares(points), reach / domain.heights
    steps = [range(-int(np.ceil(b)), int(np.ceil(b)) + 1) if repeats else (0,) for b, repeats in zip(band, domain.repeats)]
    for step in itertools.product(*steps):
        if any(step):
            moved = shares + step
            near = ((moved > -band) & (moved < 1 + band) | ~domain.repeats).all(axis=1)
            place.append(points[near] + np.array(step) @ domain.vectors)
            owner.append(np.flatnonzero(near))
            shift.append(np.tile(np.array(step, float), (near.sum(), 1)))
    place, owner, shift = np.concatenate(place), np.concatenate(owner), np.concatenate(shift)
    mirrored = [(place, owner, shift, np.full(len(place), -1))]
    for k in np.flatnonzero(~domain.repeats):
        low = domain.origin[k]
        for side, level in enumerate((low, low + domain.vectors[k, k])):
            near = abs(place[:, k] - level) < reach
            image = place[near].copy()
            image[:, k] = 2 * level - image[:, k]
            mirrored.append((image, owner[near], shift[near], np.full(len(image), 2 * k + side)))
    return _Crowd(*map(np.concatenate, zip(*mirrored)))


def _reach_needed(diagram, crowd, count, domain):
    """How far from a face images must be made so that none is missing [m]: those of all points whose cells end at a wall, and
    those inside the circle round each corner of a cell that goes through the points beside it, which must be empty.
    Infinite where cells are unbounded or cross a wall."""
    regions = [diagram.regions[r] for r in diagram.point_region[:count]]
    corner = np.fromiter(itertools.chain.from_iterable(regions), int)
    point = np.repeat(np.arange(count), [len(region) for region in regions])
    shares = domain.shares(diagram.vertices[corner])
    fixed = ~domain.repeats
    if corner.min() < 0 or (abs(shares[:, fixed] - 0.5) > 0.5 + CLOSE).any():
        return np.inf
    pair = diagram.ridge_points
    at_wall = (np.minimum(*pair.T) < count) & (crowd.wall[np.maximum(*pair.T)] >= 0)
    reaches = [np.linalg.norm(crowd.place[pair[at_wall, 0]] - crowd.place[pair[at_wall, 1]], axis=1) / 2]
    radius = np.linalg.norm(diagram.vertices[corner] - diagram.points[point], axis=1)
    for k in np.flatnonzero(domain.repeats):
        reaches.append((abs(shares[:, k] - 0.5) - 0.5) * domain.heights[k] + radius)
    return max(found.max(initial=0) for found in reaches)


def _merge(diagram, crowd, label, domain, count):
    labels = int(label.max()) + 1 if len(label) else 0
    sizes, of_ridge = _sizes(diagram)
    pair = diagram.ridge_points[of_ridge]
    way = crowd.place[pair[:, 1]] - crowd.place[pair[:, 0]]
    distance = np.linalg.norm(way, axis=1)
    dimension = crowd.place.shape[1]
    volume, rows, areas = np.zeros(labels), [], []
    for side in (0, 1):
        p, q = pair[:, side], pair[:, 1 - side]
        own = p < count
        volume += np.bincount(label[crowd.owner[p[own]]], sizes[own] * distance[own] / (2 * dimension), labels)
        a, b, wall = label[crowd.owner[p]], label[crowd.owner[q]], crowd.wall[q]
        image = (crowd.shift[q] - crowd.shift[p]).astype(int)
        apart = own & ((a != b) | (wall >= 0) | image.any(axis=1))
        at_wall = (wall >= 0)[:, None]
        row = np.column_stack([a, np.where(wall < 0, b, -1), wall, np.where(at_wall, 0, image)])
        rows.append(row[apart])
        areas.append(((1 - 2 * side) * sizes / distance)[apart, None] * way[apart])
    rows, areas = np.concatenate(rows), np.concatenate(areas)
    keys, place = np.unique(rows, axis=0, return_inverse=True)
    area = np.column_stack([np.bincount(place.ravel(), column, len(keys)) for column in areas.T])
    if abs(volume.sum() / domain.volume - 1) > CLOSE:
        raise ValueError(f"the cells fill {volume.sum() / domain.volume:.9g} of their box: this is a bug, please report")
    return Tessellation(volume, Faces(keys[:, 0], keys[:, 1], keys[:, 2], keys[:, 3:], area))


def _sizes(diagram):
    """Area of each bounded face between two points, in the plane its length; and which of the diagram's ridges it is."""
    counts = np.fromiter(map(len, diagram.ridge_vertices), int)
    flat = np.fromiter(itertools.chain.from_iterable(diagram.ridge_vertices), int)
    begin = np.cumsum(counts) - counts
    bounded = np.minimum.reduceat(flat, begin) >= 0
    x = diagram.vertices[flat]
    if x.shape[1] == 2:
        ends = begin[bounded]
        return np.linalg.norm(x[ends + 1] - x[ends], axis=1), np.flatnonzero(bounded)
    following = np.arange(1, len(flat) + 1)
    following[begin + counts - 1] = begin
    first = np.repeat(x[begin], counts, axis=0)
    doubled = np.add.reduceat(np.cross(x - first, x[following] - first), begin)  # corners follow one another round the face
    return np.linalg.norm(doubled[bounded], axis=1) / 2, np.flatnonzero(bounded)
