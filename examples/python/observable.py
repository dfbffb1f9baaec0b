"""An observable of one's own: how far from round the grains of a packing are, not in the mean but grain by grain.

    python3 examples/python/observable.py [FIGURE]

Needs the compiled module: export PYTHONPATH=build/release/python. Any function of the arrays of a simulation is an observable.
"""

import sys

import numpy as np

import softgrain

CASE = {"experiment": {"model": "mpm", "loading": "compaction"}, "mpm.cells": 8, "contact.friction": 0.3,
        "sample": {"grains": 12, "packing_fraction": 0.6}, "loading": {"wall_velocity": "5 m/s", "max_strain": 0.4}}


def circularity(outline):
    """4 pi A/P^2 of a polygon (n, 2): 1 for a circle, less for everything else."""
    side = np.roll(outline, -1, axis=0) - outline
    area = 0.5 * np.sum(outline[:, 0] * side[:, 1] - outline[:, 1] * side[:, 0])
    return 4 * np.pi * area / np.sum(np.hypot(side[:, 0], side[:, 1])) ** 2


def compact(case=CASE, every=15):
    """Rows of the series, each with the least and the greatest circularity among its grains."""
    rows = []
    simulation = softgrain.Simulation(case)
    for now in simulation.steps(every=every):
        shapes = [circularity(grain.outline) for grain in now.grains]  # views: nothing is copied
        rows.append(now.observe() | {"circularity_least": min(shapes), "circularity_mean": np.mean(shapes)})
    return rows


def draw(rows, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(4.5, 3), layout="constrained")
    phi = [row["phi_0"] for row in rows]
    axes.plot(phi, [row["circularity_mean"] for row in rows], color="k", label="mean")
    axes.plot(phi, [row["circularity_least"] for row in rows], color="k", ls="--", label="the least round grain")
    axes.set(xlabel=r"packing fraction $\Phi_0$", ylabel=r"circularity $4\pi A/P^2$")
    axes.legend(frameon=False)
    figure.savefig(path)


def main(*arguments):
    rows = compact()
    for row in rows:
        print(f"strain {row['strain']:.2f}: circularity {row['circularity_mean']:.4f} in the mean, {row['circularity_least']:.4f} at least")
    if arguments:
        draw(rows, arguments[0])


if __name__ == "__main__":
    main(*sys.argv[1:])
