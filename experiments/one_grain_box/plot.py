#!/usr/bin/env python3
"""Writes results/box.csv and results/box.png from runs of case.toml and isotropic.toml: plot.py DIE ISOTROPIC."""
import csv
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
YIELD, YOUNG, NU = 1e5, 1e7, 0.3
# Phi_0, and stresses over the yield stress, of finite elements
DIE = [(.8014, .347, .054), (.8267, .593, .226), (.8537, .765, .426), (.8727, .872, .536), (.8925, .997, .649),
       (.9240, 1.167, .760)]
LET_GO = {1: (.8602, .284), 3: (.9101, .342)}  # by leg: Phi_0 where the top bears nothing, side stress there
ISOTROPIC = [(.8178, .416), (.8702, .709), (.9279, 1.085), (.9696, 1.388), (1.0142, 2.23), (1.0377, 3.46), (1.0871, 7.90)]


def closed(phi):
    """Without pores: (K ln Phi_0 + sigma_y/3) Phi_0, over the yield stress."""
    return (YOUNG / YIELD / (3 * (1 - 2 * NU)) * np.log(phi) + 1 / 3) * phi


def at(phi, series, *columns):
    """Columns where Phi_0 first is phi, while it grows; over the yield stress."""
    grows = np.maximum.accumulate(series["phi_0"]) == series["phi_0"]
    return [np.interp(phi, series["phi_0"][grows], series[c][grows]) / YIELD for c in columns]


def main(die_path, isotropic_path):
    die, isotropic = (softgrain.open(path) for path in (die_path, isotropic_path))
    rows = []
    last = die.series["phi_0"].max()  # the stage ends in the step before 0.9240
    for phi, top, side in DIE:
        if phi > last:
            top, side = (np.interp(last, [row[0] for row in DIE], [row[k] for row in DIE]) for k in (1, 2))
            phi = round(float(last), 4)
        found = at(phi, die.series, "stress_top", "stress_side")
        rows += [("die, top", phi, found[0], top), ("die, side", phi, found[1], side)]
    for leg, (phi, side) in LET_GO.items():
        end = np.flatnonzero(die.series["leg"].astype(int) == leg)[-1]
        rows += [("let go: Phi_0", phi, die.series["phi_0"][end], phi),
                 ("let go: side", phi, die.series["stress_side"][end] / YIELD, side)]
    for phi, pressure in ISOTROPIC:
        rows.append(("isotropic", phi, at(min(phi, isotropic.series["phi_0"].max()), isotropic.series, "stress_top")[0],
                     pressure))
    rows.append(("isotropic, closed form", ISOTROPIC[-1][0], rows[-1][2], closed(ISOTROPIC[-1][0])))
    for run, name in ((die, "die"), (isotropic, "isotropic")):
        rows.append((f"{name}: energy missing over work", 0,
                     np.abs(run.series["energy_error"]).max() / run.series["wall_work"].max(), math.nan))
    RESULTS.mkdir(exist_ok=True)
    with open(RESULTS / "box.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["what", "Phi_0", "softgrain", "reference", "difference [%]"])
        for what, phi, value, reference in rows:
            known = not math.isnan(reference)
            writer.writerow([what, phi or "", f"{value:.4g}", f"{reference:.4g}" if known else "",
                             f"{100 * (value / reference - 1):.1f}" if known else ""])

    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(7.0, 2.5), layout="constrained", width_ratios=(1, 1, .8))
    for column, colour, k in (("stress_top", "C0", 1), ("stress_side", "C1", 2)):
        left.plot(die.series["phi_0"], die.series[column] / YIELD, color=colour, linewidth=0.9, label=column.split("_")[1])
        left.plot([r[0] for r in DIE], [r[k] for r in DIE], "o", color=colour, markersize=3)
    left.plot([r[0] for r in LET_GO.values()], [r[1] for r in LET_GO.values()], "s", color="C1", markersize=3, mfc="none")
    left.set(xlabel=r"$\Phi_0$", ylabel=r"stress / $\sigma_y$", ylim=(0, None), title="die")
    left.legend(frameon=False)
    middle.semilogy(isotropic.series["phi_0"], np.maximum(isotropic.series["stress_top"], 1) / YIELD, linewidth=0.9)
    middle.semilogy(*zip(*ISOTROPIC), "o", color="C0", markersize=3)
    phi = np.linspace(1.01, 1.09)
    middle.semilogy(phi, closed(phi), color="black", linestyle="--", linewidth=0.7, label="no pores")
    middle.set(xlabel=r"$\Phi_0$", ylim=(.2, 12), title="isotropic")
    middle.legend(frameon=False)
    last = die[len(die) - 1]
    x = 1e3 * last.particles["position"]
    points = right.scatter(x[:, 0], x[:, 1], s=1.2, c=last.particles["plastic_strain"], cmap="viridis", linewidths=0)
    outline = 1e3 * last.outlines["position"]
    right.plot(*np.vstack([outline, outline[:1]]).T, color="black", linewidth=0.6)
    right.set(aspect="equal", xlabel="x [mm]", title=r"plastic strain, $\Phi_0$ = 0.91")
    figure.colorbar(points, ax=right, shrink=0.7)
    figure.savefig(RESULTS / "box.png", dpi=130, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
