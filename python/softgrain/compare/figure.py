"""Measured points, a run's curve, and the difference below."""

import numpy as np
from matplotlib.figure import Figure

from ..plot.style import BLUE, GREY, INK, MM, SINGLE_COLUMN, millimetres
from ..stress_unit import unit_for

HEIGHT = 90  # [mm]


def draw_comparison(comparison, name, label):
    """`label` says what the curve is: the run's name, or that it was fitted."""
    if name.startswith("stress"):
        unit, scale = unit_for(comparison.measured, comparison.run)
    else:
        unit, scale = "N/m" if name.startswith("force") else "", 1
    figure = Figure(figsize=(SINGLE_COLUMN * MM, HEIGHT * MM))
    upper, lower = figure.subplots(2, sharex=True, height_ratios=(2.2, 1))
    upper.plot(comparison.strain, comparison.measured / scale, "o", color=GREY, ms=2.2, mew=0, label="measured")
    upper.plot(comparison.strain, comparison.run / scale, color=BLUE, lw=1.2, label=label)
    lower.axhline(0, color=INK, lw=0.5)
    lower.plot(comparison.strain, comparison.difference / scale, "-", color=BLUE, lw=0.8)
    for sign in (-1, 1):
        lower.axhline(sign * comparison.rms / scale, color=GREY, lw=0.6, ls=(0, (4, 2)))
    reach = 1.15 * (np.abs(comparison.difference).max() / scale or 1)
    lower.set_ylim(-reach, reach)
    quantity = (r"stress $\sigma$" if name.startswith("stress") else name.replace("_", " ")) + (f" [{unit}]" if unit else "")
    upper.set_ylabel(quantity)
    lower.set_ylabel("run - measured")
    lower.set_xlabel(r"strain $\varepsilon$")
    upper.legend(loc="upper left")
    millimetres(figure, 14, 2.5, 9.5, 2, hspace=0.08)
    figure.align_ylabels()
    return figure
