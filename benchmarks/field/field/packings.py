"""Where a packing starts, and how its contacts are counted, for codes that do not do it themselves."""

import csv
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Start:
    """Disks in a periodic cell with a corner at 0. Kinds count from 1."""

    x: np.ndarray
    y: np.ndarray
    radius: np.ndarray
    kind: np.ndarray
    width: float
    height: float


def write_start(path, start):
    """start.csv: a line for each grain; the cell stands in its first comment."""
    with path.open("w", newline="") as file:
        file.write(f"# periodic cell {start.width:.9g} m x {start.height:.9g} m, corner at 0\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("x[m]", "y[m]", "radius[m]", "kind"))
        table.writerows((f"{x:.9g}", f"{y:.9g}", f"{r:.9g}", k) for x, y, r, k in zip(start.x, start.y, start.radius, start.kind))


def read_start(path):
    lines = path.read_text().splitlines()
    words = lines[0].split()
    rows = np.array([[float(word) for word in line.split(",")] for line in lines[2:]])
    return Start(rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3].astype(int), float(words[3]), float(words[6]))


def coordination(grains, pairs):
    """(Z, Z without rattlers) by softgrain's definition: Z = 2 pairs/grains; rattlers have fewer than two contacts and
    are taken out one after the other."""
    z = 2 * len(pairs) / grains
    kept = np.ones(grains, bool)
    while len(pairs):
        number = np.bincount(pairs.ravel(), minlength=grains)
        loose = kept & (number < 2)
        if not loose.any():
            break
        kept &= ~loose
        pairs = pairs[~loose[pairs].any(axis=1)]
    kept &= np.bincount(pairs.ravel(), minlength=grains) > 0 if len(pairs) else False
    return z, 2 * len(pairs) / kept.sum() if kept.any() else 0.0


def start_of_run(folder):
    """Where the grains of a run of softgrain in a periodic cell were at its start."""
    import softgrain

    snapshot = softgrain.open_run(folder)[0]
    centre, radius = snapshot.bodies(), snapshot.body_radii()
    kind = snapshot.particles.get("kind")
    grain = snapshot.particles["grain"]
    of_grain = np.ones(len(radius), int)
    if kind is not None:
        of_grain[grain] = np.asarray(kind, int) + (1 if np.min(kind) == 0 else 0)
    width, height = np.linalg.norm(snapshot.cell, axis=1)
    return Start(centre[:, 0], centre[:, 1], radius, of_grain, float(width), float(height))
