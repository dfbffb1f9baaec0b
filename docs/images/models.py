#!/usr/bin/python3
"""Draws models.png: one grain of each model, at rest and squeezed.

    softgrain new bonded --template diametral-bpm; softgrain run bonded/case.toml --set bpm.primaries=200 -o bonded/run
    softgrain new elastic --template diametral-mpm; softgrain run elastic/case.toml --set mpm.cells=8 -o elastic/run
    docs/images/models.py bonded/run elastic/run docs/images/models.png
"""
import sys
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import EllipseCollection
from PIL import Image

MM = 1e3


def snapshots(run):
    return sorted((Path(run) / "snap").glob("s*.h5"))


def most_squeezed(run):
    """The snapshot whose walls are closest."""
    def height(file):
        with h5py.File(file) as snapshot:
            return np.ptp(snapshot["scene/walls"][:, 1])
    return min(snapshots(run), key=height)


def draw(axes, file, largest, title):
    with h5py.File(file) as snapshot:
        scene = snapshot["scene"]
        x, r, p = (scene["particles"][name][:] for name in ("position", "radius", "pressure"))
        walls = scene["walls"][:]
        outline = scene["outlines/position"][:] if "J" in scene["particles"] else None
    for height in sorted(walls[:, 1])[:1] + sorted(walls[:, 1])[-1:]:
        axes.axhline(MM * height, color="black", lw=2)
    disks = EllipseCollection(2 * MM * r, 2 * MM * r, 0, units="xy", offsets=MM * x, transOffset=axes.transData,
                              array=p / largest, cmap="cividis", edgecolors="black" if outline is None else "none",
                              linewidths=0.3)
    disks.set_clim(0, 1)
    axes.add_collection(disks)
    if outline is not None:
        axes.plot(*MM * np.vstack([outline, outline[:1]]).T, color="black", lw=0.8, marker=".", ms=2)
    axes.set_title(title, fontsize=10)
    axes.set_aspect("equal")
    axes.axis("off")
    return MM * x.mean(axis=0), MM * np.ptp(x[:, 1]) / 2


def main(bonded, elastic, picture):
    figure, panels = plt.subplots(1, 4, figsize=(10, 2.7), layout="constrained")
    for run, (rest, squeezed), name in ((bonded, panels[:2], "bpm: rigid primaries that attract"),
                                        (elastic, panels[2:], "mpm: material points in an outline")):
        end = most_squeezed(run)
        with h5py.File(end) as snapshot:
            largest = np.percentile(snapshot["scene/particles/pressure"][:], 98)
        (x, y), radius = draw(rest, snapshots(run)[0], largest, name)
        draw(squeezed, end, largest, "squeezed")
        for axes in (rest, squeezed):
            axes.set(xlim=(x - 1.5 * radius, x + 1.5 * radius), ylim=(y - 1.15 * radius, y + 1.15 * radius))
    figure.savefig(picture, dpi=100)
    Image.open(picture).convert("RGB").quantize(64).save(picture, optimize=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
