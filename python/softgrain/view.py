"""How grains in space are looked at in still pictures: parallel projection, faces shaded, the farthest first."""

from typing import NamedTuple

import numpy as np

from .run import NotRecorded

AZIMUTH, ELEVATION = np.radians(-62), np.radians(18)  # from where one looks
LIGHT = np.array([0.35, -0.75, 0.8]) / np.linalg.norm([0.35, -0.75, 0.8])
MARGIN = 0.01  # of the width, so that lines of edges are whole
DARKEST = 0.35  # of a face that looks away from the light
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))


class Faces(NamedTuple):
    """Those that look at us, the farthest first."""

    corners: np.ndarray  # (n, 4, 2) [m]
    quad: np.ndarray  # (n,): which of the snapshot's quads each is
    shade: np.ndarray  # (n,): share of its colour that the light leaves


def directions():
    """Unit vectors to the right, upwards and towards us."""
    right = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0])
    towards = np.array([np.cos(ELEVATION) * np.cos(AZIMUTH), np.cos(ELEVATION) * np.sin(AZIMUTH), np.sin(ELEVATION)])
    return np.array([right, np.cross(towards, right), towards])


def project(points):
    """(n, 3) [m]: to the right, upwards, towards us."""
    return np.asarray(points) @ directions().T


def with_surfaces(snapshots):
    """Those that have some. Raises NotRecorded where none has."""
    found = [snapshot for snapshot in snapshots if "quad" in snapshot.surface]
    if not found:
        raise NotRecorded("no snapshot has surfaces: those are of runs with experiment.dimension = 3")
    return found


def extent(snapshots):
    """(x0, x1, y0, y1) [m] of all surfaces and walls, as they are seen, with a margin."""
    points = [points for s in snapshots for points in (s.outlines["position"], s.surface["walls"].reshape(-1, 3))]
    seen = project(np.concatenate(points))[:, :2]
    margin = MARGIN * np.ptp(seen[:, 0])
    (x0, y0), (x1, y1) = seen.min(0) - margin, seen.max(0) + margin
    return x0, x1, y0, y1


def walls(snapshot):
    """(walls, 4, 2) [m]: their corners."""
    return project(snapshot.surface["walls"].reshape(-1, 3)).reshape(-1, 4, 3)[:, :, :2]


def faces(snapshot) -> Faces:
    """The quads of the surfaces."""
    place = snapshot.outlines["position"][snapshot.surface["quad"].astype(int)]  # (quads, 4, 3)
    normal = np.cross(place[:, 2] - place[:, 0], place[:, 3] - place[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]  # a quad may have no area
    seen = project(place.reshape(-1, 3)).reshape(-1, 4, 3)
    facing = normal @ directions()[2] > 0
    order = np.flatnonzero(facing)[np.argsort(seen[facing, :, 2].mean(1))]
    shade = DARKEST + (1 - DARKEST) * np.clip(normal[order] @ LIGHT, 0, 1)
    return Faces(seen[order, :, :2], order, shade)
