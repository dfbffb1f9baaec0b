"""When a packing on the paper's lattice begins to bear load, with contact on its nodes and on outlines.

    lattice.py RUN ... -o DIR

Runs of `compaction-mpm` with mpm.formulation = "updated_lagrangian". Writes DIR/lattice.csv, one row a run, and DIR/lattice.png.
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import softgrain
import softgrain.measure
from softgrain.reproduce.geometry import coordination_of_load
from softgrain.reproduce.tables import write_rows

BEARS = 20e3  # [Pa] of the bottom wall
WINDOW = 0.01  # of strain, over which its stress is averaged
AT = 0.08  # the strain where the paper says Z = 3
HEADER = ("contact on", "cell / mean R", "seed", "grains", "bottom bears 20 kPa from", "Z at a strain of 0.08")
COLOURS = {"grid_nodes": "#009e73", "outline": "#0072b2"}


def cell_over_radius(case):
    """The cell follows the smallest grain: 14 cells^2 points, four to a cell, in pi R^2."""
    sample = case["sample"]
    cell = sample["smallest_diameter"] / 2 * np.sqrt(np.pi / 3.5) / case["mpm"]["cells"]
    return 4 * cell / (sample["smallest_diameter"] + sample["largest_diameter"])


def row(run):
    strain, stress = run.series["strain"], run.series["stress_bottom"]
    mean = softgrain.measure.moving_mean(strain, stress, WINDOW)
    bears = np.flatnonzero(mean > BEARS)
    at = np.interp(run.times, run.series["time"], strain)
    z = np.interp(AT, at, [coordination_of_load(snapshot) for snapshot in run])
    return (run.case["mpm"]["contact_on"], cell_over_radius(run.case), run.case["sample"]["seed"], run.case["sample"]["grains"],
            float(strain[bears[0]]) if bears.size else float("nan"), float(z))


def draw(rows, path):
    """Runs as circles; their means, those on nodes from where they meet those on outlines when a cell is nothing."""
    figure, axes = plt.subplots(figsize=(3.6, 2.8), layout="constrained")
    outline = np.mean([r[4] for r in rows if r[0] == "outline"])
    for contact_on, colour in COLOURS.items():
        some = [(r[1], r[4]) for r in rows if r[0] == contact_on and np.isfinite(r[4])]
        axes.plot(*zip(*some), "o", color=colour, ms=4, mfc="none")
        cells = sorted({cell for cell, _ in some})
        means = [np.mean([strain for cell, strain in some if cell == one]) for one in cells]
        axes.plot([0, *cells], [outline, *means], color=colour, lw=0.8, label=f"contact on {contact_on.replace('_', ' ')}")
    axes.plot(0.058, 0.08, "s", color="#cc79a7", label="the paper")
    axes.set(xlabel="cell / mean $R$", ylabel="strain from which\nthe bottom wall bears", xlim=(0, None), ylim=(0, 0.13))
    axes.legend(frameon=False, fontsize=7, loc="lower left")
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="+", metavar="RUN")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    rows = sorted(row(softgrain.open(Path(path))) for path in options.runs)
    write_rows(options.output / "lattice.csv", HEADER,
               ([f"{value:.4g}" if isinstance(value, float) else value for value in r] for r in rows))
    draw(rows, options.output / "lattice.png")


if __name__ == "__main__":
    main()
