#!/usr/bin/env python3
"""Draws results/grain.png from a run of case.toml: plot.py RUN. Needs Debian's python3-matplotlib."""
import math
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python"))
import softgrain  # noqa: E402

RESULTS = pathlib.Path(__file__).parent / "results"
YIELD, RADIUS = 1e5, 1e-3
# d/R and F/(sigma_y R) of finite elements, good to 1 %
REFERENCE = [(.01, .399), (.02, .677), (.05, 1.003), (.1, 1.197), (.2, 1.585), (.3, 2.168)]


def main(path):
    run = softgrain.open(path)
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    figure, (curve, grain) = plt.subplots(1, 2, figsize=(6.6, 2.9), layout="constrained")
    approach = 1 - np.exp(-np.asarray(run.series["strain"]))
    force = (np.asarray(run.series["force_top"]) + np.asarray(run.series["force_bottom"])) / (2 * YIELD * RADIUS)
    curve.plot(approach, force, color="#0072B2", linewidth=1, label="16 cells")
    curve.plot(*zip(*REFERENCE), "o", color="#D55E00", markersize=3.5, label="finite elements")
    curve.set(xlabel="$d/R$", ylabel=r"$F/(\sigma_y R)$", xlim=(0, None), ylim=(0, None))
    curve.legend(frameon=False)
    last = run[len(run) - 1]
    x = 1e3 * last.particles["position"]
    size = (1e3 * last.particles["radius"] * 72 * 2.4 / 2.6 * 2) ** 2
    points = grain.scatter(x[:, 0], x[:, 1], s=size, c=last.particles["plastic_strain"], cmap="viridis", linewidths=0)
    outline = 1e3 * last.outlines["position"]
    grain.plot(*np.vstack([outline, outline[:1]]).T, color="black", linewidth=0.6)
    grain.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    figure.colorbar(points, ax=grain, label=r"plastic strain $\alpha$", shrink=0.8)
    figure.savefig(RESULTS / "grain.png", dpi=200, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
