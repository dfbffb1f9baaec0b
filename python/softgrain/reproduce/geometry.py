"""Who is near whom in a snapshot, and who touches whom away from the walls."""

import numpy as np


def outlines_of(snapshot):
    """Polygons of all grains, a list of (v, 2) [m]."""
    grain, position = snapshot.outlines["grain"].astype(int), snapshot.outlines["position"]
    return [position[grain == g] for g in range(int(grain.max()) + 1)]


def near_pairs(outlines, reach):
    """Pairs (a, b) whose bounding boxes come within `reach` [m]."""
    low = np.array([x.min(axis=0) for x in outlines]) - reach / 2
    high = np.array([x.max(axis=0) for x in outlines]) + reach / 2
    apart = (low[:, None] > high[None]).any(axis=2) | (low[None] > high[:, None]).any(axis=2)
    return np.argwhere(np.triu(~apart, 1))


def gap(a, b):
    """Distance of two polygons [m], from the vertices of each to the segments of the other; not below zero."""
    return min(_to_segments(a, b), _to_segments(b, a))


def _to_segments(points, polygon):
    start, way = polygon, np.roll(polygon, -1, axis=0) - polygon
    d = points[:, None] - start[None]
    share = np.clip((d * way).sum(axis=2) / (way**2).sum(axis=1), 0, 1)
    return float(np.linalg.norm(d - share[..., None] * way, axis=2).min())


def coordination_within(snapshot, reach):
    """Z = 2 N_pairs/N_grains of pairs of outlines nearer than `reach` [m]."""
    outlines = outlines_of(snapshot)
    pairs = sum(gap(outlines[a], outlines[b]) < reach for a, b in near_pairs(outlines, reach))
    return 2 * pairs / len(outlines)


def coordination_of_inner(snapshot):
    """Z among the grains that touch no wall: the mean number of their neighbours; nan if there is none."""
    table = snapshot.contact_table()
    grains = int(snapshot.outlines["grain"].max()) + 1
    a, b, is_wall = table["grain_a"], table["grain_b"], table["wall"] >= 0
    pushes = table["normal_force"] > 0
    between = pushes & ~is_wall & (a != b)
    pairs = np.unique(np.sort(np.column_stack([a, b])[between], axis=1), axis=0)
    neighbours = np.bincount(pairs.ravel(), minlength=grains)
    inner = np.ones(grains, bool)
    inner[a[pushes & is_wall]] = False
    return float(neighbours[inner].mean()) if inner.any() else float("nan")


def coordination_of_load(snapshot, share=0.1):
    """Z = 2 N_pairs/N_grains of pairs of grains that bear more than `share` of the mean normal force of a pair.

    On nodes, grains that are near push on each other all the time, most of them hardly at all."""
    table = snapshot.contact_table()
    between = (table["wall"] < 0) & (table["grain_a"] != table["grain_b"])
    pair = np.sort(np.column_stack([table["grain_a"], table["grain_b"]])[between], axis=1)
    if not len(pair):
        return 0.0
    _, of_pair = np.unique(pair, axis=0, return_inverse=True)
    force = np.bincount(of_pair.ravel(), table["normal_force"][between])
    return 2 * float(np.count_nonzero(force > share * force.mean())) / (int(snapshot.outlines["grain"].max()) + 1)
