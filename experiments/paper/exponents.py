"""How the exponent of Z - Z_c ~ (Phi - Phi_c)^a depends on Phi_c, on the range of the fit and on what Z counts.

    exponents.py OUT=CSV ... -o DIR

OUT names the rows, CSV is a table of `softgrain reproduce` (packing_*.csv, slow_*.csv) or experiments/jamming/results/jamming.csv.
Writes DIR/exponents.csv and DIR/exponents.png: mean over the samples, their standard deviation, and the 95 % interval of the mean.
"""

import argparse
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import t as student

from softgrain.reproduce.tables import write_rows

CENTRES, LASTS = (0.78, 0.80, 0.82, 0.84, 0.85, 0.86), (0.90, 0.96, 1.0)
KINDS = ("z", "z_no_rattlers", "z_with_walls")
HEADER = ("runs", "friction", "Z", "Phi_c", "last Phi", "samples", "exponent", "standard deviation", "half of the 95 % interval")


def samples(path):
    """{(friction, seed): {column: values}} of one table; the friction stands in a column or in the name, as in mu0.5."""
    found = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            friction = row.get("friction") or path.stem.partition("_mu")[2]
            found.setdefault((float(friction), int(row["seed"])), []).append(row)
    return {key: {name: np.array([float(row[name]) for row in rows]) for name in rows[0]} for key, rows in found.items()}


def exponent(phi, z, centre, last):
    """a of Z = Z_c + A (Phi - Phi_c)^a by least squares, Z_c and A free; None where the rows do not span the range, or no
    exponent between 0.05 and 2.5 is best."""
    rows = (phi >= centre) & (phi <= last)
    x, z = phi[rows] - centre, z[rows]
    if x.size < 6 or phi[0] > centre or phi[-1] < last - 0.02:
        return None
    exponents = np.arange(0.05, 2.5, 0.01)
    best = int(np.argmin([missed(x, z, a) for a in exponents]))
    return float(exponents[best]) if 0 < best < len(exponents) - 1 else None


def missed(x, z, a):
    """What the best Z_c and A leave, sum of squares."""
    rows = np.column_stack([np.ones_like(x), x**a])
    return ((rows @ np.linalg.lstsq(rows, z, rcond=None)[0] - z) ** 2).sum()


def table(runs):
    """Rows under HEADER of {name: path}."""
    rows = []
    for name, path in runs.items():
        found = samples(path)
        for friction in sorted({key[0] for key in found}):
            series = [values for (mu, _), values in found.items() if mu == friction]
            for kind in KINDS:
                if kind not in series[0]:
                    continue
                for centre in CENTRES:
                    for last in LASTS:
                        values = [a for a in (exponent(s["phi_0"], s[kind], centre, last) for s in series) if a is not None]
                        if values:
                            rows.append((name, friction, kind, centre, last, len(values), np.mean(values), np.std(values), interval(values)))
    return rows


def interval(values):
    """Half of the 95 % interval of the mean; nan of one."""
    if len(values) < 2:
        return float("nan")
    return student.ppf(0.975, len(values) - 1) * np.std(values, ddof=1) / np.sqrt(len(values))


def draw(rows, path):
    figure, (*panels, legend) = plt.subplots(1, len(KINDS) + 1, figsize=(8.6, 2.6), layout="constrained", sharey=True)
    last = LASTS[0]
    kinds = list(dict.fromkeys(row[:2] for row in rows))
    for axes, kind in zip(panels, KINDS):
        for number, (name, friction) in enumerate(kinds):
            some = np.array([(row[3], row[6], row[7]) for row in rows if row[:3] == (name, friction, kind) and row[4] == last])
            if some.size:
                axes.errorbar(*some.T, color=f"C{number}", marker="o", ms=3, lw=0.8, capsize=2, label=rf"{name}, $\mu = {friction:g}$")
        axes.axhline(0.5, color="0.6", lw=0.6)
        axes.set(xlabel=r"$\Phi_c$", title=kind.replace("_", " "), ylim=(0, 1.7))
    panels[0].set_ylabel(f"exponent, fitted to $\\Phi$ = {last}")
    legend.set_axis_off()
    legend.legend(*panels[0].get_legend_handles_labels(), loc="upper left", frameon=False, fontsize=7)
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="+", metavar="NAME=CSV")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    named = {}
    for word in options.runs:
        name, _, path = word.partition("=")
        named[name] = Path(path)
    rows = table(named)
    write_rows(options.output / "exponents.csv", HEADER,
               ([f"{value:.3g}" if isinstance(value, float) else value for value in row] for row in rows))
    draw(rows, options.output / "exponents.png")


if __name__ == "__main__":
    main()
