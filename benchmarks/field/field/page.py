"""results/*.csv, figures, and the page of results, from what was measured now and before."""

import csv

import numpy as np
from matplotlib.figure import Figure

from .case import mean_curve
from .work import HERE, write_rows

RESULTS = HERE / "results"
MARKERS, COLOURS = "os^Dv<>P", ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
CODES = {"reference": "finite elements", "softgrain": "softgrain", "lammps": "LAMMPS", "liggghts": "LIGGGHTS", "yade": "YADE"}
LINES = {"reference": "none", "softgrain": "-", "lammps": "--", "liggghts": "-.", "yade": ":"}
COST = ("case", "code", "version", "variant", "samples", "CPU time of a sample[s]", "spread[s]", "over softgrain[-]", "processor", "date")


def header(case):
    spreads = [f"{y.name} spread[{y.unit}]" for y in case.ys]
    return ("code", "version", "variant", "samples", case.x.heading, *(word for y, s in zip(case.ys, spreads) for word in (y.heading, s)))


def rows_of(case, code, version, curves):
    """Rows of a code's means and standard deviations, variant by variant."""
    rows = []
    for variant in dict.fromkeys(curve.variant for curve in curves):
        same = [curve for curve in curves if curve.variant == variant]
        grid, found = mean_curve(case, same)
        for k, x in enumerate(grid):
            values = [f"{found[y.name][part][k]:.5g}" if y.name in found else "" for y in case.ys for part in (0, 1)]
            rows.append((code, version, variant, len(same), f"{x:.5g}", *values))
    return rows


def update(path, head, rows, replaces):
    """Writes the table anew: rows that `replaces` says are older make room."""
    kept = []
    if path.exists():
        with path.open(newline="") as file:
            old = list(csv.reader(file))
        kept = [row for row in old[1:] if old[0] == list(head) and not replaces(row)]
    order = list(CODES)
    everything = [[str(word) for word in row] for row in (*kept, *rows)]
    column = head.index("code")
    everything.sort(key=lambda row: ((row[0] if column else ""), order.index(row[column])))
    write_rows(path, head, everything)


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _number(word):
    return float(word) if word else np.nan


def draw(case, rows, path):
    """Each column over the abscissa: colours are variants, lines are codes; bars span the samples."""
    figure = Figure(figsize=(4.2 * len(case.ys), 3.4), layout="constrained")
    variants = list(dict.fromkeys(row["variant"] for row in rows))
    for axes, y in zip(figure.subplots(1, len(case.ys), squeeze=False)[0], case.ys):
        for code in dict.fromkeys(row["code"] for row in rows):
            for variant in dict.fromkeys(row["variant"] for row in rows if row["code"] == code):
                some = [row for row in rows if (row["code"], row["variant"]) == (code, variant)]
                x, mean, spread = (np.array([_number(row[name]) for row in some])
                                   for name in (case.x.heading, y.heading, f"{y.name} spread[{y.unit}]"))
                axes.errorbar(x, mean, spread, color=COLOURS[variants.index(variant) % len(COLOURS)], ls=LINES[code], lw=1,
                              ms=7 if code == "reference" else 3.5, zorder=5 if code == "reference" else 2, marker="x" if code == "reference" else MARKERS[list(CODES).index(code)], capsize=2,
                              label=f"{CODES[code]}, {variant}")
        axes.set(xlabel=case.x.label, ylabel=y.label)
    figure.axes[0].legend(fontsize=6, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130)


def table(case, rows):
    """Markdown: a line for each code and variant, the first column of `case.ys` that matters most over the grid."""
    lines = []
    for y in case.ys:
        xs = sorted({float(row[case.x.heading]) for row in rows})
        lines += [f"| {y.name} at {case.x.name} = | " + " | ".join(f"{x:g}" for x in xs) + " |", "|" + "---|" * (len(xs) + 1)]
        for code, variant in dict.fromkeys((row["code"], row["variant"]) for row in rows):
            some = {float(row[case.x.heading]): row for row in rows if (row["code"], row["variant"]) == (code, variant)}
            cells = [_words(some[x], y) if x in some else "" for x in xs]
            lines.append(f"| {CODES[code]}, {variant} | " + " | ".join(cells) + " |")
        lines.append("")
    return lines


def _words(row, y):
    mean, spread = row[y.heading], row[f"{y.name} spread[{y.unit}]"]
    if not mean:
        return ""
    return f"{float(mean):.3g}" + (f" ± {float(spread):.1g}" if int(row["samples"]) > 1 else "")


def write(cases):
    """Figures, and RESULTS.md with all that results/ holds. Returns its path."""
    for case in cases:
        path = RESULTS / f"{case.name}.csv"
        if path.exists():
            draw(case, read(path), path.with_suffix(".png"))
    path = HERE / "RESULTS.md"
    path.write_text(text(cases))
    return path


def text(cases):
    """The page: a figure, a table and the CPU times of each case that results/ has."""
    lines = ["# Results of the benchmark set", "",
             "<!-- Written by run.py; do not edit. What the cases are and why codes differ: README.md. -->", "",
             "Means over the samples; ± is their standard deviation. Versions, and all numbers: [results/](results/).", ""]
    costs = read(RESULTS / "cost.csv") if (RESULTS / "cost.csv").exists() else []
    for number, case in enumerate(cases, 1):
        path = RESULTS / f"{case.name}.csv"
        if not path.exists():
            continue
        rows = read(path)
        lines += [f"## {number}. {case.title}", "", f"![{case.title}](results/{case.name}.png)", "", *table(case, rows)]
        some = [row for row in costs if row["case"] == case.name]
        if some:
            lines += ["| CPU time of a sample | s | over softgrain |", "|---|---|---|"]
            lines += [f"| {CODES[row['code']]}, {row['variant']} | {row['CPU time of a sample[s]']} | {row['over softgrain[-]']} |"
                      for row in some]
            lines.append("")
    return "\n".join(lines).rstrip() + "\n"
