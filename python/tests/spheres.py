"""Snapshots of spheres that nothing has deformed yet, in a box of walls or a periodic cell."""

import numpy as np

from softgrain import patches
from softgrain.run import Snapshot


def turn(seed):
    """A rotation (3, 3), none for seed None."""
    if seed is None:
        return np.eye(3)
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def faces_of(box):
    """Walls of a box from the origin on, in the order of a run: two across z, two across y, two across x."""
    walls = []
    for k in (2, 1, 0):
        for side in (0, 1):
            along = [axis for axis in range(3) if axis != k]
            face = np.zeros((4, 3))
            face[:, along] = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * np.asarray(box, float)[along]
            face[:, k] = side * box[k]
            walls.append(face.ravel())
    return np.array(walls)


def packing_of(centres, radii, box, repeats=(False, False, False), cells=4, turns=None):
    """A snapshot; turns: a seed for each sphere's grid."""
    vertex, quad = patches.cubed_sphere(cells)
    grains = len(centres)
    turns = [None] * grains if turns is None else turns
    position = np.concatenate([np.asarray(c) + r * vertex @ turn(seed).T for c, r, seed in zip(centres, radii, turns)])
    return Snapshot(
        step=0, time=0.0,
        particles={"position": np.array(centres, float), "radius": np.array(radii, float), "grain": np.arange(grains)},
        outlines={"position": position, "grain": np.repeat(np.arange(grains), len(vertex))},
        surface={"quad": np.concatenate([quad + k * len(vertex) for k in range(grains)]),
                 "grain": np.repeat(np.arange(grains), len(quad)), "pressure": np.zeros(grains * len(quad)), "walls": faces_of(box)},
        cell=np.diag(np.where(repeats, box, 0.0)) if any(repeats) else np.empty((0, 3)))
