"""Pictures of study.py: packings at four stages, the curves of all runs, Z of 300 grains at two speeds."""
import csv
import pathlib
import sys

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import packing_series

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = HERE / "results"
sys.path.insert(0, str(HERE.parents[1] / "python"))
import softgrain
from softgrain.reproduce import curves as laws

STAGES = (0, 48, 80, 128)  # of 128 steps
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")  # distinct without colour vision, too

plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})


def outlines(path):
    """The outlines of all grains [mm], each grain's mean pressure [MPa], and the walls [mm]."""
    with h5py.File(path, "r") as file:
        scene = file["scene"]
        grain, vertices = scene["outlines/grain"][()].ravel(), scene["outlines/position"][()] * 1e3
        weights = scene["particles/radius"][()].ravel() ** 2
        owner = scene["particles/grain"][()].ravel()
        pressure = (np.bincount(owner, weights * scene["particles/pressure"][()].ravel()) / np.bincount(owner, weights)) / 1e6
        return [vertices[grain == g] for g in np.unique(grain)], pressure, scene["walls"][()].reshape(-1, 2, 2) * 1e3


def packings(out):
    figure, axes = plt.subplots(2, len(STAGES), figsize=(7, 3.9), layout="constrained", sharex=True, sharey=True)
    for row, friction in zip(axes, ("0", "0.5")):
        run = out / f"implicit_16_mu{friction}_nu0.45"
        with open(run / "series.csv", newline="") as file:
            phi = {int(float(r["step"])): float(r["phi"]) for r in csv.DictReader(file)}
        for panel, step in zip(row, STAGES):
            polygons, pressure, walls = outlines(run / "snap" / f"s{step:06d}.h5")
            grains = PolyCollection(polygons, array=pressure, cmap="viridis", edgecolors="k", linewidths=0.4, clim=(0, 5))
            panel.add_collection(grains)
            for wall in walls:
                panel.plot(*wall.T, color="0.4", linewidth=0.8)
            panel.set_title(f"$\\mu$ = {friction}, $\\Phi$ = {phi[step]:.3f}", fontsize=7)
            panel.set_aspect("equal")
            panel.set_axis_off()
    figure.colorbar(grains, ax=axes, label="mean pressure of a grain [MPa]", shrink=0.7)
    figure.savefig(RESULTS / "packings.png", dpi=160, metadata={"Software": None})


def curves():
    with open(RESULTS / "curves.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(figsize=(3.6, 2.8), layout="constrained")
    kinds = [("16", "0", "0.45"), ("16", "0.5", "0.45"), ("16", "0", "0.3"), ("16", "0", "0.49")]
    for colour, (cells, friction, poisson) in zip(COLOURS, kinds):
        for integrator, style in (("implicit", "-"), ("explicit", ":")):
            line = [r for r in rows if (r["integrator"], r["cells"], r["friction"], r["poisson_ratio"]) ==
                    (integrator, cells, friction, poisson) and r["step_us"] in ("0", "5")]
            axes.plot([float(r["phi"]) for r in line], [float(r["stress_MPa"]) for r in line], style, color=colour, linewidth=0.9,
                      label=f"$\\mu$ = {friction}, $\\nu$ = {poisson}, {integrator}")
    axes.set(xlabel="packing fraction $\\Phi$", ylabel="stress $\\sigma$ [MPa]", xlim=(0.7, 1), ylim=(0, None))
    axes.legend(fontsize=5.5, frameon=False)
    figure.savefig(RESULTS / "curves.png", dpi=200, metadata={"Software": None})


def law(names):
    """results/law.csv, law.png: the law of Fig. 4 of the paper, read off as `softgrain reproduce` does. names: speed -> run."""
    records = []
    figure, axes = plt.subplots(figsize=(3.6, 2.8), layout="constrained")
    for colour, (velocity, path) in zip(COLOURS, names.items()):
        curve = laws.compaction(softgrain.open(path))
        found, (strain, phi) = laws.coordination_law(curve), laws.onset(curve)
        records.append({"velocity": velocity, "exponent": found.exponent, "half_width_95": found.half_width, "z0": found.z0,
                        "z1": found.z1, "strain_at_z3": strain, "phi_0_at_z3": phi, "sigma0_kPa": curve.reference_stress / 1e3})
        after = curve.phi > laws.REFERENCE_PACKING_FRACTION + 0.002
        axes.loglog(curve.phi[after] - laws.REFERENCE_PACKING_FRACTION, (curve.z[after] - found.z0) / (found.z1 - found.z0),
                    color=colour, linewidth=1, label=f"{velocity} m/s: exponent {found.exponent:.2f} ± {found.half_width:.2f}")
    distance = np.geomspace(0.004, 0.28, 20)
    axes.loglog(distance, (distance / distance[-1]) ** 0.5, "k:", linewidth=0.8, label="exponent 1/2")
    axes.set(xlabel="$\\Phi_0 - 0.8$", ylabel="$(Z - Z_0)/(Z_1 - Z_0)$", ylim=(0.02, 1.3))
    axes.legend(fontsize=6.5, frameon=False)
    figure.savefig(RESULTS / "law.png", dpi=160, metadata={"Software": None})
    packing_series.write(RESULTS / "law.csv", records)


def draw(out):
    packings(out)
    curves()
