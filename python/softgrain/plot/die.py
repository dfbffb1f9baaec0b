"""Pressing in a die: stresses and their ratios, and the equations of compaction with their constants."""

import numpy as np
from matplotlib.figure import Figure

from .. import NotRecorded, compaction, measure, profile
from ..stress_unit import unit_for
from .style import BLUE, DOUBLE_COLUMN, GREEN, GREY, MM, SINGLE_COLUMN, VERMILLION, millimetres

HEIGHT = 62  # [mm]
FIT_HEIGHT = 78  # with the constants above [mm]
LEFT, RIGHT, BOTTOM, KEY_LINE = 12, 2.5, 9.5, 3.8  # margins; above, each line of the key [mm]
STRESSES = (("stress_top", "top", BLUE), ("stress_bottom", "bottom", GREEN), ("stress_side", "sides", VERMILLION))
RATIOS = (("transmission_ratio", "bottom over top", GREEN), ("radial_ratio", "radial over axial", VERMILLION))
LEAST_LOAD = 0.05  # of the largest: below it ratios say nothing


def draw_die(run):
    """Stresses on the walls, way in and way back, and their ratios under load; elastic recovery in words."""
    series = run.series
    if not {"stress_side", "transmission_ratio", "phi"} <= series.keys():
        raise NotRecorded(f"{run.path}: series.csv has no stress_side or transmission_ratio: that is of a box")
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, HEIGHT * MM), layout="constrained")
    left, right = figure.subplots(1, 2)
    phi, load = series["phi"], measure.vertical_stress(series)
    unit = unit_for(load)
    pressed = int(np.argmax(load))
    under_load = load > LEAST_LOAD * load.max()
    for column, words, colour in STRESSES:
        left.plot(phi[: pressed + 1], series[column][: pressed + 1] / unit.pascal, color=colour, label=words)
        left.plot(phi[pressed:], series[column][pressed:] / unit.pascal, color=colour, lw=0.7, ls="--")
    left.plot([], [], color=GREY, lw=0.7, ls="--", label="after the largest load")
    way_in = under_load & (np.arange(load.size) <= pressed)
    for column, words, colour in RATIOS:
        right.plot(load[way_in] / unit.pascal, series[column][way_in], color=colour, label=words)
    left.set(xlabel=r"relative density $\Phi$", ylabel=f"stress [{unit.name}]", ylim=(0, None))
    left.legend(loc="upper left", title=_recovery_text(series), alignment="left", title_fontsize=7)
    right.set(xlabel=f"axial stress [{unit.name}]", ylabel="ratio of stresses, loading", xlim=(0, None), ylim=(0, None))
    right.legend(loc="lower right")
    return figure


def draw_profile(run):
    """Density of the grains, and stress and friction of the side walls, by height, where the load is largest."""
    if len(run) == 0 or "stress_top" not in run.series:
        raise NotRecorded(f"{run.path}: no snapshots, or no stress of a top wall, to draw by height")
    load = np.interp(run.times, run.series["time"], measure.vertical_stress(run.series))
    snapshot = run[int(np.argmax(load))]
    unit = unit_for(load)
    density, wall = profile.density_by_height(snapshot), profile.wall_stress_by_height(snapshot)
    edges = np.r_[0, (density.height[1:] + density.height[:-1]) / 2, density.height[-1] + density.height[0]] * 1e3
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, HEIGHT * MM), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    left.stairs(density.density, edges, orientation="horizontal", baseline=None, color=BLUE)
    right.stairs(wall.normal / unit.pascal, edges, orientation="horizontal", baseline=None, color=VERMILLION, label="normal")
    right.stairs(wall.shear / unit.pascal, edges, orientation="horizontal", baseline=None, color=GREEN, label="friction, upwards positive")
    right.axvline(0, color=GREY, lw=0.5)
    left.set(xlabel=r"density $\Phi$ of slabs", ylabel="height [mm]", ylim=(0, edges[-1]),
             xlim=(density.density.min() - 0.03, density.density.max() + 0.03))
    left.set_title(f"axial stress {load.max() / unit.pascal:.3g} {unit.name}", loc="left", fontsize=7)
    right.set(xlabel=f"stress of the grains on the side walls [{unit.name}]")
    right.legend(loc="upper center", bbox_to_anchor=(0.5, 1.14), ncols=2)
    return figure


def _recovery_text(series):
    found = compaction.recovery(series)
    named = (("axial, unloaded", found.axial_unloaded), ("axial, ejected", found.axial), ("radial, ejected", found.radial))
    lines = [f"{words}: {100 * value:+.2f} %" for words, value in named if value is not None]
    index = compaction.plasticity_index(series)
    lines += [f"plastic over total work: {index:.3f}"] if index is not None else []
    return "\n".join(["recovery", *lines] if len(lines) else lines)


def draw_heckel(run, window=None):
    """ln(1/(1-D)) over P with Heckel's line, and Panelli and Ambrozio's curve."""
    data = compaction.loading(run)
    rows = data.density < 1
    pressure, y = data.pressure[rows], -np.log1p(-data.density[rows])
    line = compaction.heckel(pressure, data.density[rows], window)
    root = compaction.panelli_ambrozio(pressure, data.density[rows], window)
    K, A, yield_pressure = (line.constants[name] for name in ("K", "A", "1/K"))
    unit = unit_for(pressure)
    figure, axes = _axes(pressure, y, unit)
    x = _window_points(line)
    axes.plot(x / unit.pascal, line.line.at(x), color=VERMILLION,
              label="Heckel, $K P + A$: " + f"$K$ = {_scaled(K, unit.pascal).text()} /{unit.name}, $A$ = {A.text()},\n"
              f"$1/K$ = {_scaled(yield_pressure, 1 / unit.pascal).text()} {unit.name}, $R^2$ = {line.line.r_squared:.4f}")
    a, b = root.constants["A"], root.constants["B"]
    axes.plot(x / unit.pascal, root.line.at(np.sqrt(x)), color=GREEN, ls="--",
              label=r"Panelli–Ambrozio, $A\sqrt{P} + B$: " + f"$A$ = {_scaled(a, unit.pascal**0.5).text()} /$\\sqrt{{\\mathrm{{{unit.name}}}}}$,\n"
              f"$B$ = {b.text()}, $R^2$ = {root.line.r_squared:.4f}")
    axes.set_ylabel(r"$\ln(1/(1-D))$, $D = \Phi$")
    return _finish(figure, axes, line, unit)


def draw_kawakita(run, window=None):
    """P/C over P with Kawakita's line."""
    data = compaction.loading(run)
    rows = data.reduction > 0
    pressure, reduction = data.pressure[rows], data.reduction[rows]
    fit = compaction.kawakita(pressure, reduction, window)
    unit = unit_for(pressure)
    figure, axes = _axes(pressure, pressure / reduction / unit.pascal, unit)
    x = _window_points(fit)
    a, b = fit.constants["a"], fit.constants["1/b"]
    axes.plot(x / unit.pascal, fit.line.at(x) / unit.pascal, color=VERMILLION,
              label="Kawakita, $P/a + 1/(ab)$: " + f"$a$ = {a.text()},\n"
              f"$1/b$ = {_scaled(b, 1 / unit.pascal).text()} {unit.name}, $R^2$ = {fit.line.r_squared:.4f}")
    axes.set_ylabel(rf"$P/C$ [{unit.name}], $C = 1 - V/V_\mathrm{{start}}$")
    return _finish(figure, axes, fit, unit)


def _axes(pressure, y, unit):
    figure = Figure(figsize=(SINGLE_COLUMN * MM, FIT_HEIGHT * MM))
    axes = figure.add_subplot()
    axes.plot(pressure / unit.pascal, y, color=BLUE, ls="none", marker="o", ms=1.8, mew=0, label="loading")
    axes.set(xlabel=f"axial stress $P$ [{unit.name}]", xlim=(0, None))
    return figure, axes


def _window_points(fit):
    return np.linspace(*fit.window, 100)


def _finish(figure, axes, fit, unit):
    low, high = (pressure / unit.pascal for pressure in fit.window)
    axes.axvspan(low, high, color=GREY, alpha=0.12, lw=0, label=f"fitted from {low:.3g} to {high:.3g} {unit.name}; ±: 95 % intervals")
    lines = sum(1 + label.count("\n") for label in axes.get_legend_handles_labels()[1])
    millimetres(figure, LEFT, RIGHT, BOTTOM, KEY_LINE * lines + 2)
    axes.legend(loc="lower left", bbox_to_anchor=(-(LEFT - 1) / (SINGLE_COLUMN - LEFT - RIGHT), 1), borderaxespad=0.2, borderpad=0,
                handletextpad=0.5)
    return figure


def _scaled(constant, factor):
    return compaction.Constant(constant.value * factor, constant.half_width * factor)
