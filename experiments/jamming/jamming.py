"""Jamming of disks from runs of case.toml: figure, table of fits and a thinned series.

    jamming.py OUT FRICTION=RUN,RUN,... [FRICTION=RUN,...]
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

YOUNG_MODULUS = 10e6  # [Pa] of the case
ISOSTATIC = 4  # of disks without friction
LEAST_PRESSURE = 1e-3  # over E: below, the inertial number of the case is above 1e-3
RANGE = 0.05  # of Phi above the first row that counts
THINNED = 4  # rows of the series to one that is kept


def read(run):
    with open(Path(run) / "series.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    series = {name.partition("[")[0]: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    series["pressure"] = (series["stress_xx"] + series["stress_yy"]) / 2
    return series


def fit(series):
    """Phi_c, A and beta of Z = 4 + A (Phi - Phi_c)^beta, and A of beta = 1/2; Phi where p, taken as linear, begins."""
    phi, z, pressure = series["phi_0"], series["z_no_rattlers"], series["pressure"]
    jammed = pressure > LEAST_PRESSURE * YOUNG_MODULUS
    first = phi[jammed].min()
    near = jammed & (phi < first + RANGE)

    def missing(q):
        return ISOSTATIC + q[1] * np.maximum(phi[near] - q[0], 1e-9) ** q[2] - z[near]

    phi_c, prefactor, exponent = least_squares(missing, [first - 3e-3, 5, 0.5], bounds=([0.8, 0.1, 0.2], [first, 30, 1.2])).x
    half = least_squares(lambda q: ISOSTATIC + q[1] * np.sqrt(np.maximum(phi[near] - q[0], 1e-9)) - z[near],
                         [first - 3e-3, 4], bounds=([0.8, 0.1], [first, 30])).x
    linear = jammed & (pressure < 20 * LEAST_PRESSURE * YOUNG_MODULUS)
    return {"phi_c": phi_c, "prefactor": prefactor, "exponent": exponent, "phi_c at exponent 1/2": half[0],
            "prefactor at exponent 1/2": half[1], "phi_p": onset(series, linear), "largest I": series["inertial_number"][jammed].max()}


def onset(series, rows):
    return np.polyfit(series["pressure"][rows], series["phi_0"][rows], 1)[1]


def interval(values):
    """Half of the 95 % interval of the mean."""
    return student.ppf(0.975, len(values) - 1) * np.std(values, ddof=1) / np.sqrt(len(values))


def main(out, groups):
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.1, 2.7), layout="constrained")
    kept = []
    for (friction, runs), colour in zip(groups.items(), ("#0072b2", "#d55e00")):
        all_series = [read(run) for run in runs]
        for number, series in enumerate(all_series):
            label = rf"$\mu = {friction}$" if number == 0 else None
            left.plot(series["phi"], series["z_no_rattlers"], color=colour, lw=0.7, label=label)
            right.plot(series["phi"], series["pressure"] / YOUNG_MODULUS, color=colour, lw=0.7)
            kept += [(friction, number + 1, *row) for row in np.column_stack(
                [series[name][::THINNED] for name in ("phi_0", "phi", "z", "z_no_rattlers", "rattlers", "pressure")])]
        if float(friction) == 0:
            fits = [fit(series) for series in all_series]
            for name in fits[0]:
                values = [one[name] for one in fits]
                print(f"{name}: {np.mean(values):.4f} +- {interval(values):.4f}")
        else:
            linear = [(s["pressure"] > LEAST_PRESSURE * YOUNG_MODULUS) & (s["pressure"] < 20 * LEAST_PRESSURE * YOUNG_MODULUS)
                      for s in all_series]
            values = [onset(s, rows) for s, rows in zip(all_series, linear)]
            print(f"friction {friction}, phi_p: {np.mean(values):.4f} +- {interval(values):.4f}")
    left.set(xlabel=r"$\Phi$", ylabel="$Z$ without rattlers", xlim=(0.79, None), ylim=(2, None))
    left.axhline(ISOSTATIC, color="0.6", lw=0.5)
    left.legend(frameon=False, loc="lower right")
    right.set(xlabel=r"$\Phi$", ylabel="$p/E$", xlim=(0.79, None), yscale="log", ylim=(1e-5, 0.1))
    figure.savefig(Path(out) / "jamming.png", dpi=150)
    with open(Path(out) / "jamming.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["friction", "seed", "phi_0", "phi", "z", "z_no_rattlers", "rattlers", "pressure[Pa]"])
        writer.writerows([f"{value:.5g}" if isinstance(value, float) else value for value in row] for row in kept)


if __name__ == "__main__":
    main(sys.argv[1], {friction: runs.split(",") for friction, _, runs in (word.partition("=") for word in sys.argv[2:])})
