"""Packings by the paper's own step, implicit on a lattice: contact on its nodes and on outlines.

    packings_on_a_lattice.py RUN ... -o DIR

Runs of `compaction-mpm` with mpm.formulation = "updated_lagrangian" and mpm.lattice_integrator = "implicit". Adds them to
DIR/lattice_packings.csv, one row a run, and DIR/lattice_curves.csv, and draws all that stand there, DIR/lattice_packings.png.
"""

import argparse
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from lattice import AT, BEARS, COLOURS, WINDOW, cell_over_radius

import softgrain
import softgrain.measure
from softgrain.reproduce.geometry import coordination_of_load
from softgrain.reproduce.tables import write_rows

HEADER = ("contact on", "cell / mean R", "friction", "grains", "seed", "Z at a strain of 0.08", "Z = 3 at a strain of", "Phi_0 there",
          "bottom bears 20 kPa from", "Phi_0 there", "largest energy error / wall work", "steps")
KEY = 5  # columns that name a run
SHOWN = np.arange(0, 0.301, 0.01)


def first(x, y, level):
    """The first x at which y, linear between its values, is at least `level`; NaN if it never is."""
    above = np.flatnonzero(y >= level)
    if above.size == 0:
        return float("nan")
    k = above[0]
    return float(x[0] if k == 0 else np.interp(level, y[k - 1:k + 1], x[k - 1:k + 1]))


class Packing:
    """One run: Z by pairs that bear a tenth of the mean force, over the strain, and the stress on the bottom."""

    def __init__(self, path):
        run = softgrain.open(path)
        case, series = run.case, run.series
        self.key = (case["mpm"]["contact_on"], cell_over_radius(case), case["contact"]["friction"], case["sample"]["grains"])
        self.seed, self.start = case["sample"]["seed"], case["sample"]["packing_fraction"]
        self.strain = series["strain"]
        self.bottom = softgrain.measure.moving_mean(self.strain, series["stress_bottom"], WINDOW)
        self.z_strain = np.interp(run.times, series["time"], self.strain)
        self.z = np.array([coordination_of_load(snapshot) for snapshot in run])
        work = series["wall_work"]
        late = work > 0.1 * np.nanmax(work)
        self.error = float(np.max(np.abs(series["energy_error"][late]) / work[late]))
        self.steps = int(series["step"][-1])

    def row(self):
        z_3, bears = first(self.z_strain, self.z, 3), first(self.strain, self.bottom, BEARS)
        phi = [self.start * np.exp(strain) for strain in (z_3, bears)]
        z_at = float(np.interp(AT, self.z_strain, self.z, right=float("nan")))
        return (*self.key, self.seed, z_at, z_3, phi[0], bears, phi[1], self.error, self.steps)

    def curve(self):
        for strain in SHOWN[SHOWN <= self.strain[-1] + 1e-9]:
            yield (*self.key, self.seed, float(strain), float(np.interp(strain, self.z_strain, self.z)),
                   float(np.interp(strain, self.strain, self.bottom)))


def outline_curve(path):
    """Strain, Z of all pairs that touch, stress on the bottom [Pa] of the first sample: the same grains at the same speed."""
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["seed"] == "1"]
    return (np.array([float(row[name]) for row in rows]) for name in ("strain", "z", "stress_bottom[Pa]"))


def _friction(mu):
    return f", mu = {mu}" if float(mu) else ""


def draw(curves, path):
    """`curves`: {key and seed: rows of strain, Z, stress on the bottom [Pa]}."""
    figure, axes = plt.subplots(1, 3, figsize=(8.2, 3), layout="constrained", gridspec_kw={"width_ratios": (1, 1, 0.55)})
    for (contact_on, cell, friction, grains, _), rows in sorted(curves.items()):
        strain, z, bottom = np.array(rows, float).T
        papers = float(cell) < 0.1  # the paper's own cell
        style = {"color": "#d55e00" if papers else COLOURS[contact_on], "lw": 0.7 * (float(grains) / 20) ** 0.35,
                 "ls": "--" if float(friction) else "-", "alpha": 1 if papers or float(grains) > 100 else 0.6,
                 "label": f"{contact_on.replace('_', ' ')}, {grains} grains, {float(cell):.3f} R" + _friction(friction)}
        axes[0].plot(strain, z, **style)
        axes[1].plot(strain, bottom / 1e3, **style)
    for friction, line in (("0", "-"), ("0.5", "--")):
        strain, z, bottom = outline_curve(Path(__file__).parent / f"results/paper_size/packing_mpm_mu{friction}.csv")
        style = {"color": "black", "lw": 1.2, "ls": line, "label": "outline, 300 grains, total Lagrangian" + _friction(friction)}
        axes[0].plot(strain, z, **style)
        axes[1].plot(strain, bottom / 1e3, **style)
    axes[0].plot(0.08, 3, "s", color="#cc79a7", label="the paper")
    axes[0].set(xlabel="strain", ylabel="Z, of pairs that bear load", xlim=(0, 0.17), ylim=(0, 5))
    axes[1].set(xlabel="strain", ylabel="stress on the bottom [kPa]", xlim=(0, 0.17), ylim=(0, 200))
    handles, labels = axes[0].get_legend_handles_labels()
    axes[2].axis("off")
    axes[2].legend(handles, labels, frameon=False, fontsize=6, loc="center left")
    figure.savefig(path, dpi=150)


def text(row):
    return [f"{value:.4g}" if isinstance(value, float) else value for value in row]


def rows_by_run(path, header, rows):
    """{key and seed: [the rest of each row]} of the table at `path`, if there is one, and of `rows`, which replace those of
    the same run; the table is written anew."""
    kept = {}
    if path.exists():
        with open(path, newline="") as file:
            for row in list(csv.reader(file))[1:]:
                kept.setdefault(tuple(row[:KEY]), []).append(row[KEY:])
    new = {}
    for row in rows:
        new.setdefault(tuple(map(str, row[:KEY])), []).append(row[KEY:])
    kept |= new
    write_rows(path, header, ([*key, *row] for key in sorted(kept) for row in kept[key]))
    return kept


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="*", metavar="RUN")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    packings = [Packing(Path(path)) for path in options.runs]
    rows_by_run(options.output / "lattice_packings.csv", HEADER, [text(packing.row()) for packing in packings])
    curves = rows_by_run(options.output / "lattice_curves.csv", (*HEADER[:KEY], "strain", "Z", "stress on the bottom [Pa]"),
                         [text(row) for packing in packings for row in packing.curve()])
    draw(curves, options.output / "lattice_packings.png")


if __name__ == "__main__":
    main()
