#!/usr/bin/env python3
"""Draws results/shapes.png from a run of case.toml: plot.py RUN. Needs Debian's python3-matplotlib."""
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python"))
import softgrain  # noqa: E402
from softgrain import picture  # noqa: E402

RESULTS = pathlib.Path(__file__).parent / "results"
LARGEST = 1.5  # of the pressures [MPa]


def main(path):
    run = softgrain.open(path)
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    figure, frames = plt.subplots(1, 2, figsize=(6.6, 3.1), layout="constrained")
    for axes, step in zip(frames, (0, len(run) - 1)):
        snapshot = run[step]
        shapes = picture.surface(snapshot, snapshot.particles["pressure"] / 1e6)
        cells = PolyCollection([1e3 * np.asarray(p) for p in shapes.polygons], array=shapes.values, cmap="cividis",
                               clim=(0, LARGEST), edgecolors="face", linewidths=0.2)
        axes.add_collection(cells)
        for rim in shapes.rims:
            axes.plot(*np.vstack([rim, rim[:1]]).T * 1e3, color="black", linewidth=0.5)
        axes.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
        axes.autoscale_view()
    figure.colorbar(cells, ax=frames, label="pressure [MPa]", shrink=0.8, extend="max")
    RESULTS.mkdir(exist_ok=True)
    figure.savefig(RESULTS / "shapes.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
