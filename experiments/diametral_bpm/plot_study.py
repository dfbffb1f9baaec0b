#!/usr/bin/env python3
"""Draws results/collapse.png from results/curves.csv and collapse.csv: stress over sigma_I against strain for three forces F0 and
two primary sizes, mean and spread over four aggregates. Needs Debian's python3-matplotlib."""
import csv
import pathlib
import statistics

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

RESULTS = pathlib.Path(__file__).parent / "results"
COLOURS = {"44": "#0072B2", "100": "#D55E00", "620": "#009E73"}  # distinct without colour vision, too
STYLES = {"1750": "-", "900": "--"}

plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6, "svg.hashsalt": "softgrain"})


def read(name):
    with open(RESULTS / name, newline="") as file:
        return list(csv.DictReader(file))


curves = {}
for row in read("curves.csv"):
    family = curves.setdefault((row["F0_N_per_m"], row["primaries"]), {})
    family.setdefault(float(row["strain"]), []).append(float(row["stress_over_sigma_I"]))
plateaus = {}
for row in read("collapse.csv"):
    plateaus.setdefault((row["F0_N_per_m"], row["primaries"]), []).append(float(row["plateau_over_sigma_I"]))

figure, axes = plt.subplots(figsize=(3.35, 2.5), layout="constrained")
for (force, primaries), family in curves.items():
    strain = sorted(family)
    mean = [statistics.mean(family[e]) for e in strain]
    level = plateaus[force, primaries]
    axes.plot(strain, mean, STYLES[primaries], color=COLOURS[force], linewidth=0.9,
              label=f"{force} N/m, {primaries}: {statistics.mean(level):.3f} ± {statistics.stdev(level):.3f}")
axes.set_xlabel("strain $\\varepsilon$")
axes.set_ylabel("stress $\\sigma / \\sigma_I$")
axes.set_xlim(0, 0.35)
axes.set_ylim(0, None)
axes.legend(title="$F_0$, primaries: plateau", fontsize=6, title_fontsize=6, frameon=False, loc="lower right")
figure.savefig(RESULTS / "collapse.png", dpi=300, metadata={"Software": None})
