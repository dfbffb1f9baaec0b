#!/usr/bin/env python3
"""Draws results/stress.png, johnson.png and convergence.png from results/*.csv. Needs Debian's python3-matplotlib."""
import csv
import math
import pathlib

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

from study import PLANE_STRAIN, johnson

RESULTS = pathlib.Path(__file__).parent / "results"
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")  # distinct without colour vision, too

plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})


def read(name):
    with open(RESULTS / name, newline="") as file:
        return list(csv.DictReader(file))


def save(figure, name):
    figure.savefig(RESULTS / name, dpi=200, metadata={"Software": None})


def stress():
    """Fig. 1 of the paper, its elastic grain. Width of the grain under Johnson and Eq. (2): 2 R."""
    figure, axes = plt.subplots(figsize=(3.6, 2.9), layout="constrained")
    names = {"neo_hookean": "neo-Hookean", "small_strain_hooke": "small-strain Hooke", "st_venant_kirchhoff": "St Venant-Kirchhoff"}
    rows = read("curves.csv")
    for colour, (law, label) in zip(COLOURS, names.items()):
        line = [(float(r["strain"]), float(r["sigma_MPa"])) for r in rows if r["law"] == law]
        axes.plot(*zip(*line), color=colour, linewidth=1, label=label)
        if line[-1][0] < 0.4:
            axes.plot(*line[-1], "x", color=colour, markersize=4)
    strain = [k * 0.004 for k in range(1, 108)]
    axes.plot(strain, [PLANE_STRAIN * johnson(1 - math.exp(-e)) / 2e6 for e in strain], "k--", linewidth=0.8,
              label="Johnson, $F/2R$")
    axes.plot(strain, [PLANE_STRAIN * math.pi / 4 * e / 2e6 for e in strain], "k:", linewidth=0.8, label="Eq. (2), $F/2R$")
    axes.set(xlabel="strain $\\varepsilon$", ylabel="stress $\\sigma = F/L$ [MPa]", xlim=(0, 0.43), ylim=(0, 3))
    axes.legend(fontsize=6, frameon=False)
    save(figure, "stress.png")


def johnson_error():
    figure, axes = plt.subplots(figsize=(3.6, 2.6), layout="constrained")
    axes.axhline(0, color="0.7", linewidth=0.6)
    rows = read("small.csv")
    for colour, cells in zip(COLOURS, ("8", "16", "32", "64")):
        line = [r for r in rows if r["cells"] == cells]
        d = [float(r["d_over_R"]) for r in line]
        axes.fill_between(d, [float(r["error_johnson_least_within_10_percent"]) for r in line],
                          [float(r["error_johnson_most_within_10_percent"]) for r in line], color=colour, alpha=0.15, linewidth=0)
        axes.plot(d, [float(r["error_johnson_percent"]) for r in line], "o-", color=colour, markersize=3, linewidth=0.9,
                  label=f"{cells} cells")
    line = [r for r in rows if r["cells"] == "64" and r["error_reference_percent"] != "nan"]
    axes.plot([float(r["d_over_R"]) for r in line],
              [100 * ((1 + float(r["error_johnson_percent"]) / 100) / (1 + float(r["error_reference_percent"]) / 100) - 1)
               for r in line], "k+", markersize=6, label="finite elements")
    axes.set(xscale="log", xlabel="approach $d/R$", ylabel="force against Johnson [%]", ylim=(-25, 25))
    axes.set_xticks([0.005, 0.01, 0.02, 0.05], ["0.005", "0.01", "0.02", "0.05"])
    axes.minorticks_off()
    axes.legend(fontsize=6, frameon=False)
    save(figure, "johnson.png")


def convergence():
    figure, axes = plt.subplots(figsize=(3.6, 2.6), layout="constrained")
    rows = read("convergence.csv")
    for colour, d in zip(COLOURS, ("0.05", "0.1", "0.2", "0.3", "all")):
        line = [r for r in rows if r["d_over_R"] == d]
        axes.loglog([float(r["spacing_over_R"]) for r in line], [abs(float(r["error_percent"])) for r in line],
                    "s-" if d == "all" else "o-", color="k" if d == "all" else colour, markersize=3, linewidth=0.9,
                    label=f"{'rms' if d == 'all' else f'$d/R$ = {d}'}: order {float(line[0]['order']):.1f}")
    axes.set(xlabel="spacing of the points / R", ylabel="difference to 48 cells [%]")
    axes.set_xticks([0.015, 0.03, 0.06], ["0.015", "0.03", "0.06"])
    axes.minorticks_off()
    axes.legend(fontsize=6, frameon=False)
    save(figure, "convergence.png")


stress()
johnson_error()
convergence()
