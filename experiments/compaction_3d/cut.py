"""A plane through packings: the smooth surfaces of the grains as they are cut by it, so that crossings can be seen.

    cut.py RUN[@STEP]... -o PICTURE [--at 0.5] [--window X0,X1,Y0,Y1] [--fine 6]

The plane is z = at of the box's height; the last snapshot of each run where no step is named. The window is a part of the cut, as
shares of the box."""

import argparse
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

from crossings import fine_triangles  # noqa: E402
from softgrain.snapshot import Snapshot  # noqa: E402


def segments(corners, height):
    """Where triangles (n, 3, 3) meet z = height: ((m, 2, 2), which of them)."""
    z = corners[:, :, 2] - height
    which = np.flatnonzero((z.min(axis=1) < 0) & (z.max(axis=1) > 0))
    corners, z = corners[which], z[which]
    ends = np.full((len(which), 2, 2), np.nan)
    found = np.zeros(len(which), int)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        cut = np.flatnonzero((z[:, a] < 0) != (z[:, b] < 0))
        share = (z[cut, a] / (z[cut, a] - z[cut, b]))[:, None]
        ends[cut, found[cut]] = (corners[cut, a] + share * (corners[cut, b] - corners[cut, a]))[:, :2]
        found[cut] += 1
    return ends, which


def snapshot_of(name):
    run, _, step = name.partition("@")
    paths = {int(path.stem[1:]): path for path in (Path(run) / "snap").glob("s*.h5")}
    return Snapshot.read(paths[int(step) if step else max(paths)])


def draw(axes, snapshot, options):
    walls = snapshot.surface["walls"].reshape(-1, 3)
    low, high = walls.min(axis=0), walls.max(axis=0)
    corners, owner = fine_triangles(snapshot, options.fine)
    ends, which = segments(corners, low[2] + options.at * (high[2] - low[2]))
    colours = plt.get_cmap("tab10")(owner[which] % 10)
    axes.add_collection(LineCollection((ends - low[:2]) / (high[:2] - low[:2]), colors=colours, linewidths=0.7))
    x0, x1, y0, y1 = options.window
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect=(high[1] - low[1]) / (high[0] - low[0]), xticks=[], yticks=[])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", nargs="+")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--at", type=float, default=0.5)
    parser.add_argument("--window", type=lambda text: [float(x) for x in text.split(",")], default=[0, 1, 0, 1])
    parser.add_argument("--fine", type=int, default=6)
    options = parser.parse_args()
    figure, panels = plt.subplots(1, len(options.run), figsize=(3.2 * len(options.run), 3.3), squeeze=False)
    for axes, name in zip(panels[0], options.run):
        draw(axes, snapshot_of(name), options)
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=0.99, wspace=0.03)
    figure.savefig(options.output, dpi=130)


if __name__ == "__main__":
    main()
