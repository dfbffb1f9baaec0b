"""Grains in space by their surfaces: volumes, the ellipsoids that stand for them, mean pressures."""

import numpy as np


def in_space(snapshot) -> bool:
    """Whether a snapshot has three coordinates."""
    return snapshot.particles["position"].shape[1] == 3


def of_grains(snapshot) -> bool:
    """Whether a snapshot in space has one particle for each grain: elastic and rigid ones do, bonded ones have their primaries."""
    return in_space(snapshot) and len(np.unique(snapshot.particles["grain"])) == len(snapshot.particles["position"])


def centres(snapshot):
    """(n, 3) [m]: of the grains; of bonded ones the centres of their primaries' volume."""
    if of_grains(snapshot):
        return snapshot.particles["position"]
    grain, size = snapshot.particles["grain"].astype(int), snapshot.particles["radius"] ** 3
    return np.stack([np.bincount(grain, size * x) for x in snapshot.particles["position"].T], axis=1) / np.bincount(grain, size)[:, None]


def triangles(snapshot):
    """(2 quads, 3, 3) [m]: each quad as two, seen counter-clockwise from outside; and the grain of each (2 quads,)."""
    quad = snapshot.surface["quad"].astype(int)
    corners = np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])
    return snapshot.outlines["position"][corners], np.tile(snapshot.surface["grain"].astype(int), 2)


def moments(snapshot):
    """Volume (n,) [m^3], centroid (n, 3) [m] and second moment about it over the volume (n, 3, 3) [m^2] of each grain.

    Sums over the tetrahedra between a point of the grain and its triangles a, b, c, of volume v = a . (b x c)/6:
    int x = v s/4, int x (x) x = v (a a + b b + c c + s s)/20 with s = a + b + c."""
    corners, grain = triangles(snapshot)
    centre = centres(snapshot)
    count = len(centre)
    x = corners - centre[grain][:, None]
    v = np.einsum("ti,ti->t", x[:, 0], np.cross(x[:, 1], x[:, 2])) / 6
    s = x.sum(axis=1)
    second = (np.einsum("tki,tkj->tij", x, x) + np.einsum("ti,tj->tij", s, s)) * v[:, None, None] / 20

    def over_grains(values):
        return np.stack([np.bincount(grain, column, count) for column in values.reshape(len(values), -1).T], axis=-1)

    volume = over_grains(v)[:, 0]
    mean = over_grains(v[:, None] * s / 4) / volume[:, None]
    tensor = over_grains(second).reshape(-1, 3, 3) / volume[:, None, None] - np.einsum("gi,gj->gij", mean, mean)
    return volume, centre + mean, tensor


def ellipsoids(snapshot):
    """Semi-axes (n, 3) [m], the longest first, and orientations (n, 4), quaternions x y z w.

    Of an ellipsoid the second moment over its volume is a_k^2/5 along its axes. 4/3 pi a b c is the volume between the flat
    quads over the share of a sphere that quads with corners in the same directions fill."""
    volume, centre, tensor = moments(snapshot)
    volume = volume / _fullness(snapshot, centre)
    values, vectors = np.linalg.eigh(tensor)
    axes, vectors = np.sqrt(5 * values[:, ::-1]), vectors[:, :, ::-1].copy()
    vectors[:, :, 2] *= np.sign(np.linalg.det(vectors))[:, None]  # right-handed
    return axes * np.cbrt(3 * volume / (4 * np.pi * axes.prod(axis=1)))[:, None], quaternions(vectors)


def _fullness(snapshot, centre):
    """(n,): volume between quads whose corners are moved onto a sphere about the grain's centre, over that of the sphere."""
    corners, grain = triangles(snapshot)
    u = corners - centre[grain][:, None]
    u /= np.linalg.norm(u, axis=2)[:, :, None]
    volume = np.einsum("ti,ti->t", u[:, 0], np.cross(u[:, 1], u[:, 2])) / 6
    return np.bincount(grain, volume, len(centre)) / (4 / 3 * np.pi)


def quaternions(rotations):
    """x y z w of rotation matrices (n, 3, 3), w >= 0: of the largest of the four squares, the others by products."""
    R = np.asarray(rotations)
    xx, yy, zz = (R[:, k, k] for k in range(3))
    square = np.stack([1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz], axis=1)  # 4 q_k^2
    product = np.zeros((len(R), 4, 4))  # 4 q_i q_j
    for i, j in ((0, 1), (0, 2), (1, 2)):
        product[:, i, j] = product[:, j, i] = R[:, i, j] + R[:, j, i]
    for k, (i, j) in enumerate(((2, 1), (0, 2), (1, 0))):
        product[:, k, 3] = product[:, 3, k] = R[:, i, j] - R[:, j, i]
    product[:, range(4), range(4)] = square
    q = product[np.arange(len(R)), square.argmax(axis=1)]
    q /= np.linalg.norm(q, axis=1)[:, None]
    return q * np.where(q[:, 3:] < 0, -1, 1)


def pressures(snapshot):
    """(n,) [Pa]: of each grain the mean over its surface of the pressure behind it."""
    corners, grain = triangles(snapshot)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    count = len(centres(snapshot))
    return np.bincount(grain, area * np.tile(snapshot.surface["pressure"], 2), count) / np.bincount(grain, area, count)
