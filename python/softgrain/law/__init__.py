"""The curve of one material point, from the table that `softgrain law CASE -o FILE` writes."""

import csv
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ..plot.style import BLUE, GREEN, GREY, INK, MM, SINGLE_COLUMN, VERMILLION, millimetres
from ..stress_unit import unit_for

HEIGHT = 100  # [mm]
STRAINS = {"shear": r"shear strain $\gamma$"}  # of the other paths: the logarithmic strain along x


def read_table(path) -> dict:
    """Columns of the table by name, in SI."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    return dict(zip(names, np.array(rows, dtype=float).T))


def draw_law(table, path, law):
    """Stresses over the strain, and below what was stored and dissipated of the work."""
    figure = Figure(figsize=(SINGLE_COLUMN * MM, HEIGHT * MM))
    upper, lower = figure.subplots(2, sharex=True)
    main = ("stress_xy", r"$\sigma_{xy}$") if path == "shear" else ("stress_xx", r"$\sigma_{xx}$")
    curves = [(*main, BLUE, "-"), ("von_mises_stress", "von Mises", VERMILLION, "--"), ("pressure", "pressure", GREY, ":")]
    unit = unit_for(*(table[column] for column, *_ in curves))
    for column, label, colour, line in curves:
        upper.plot(table["strain"], table[column] / unit.pascal, line, color=colour, label=label)
    for column, colour, line in (("work", INK, "-"), ("stored", GREEN, "--"), ("dissipated", VERMILLION, ":")):
        lower.plot(table["strain"], table[column] / unit.pascal, line, color=colour, label=column)
    upper.set_ylabel(f"stress [{unit.name}]")
    lower.set_ylabel(f"energy [{unit.name[:-2]}J/m$^3$]")
    lower.set_xlabel(STRAINS.get(path, r"logarithmic strain $\varepsilon_x$"))
    for axes in (upper, lower):
        axes.legend(loc="best")
    upper.text(0.5, 1.03, f"{law}, {path}", transform=upper.transAxes, ha="center")
    millimetres(figure, 13, 2.5, 9.5, 6, hspace=0.08)
    return figure
