"""The smooth surfaces of grains in space, as contact sees them: the plane's curve times itself (theory, smooth outlines)."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from . import solids

GAUSS = np.array([0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15)]), np.array([5.0, 8.0, 5.0]) / 18


class Points(NamedTuple):
    """Places on surfaces, all of a patch one after the other."""

    place: np.ndarray  # (n, 3) [m]
    normal: np.ndarray  # (n, 3): dc/du x dc/dv, outwards, as long as the area of du dv [m^2]
    grain: np.ndarray  # (n,)


class Measures(NamedTuple):
    """Of each grain."""

    volume: np.ndarray  # (n,) [m^3]
    area: np.ndarray  # (n,) [m^2]


def curve_weights(xi):
    """(4, ...): w_k of c(xi) = sum_k w_k x_k between x_1 and x_2 (uniform Catmull-Rom)."""
    a, b = xi**2, xi**3
    return np.array([-xi / 2 + a - b / 2, 1 - 2.5 * a + 1.5 * b, xi / 2 + 2 * a - 1.5 * b, (b - a) / 2])


def curve_slopes(xi):
    """dw_k/dxi."""
    a = xi**2
    return np.array([-0.5 + 2 * xi - 1.5 * a, -5 * xi + 4.5 * a, 0.5 + 4 * xi - 4.5 * a, 1.5 * a - xi])


def nets_of(snapshot):
    """(quads, 4, 4, 3) [m]: the places P_ij round each quad, in the order of the snapshot's quads."""
    quad, owner = snapshot.surface["quad"].astype(int), snapshot.surface["grain"].astype(int).ravel()
    x = snapshot.outlines["position"]
    first = np.flatnonzero(np.diff(owner, prepend=-1))
    nets = []
    for begin, end in zip(first, np.append(first[1:], len(quad))):
        least = quad[begin:end].min()
        nets.append(_places(x, least, (quad[begin:end] - least).tobytes(), end - begin))
    return np.concatenate(nets) if nets else np.empty((0, 4, 4, 3))


def points_on(snapshot, u, v):
    """At (u, v), arrays of places in [0, 1], on every patch."""
    owner = snapshot.surface["grain"].astype(int).ravel()
    nets, u, v = nets_of(snapshot), np.asarray(u, float), np.asarray(v, float)
    w_u, w_v, s_u, s_v = curve_weights(u), curve_weights(v), curve_slopes(u), curve_slopes(v)
    place, along_u, along_v = (np.einsum("iq,jq,pijk->pqk", a, b, nets).reshape(-1, 3)
                               for a, b in ((w_u, w_v), (s_u, w_v), (w_u, s_v)))
    return Points(place, np.cross(along_u, along_v), np.repeat(owner, u.size))


def gyration(snapshot):
    """(n, 3, 3) [m^2]: second moment about the centroid over the volume, by int x_i x_j = 1/5 of the integral of x_i x_j (x . n) over
    the surface and int x_i = 1/4 of that of x_i (x . n); R^2/5 of a sphere."""
    x, flow, grain, grains, fullness = _on_gauss_points(snapshot)

    def over_grains(values):
        return np.stack([np.bincount(grain, flow * column, grains) for column in values.reshape(len(values), -1).T], axis=-1)

    volume = np.bincount(grain, flow, grains)[:, None] / 3
    mean = over_grains(x) / (4 * volume)
    second = over_grains(np.einsum("pi,pj->pij", x, x)) / (5 * volume)
    return fullness[:, None, None] ** (2 / 3) * (second.reshape(-1, 3, 3) - np.einsum("gi,gj->gij", mean, mean))


def patch_areas(snapshot):
    """(quads,) [m^2], by Gauss points."""
    points, share = _gauss_points(snapshot)
    fullness = np.array([fullness_of(count) for count in np.bincount(snapshot.surface["grain"].astype(int).ravel())])
    area = (share * np.linalg.norm(points.normal, axis=1)).reshape(-1, 9).sum(axis=1)
    return area * fullness[points.grain[::9]] ** (2 / 3)


def _gauss_points(snapshot):
    at, weight = GAUSS
    u, v = np.meshgrid(at, at, indexing="ij")
    points = points_on(snapshot, u.ravel(), v.ravel())
    return points, np.tile(np.outer(weight, weight).ravel(), len(points.grain) // 9)


def _on_gauss_points(snapshot):
    """Places from the grains' centres, x . n times the share, grains, how many, and their fullness."""
    points, share = _gauss_points(snapshot)
    centre = solids.centres(snapshot)
    grains = len(centre)
    x = points.place - centre[points.grain]
    fullness = np.array([fullness_of(count) for count in np.bincount(snapshot.surface["grain"].astype(int).ravel(), minlength=grains)])
    return x, share * np.einsum("pk,pk->p", x, points.normal), points.grain, grains, fullness


def measures(snapshot):
    """Volume and area within the smooth surfaces, as the columns `phi` and `sphericity` take them: by 3 x 3 Gauss points
    of each patch, V = 1/3 sum c . n, A = sum |n|, over what the same surface has of a sphere at rest."""
    _, flow, grain, grains, fullness = _on_gauss_points(snapshot)
    owner = snapshot.surface["grain"].astype(int).ravel()
    return Measures(fullness * np.bincount(grain, flow / 3, grains), np.bincount(owner, patch_areas(snapshot), grains))


@lru_cache
def fullness_of(quads):
    """Volume of a sphere over that within the smooth surface of 6 n^2 quads through its vertices; 1 for other numbers."""
    n = round(np.sqrt(quads / 6))
    if quads == 0 or 6 * n * n != quads:
        return 1.0
    vertex, quad = cubed_sphere(n)
    (at, weight), net = GAUSS, _places(vertex, 0, quad.tobytes(), quads)
    u, v = (a.ravel() for a in np.meshgrid(at, at, indexing="ij"))
    c, c_u, c_v = (np.einsum("iq,jq,pijk->pqk", a, b, net) for a, b in (
        (curve_weights(u), curve_weights(v)), (curve_slopes(u), curve_weights(v)), (curve_weights(u), curve_slopes(v))))
    inside = np.einsum("pqk,pqk,q->", c, np.cross(c_u, c_v), np.outer(weight, weight).ravel()) / 3
    return 4 / 3 * np.pi / inside


def cubed_sphere(n):
    """Vertices (6 n^2 + 2, 3) and quads (6 n^2, 4) of the outline of a grain at rest, of unit radius: equal angles along the faces
    of a cube."""
    number, vertex, quads = {}, [], []
    for axis in range(3):
        for side in (0, n):
            for j in range(n):
                for i in range(n):
                    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
                    face = []
                    for a, b in corners if side else [corners[k] for k in (0, 3, 2, 1)]:
                        place = [0, 0, 0]
                        place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = side, i + a, j + b
                        if tuple(place) not in number:
                            number[tuple(place)] = len(vertex)
                            d = np.tan(np.pi / 4 * (2 * np.array(place) / n - 1))
                            vertex.append(d / np.linalg.norm(d))
                        face.append(number[tuple(place)])
                    quads.append(face)
    return np.array(vertex), np.array(quads)


def _places(x, first, quads, count):
    """The net of each quad of a grain whose vertices begin at `first`; what the net lacks at a vertex of valence 3 is made from
    that vertex' third neighbour C, which stands at P_00."""
    vertex, ghosts = _nets(quads, count)
    P = x[first + vertex]
    g = P[ghosts]
    C, P_11, P_21, P_12 = g[:, 0, 0].copy(), g[:, 1, 1], g[:, 2, 1], g[:, 1, 2]
    g[:, 0, 1] = 0.75 * (P_12 + C) - 0.5 * P_11
    g[:, 1, 0] = 0.75 * (P_21 + C) - 0.5 * P_11
    g[:, 0, 0] = g[:, 0, 1] + g[:, 1, 0] - P_21 - P_12 + g[:, 2, 2]
    P[ghosts] = g
    return P


@lru_cache(maxsize=16)
def _nets(quads, count):
    """Vertices (quads, 4, 4) of the net of each quad, and which have ghosts, from the bytes of the quads of one grain."""
    quad = np.frombuffer(quads, int).reshape(count, 4)
    beside = {(a, b): q for q, corners in enumerate(quad.tolist()) for a, b in zip(corners, corners[1:] + corners[:1])}
    round_ = {}
    for q, corners in enumerate(quad.tolist()):
        for vertex in corners:
            round_.setdefault(vertex, []).append(corners)
    nets, ghosts = np.empty((count, 4, 4), int), np.zeros(count, bool)
    for q, corners in enumerate(quad.tolist()):
        of_three = [k for k in range(4) if len(round_[corners[k]]) == 3]
        turn = of_three[0] if of_three else 0
        a, b, c, d = corners[turn:] + corners[:turn]

        def across(a, b):
            """Beyond the edge from a to b: the neighbour of a there, then that of b."""
            other = quad[beside[b, a]].tolist()
            k = other.index(b)
            return other[(k + 2) % 4], other[(k + 3) % 4]

        def opposite(vertex, before, after):
            """To a vertex in the quad round it that has neither of its neighbours here."""
            for other in round_[vertex]:
                if before not in other and after not in other:
                    return other[(other.index(vertex) + 2) % 4]
            return vertex

        ab, bc, cd, da = across(a, b), across(b, c), across(c, d), across(d, a)
        ghosts[q] = bool(of_three)
        corner = ab[0] if of_three else opposite(a, d, b)
        nets[q] = [[corner, da[1], da[0], opposite(d, c, a)],
                   [ab[0], a, d, cd[1]],
                   [ab[1], b, c, cd[0]],
                   [opposite(b, a, c), bc[0], bc[1], opposite(c, b, d)]]
    return nets, ghosts
