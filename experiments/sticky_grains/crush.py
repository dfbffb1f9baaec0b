#!/usr/bin/env python3
"""Diametral crush of a compact of sticky grains.

    crush.py cut COMPACT              writes disk.csv from the last state of a run of compact.toml
    crush.py draw CRUSH PULL          writes results/crush.csv and results/crush.png; PULL is a run of case.toml
"""
import csv
import math
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "python"))
import softgrain  # noqa: E402

ALLOWED = 0.009  # overlap of two grains over the smaller radius, at most
CENTRE = 15e-3  # of the disk along x [m]


def grains_of(snapshot):
    """Centres and undeformed radii."""
    grain = snapshot.particles["grain"].astype(int)
    area = math.pi * snapshot.particles["radius"] ** 2 / snapshot.particles["J"]
    size = np.bincount(grain, area)
    centre = np.stack([np.bincount(grain, area * snapshot.particles["position"][:, k]) / size for k in (0, 1)], axis=1)
    return centre, np.sqrt(size / math.pi)


def cut(path):
    run = softgrain.open(path)
    centre, radius = grains_of(run[len(run) - 1])
    middle = (centre.min(axis=0) + centre.max(axis=0)) / 2
    reach = np.linalg.norm(centre - middle, axis=1) + radius
    half = min(np.abs(centre - middle).max(axis=0)) + radius.mean()
    inside = reach < 1.04 * half
    x, r = centre[inside] - middle, radius[inside]
    # apart until no pair overlaps by more than a sample may; pairs that were pressed flat then just touch
    for _ in range(2000):
        moved = np.zeros_like(x)
        worst = 0.0
        for i in range(len(x)):
            d = x[i] - x
            gap = np.linalg.norm(d, axis=1) - r[i] - r
            gap[i] = 1
            for j in np.flatnonzero(gap < -0.5 * ALLOWED * r.min()):
                moved[i] += -0.25 * gap[j] * d[j] / np.linalg.norm(d[j])
                worst = max(worst, -gap[j])
        x += moved
        if worst < ALLOWED * r.min():
            break
    x -= x.min(axis=0)
    x[:, 0] += CENTRE - x[:, 0].max() / 2
    with open(HERE / "disk.csv", "w") as file:
        file.write(f"# {len(x)} grains of a pressed compact, within a circle\nx [mm], y [mm], radius [mm]\n")
        for (a, b), R in zip(1e3 * x, 1e3 * r):
            file.write(f"{a:.5f}, {b:.5f}, {R:.5f}\n")
    print(len(x), "grains, diameter [mm]", 1e3 * (np.linalg.norm(x - x.mean(axis=0), axis=1) + r).max() * 2)


def draw(crush_path, pull_path):
    crush, pull = softgrain.open(crush_path), softgrain.open(pull_path)
    series = crush.series
    force = (series["force_top"] + series["force_bottom"]) / 2
    first = next(step for step in range(len(crush)) if crush[step].time >= 59e-3)
    outline = crush[first].outlines["position"]
    width, height = np.ptp(outline, axis=0)
    tensile = 2 * force / (math.pi * width)  # sigma_t = 2 P/(pi D), on the axis of the disk
    way = series["wall_height"][0] - series["wall_height"]
    way = way - (series["wall_height"][0] - height)  # since the walls touch
    peak = int(np.argmax(np.where(way < 0.2 * height, tensile, 0)))
    pulled = -np.min((pull.series["stress_top"] + pull.series["stress_bottom"]) / 2)
    rows = [("grains", int(crush[0].particles["grain"].max()) + 1), ("width of the disk [mm]", 1e3 * width),
            ("height of the disk [mm]", 1e3 * height), ("largest force P before 0.2 D [N/m]", force[peak]),
            ("at travel over D", way[peak] / height), ("2 P/(pi D) [Pa]", tensile[peak]),
            ("tensile strength by pulling [Pa]", pulled), ("ratio", tensile[peak] / pulled),
            ("energy missing up to there over the walls' work", np.abs(series["energy_error"][:peak]).max() / series["wall_work"][peak]),
            ("energy missing in all over the walls' work", np.abs(series["energy_error"]).max() / series["wall_work"].max())]
    with open(HERE / "results/crush.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([name, f"{value:.4g}"] for name, value in rows)
    for row in rows:
        print(*row)
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    figure, axes = plt.subplots(1, 4, figsize=(7.2, 2.3), layout="constrained", width_ratios=(1.25, 1, 1, 1))
    axes[0].plot(way / height, tensile, linewidth=0.9, label=r"crush: $2P/\pi D$")
    axes[0].axhline(pulled, color="C1", linewidth=0.9, linestyle="--", label="pulling")
    axes[0].set(xlabel="travel / D", ylabel="stress [Pa]", xlim=(0, None), ylim=(0, 260))
    axes[0].legend(frameon=False, loc="upper right")
    travel = [np.interp(snapshot.time, series["time"], way / height) for snapshot in crush]
    after = next(step for step, share in enumerate(travel) if share > way[peak] / height + 0.015)
    for panel, step in zip(axes[1:], (first, after, len(crush) - 1)):
        grain = crush[step].outlines["grain"].astype(int)
        x = 1e3 * crush[step].outlines["position"]
        panel.add_collection(PolyCollection([x[grain == g] for g in range(grain.max() + 1)], facecolors="#cfd8dc",
                                            edgecolors="black", linewidths=0.5))
        panel.set(aspect="equal", xlim=(5, 25), ylim=(-1, 17), xticks=(), yticks=(),
                  title=f"{max(travel[step], 0):.2f}")
    figure.savefig(HERE / "results/crush.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    {"cut": cut, "draw": draw}[sys.argv[1]](*sys.argv[2:])
