"""The stress-strain curve of a grain or of a packing, of one run or of several laid over one another."""

from dataclasses import dataclass
from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from .. import NotRecorded, measure
from ..stress_unit import StressUnit, unit_for
from .style import BLUE, GREEN, GREY, INK, MM, PURPLE, RUN_COLOURS, SINGLE_COLUMN, VERMILLION, millimetres

HEIGHT = 62  # [mm]
LEFT, RIGHT, BOTTOM, KEY_LINE = 12, 2.5, 9.5, 4  # margins; above, a line of the key for each curve [mm]
LEAST_PULL = 0.01  # of the largest stress: what is drawn below 0
MOST_SLOPES = 3  # of unloadings that the key names one by one
BRANCH_COLOURS = {measure.UNLOADING: VERMILLION, measure.RELOADING: GREEN, measure.HOLD: PURPLE}


@dataclass(frozen=True)
class Curve:
    """What is drawn of one run."""

    label: str
    strain: np.ndarray
    stress: np.ndarray  # in units of `scale`
    scale: float  # that unit, or sigma_I [Pa]
    unit: StressUnit  # of the words
    characteristic_stress: float | None  # sigma_I [Pa]
    plateau: measure.Plateau | None  # of a bonded grain between walls; all other stresses rise all the way
    direction: np.ndarray | None = None  # of each step from a sample to the next, as measure.directions
    elastic_grain: bool = False  # one grain, which unloads as it was loaded and is smooth
    in_space: bool = False


def draw_curve(runs, labels=None, normalise=False):
    """sigma(eps): thin line, the samples; thick line, their mean over 1 % of strain; sigma_I; the plateau."""
    labels = labels or [run.name for run in runs]
    unit = unit_for(*(measure.vertical_stress(run.series) for run in runs))
    curves = [_curve(run, label, normalise, unit) for run, label in zip(runs, labels)]
    characteristic = _common_characteristic_stress(curves)
    figure = Figure(figsize=(SINGLE_COLUMN * MM, HEIGHT * MM))
    axes, upper_axes = _axes(figure, curves, characteristic)
    if len(curves) == 1:
        _draw_branches(axes, curves[0])
    else:
        _draw_overlay(axes, curves)
    if characteristic is not None:
        _draw_characteristic_stress(upper_axes, characteristic, unit, normalise, all(c.in_space for c in curves))
    axes.set_xlabel(r"cumulative axial strain $\varepsilon$")
    axes.set_ylabel(r"vertical stress $\sigma/\sigma_I$" if normalise else rf"vertical stress $\sigma$ [{unit.name}]")
    axes.set_xlim(0, max(c.strain.max() for c in curves) * 1.02 or 0.01)
    entries = axes.get_legend_handles_labels()
    if upper_axes is not axes:
        entries = [mine + others for mine, others in zip(entries, upper_axes.get_legend_handles_labels())]
    columns = 2 if len(curves) == 1 else 1
    millimetres(figure, LEFT, RIGHT, BOTTOM, KEY_LINE * -(-len(entries[0]) // columns) + 2, hspace=0.06)
    upper_axes.legend(*entries, loc="lower left", bbox_to_anchor=(-(LEFT - 1) / (SINGLE_COLUMN - LEFT - RIGHT), 1),
                      borderaxespad=0.2, borderpad=0, ncols=columns, columnspacing=1, handletextpad=0.5)
    return figure


def _curve(run, label, normalise, unit):
    stress = measure.vertical_stress(run.series)
    sigma_i = measure.characteristic_stress(run)
    if "strain" not in run.series:
        raise NotRecorded(f"{run.path}: series.csv has no strain")
    if normalise and sigma_i is None:
        raise NotRecorded(f"{run.path}: elastic grains have no sigma_I" if run.elastic else
                          f"{run.path}: sigma_I needs bpm.attraction in the case and a snapshot")
    scale = sigma_i if normalise else unit.pascal
    strain, packing = run.series["strain"], "phi" in run.series
    flat = None if packing or run.elastic else measure.plateau(strain, stress / scale)
    return Curve(label, strain, stress / scale, scale, unit, sigma_i, flat, measure.directions(run.series), run.elastic and not packing,
                 run.in_space)


def _common_characteristic_stress(curves):
    """sigma_I in the units of the curves, if all have it, the same within 5 %; else None."""
    values = [c.characteristic_stress / c.scale for c in curves if c.characteristic_stress]
    if len(values) < len(curves):
        return None
    return np.mean(values) if values and max(values) < 1.05 * min(values) else None


def _axes(figure, curves, characteristic):
    """One axes; if sigma_I lies far above the curves, also a strip around it, above a break, to scale."""
    top = 1.22 * max(c.stress.max() for c in curves) or 1.0
    lowest = min(c.stress.min() for c in curves)
    bottom = 1.1 * lowest if lowest < -LEAST_PULL * top else 0  # grains that adhere pull
    if characteristic is None or characteristic < 1.6 * top:
        axes = figure.add_subplot(ylim=(bottom, max(top, 1.15 * (characteristic or 0))))
        return axes, axes
    height = 0.22 * top
    strip, axes = figure.subplots(2, sharex=True, height_ratios=(height, top))
    axes.set_ylim(bottom, top)
    strip.set_ylim(characteristic - 0.4 * height, characteristic + 0.6 * height)
    strip.set_yticks([characteristic], [f"{characteristic:.2f}"])
    _mark_break(axes, strip)
    return axes, strip


def _mark_break(below, above):
    below.spines.top.set_visible(False)
    above.spines.bottom.set_visible(False)
    below.tick_params(top=False)
    above.tick_params(bottom=False, labelbottom=False)
    slash = dict(marker=[(-1, -0.5), (1, 0.5)], ms=5, mew=0.6, ls="none", color=INK, clip_on=False)
    below.plot([0, 1], [1, 1], transform=below.transAxes, **slash)
    above.plot([0, 1], [0, 0], transform=above.transAxes, **slash)


def _draw_branches(axes, curve):
    """One run: each kind of branch in its colour; the plateau and the unloading slopes in words."""
    strain, stress = curve.strain, curve.stress
    branches = measure.branches(strain, curve.direction)
    eps, sigma = measure.envelope(strain, stress)
    if curve.elastic_grain and _follows(strain, stress, eps, sigma):
        axes.plot(eps, sigma, color=BLUE, lw=1.3, label="loading" + (", unloading the same" if len(branches) > 1 else ""))
        return
    for branch in branches:
        look = dict(color=BLUE, alpha=0.4, lw=0.4)
        if branch.kind != measure.LOADING:
            look = dict(color=BRANCH_COLOURS[branch.kind], lw=0.8)
        axes.plot(strain[branch.samples], stress[branch.samples], **look)
    if curve.elastic_grain:
        axes.plot(eps, sigma, color=BLUE, lw=1.3, label="loading", zorder=1.5)  # below the unloading, which it hides else
    else:
        axes.plot(eps, measure.moving_mean(eps, sigma), color=BLUE, lw=1.3, label="loading (mean over 1 %)")
    for kind, colour in BRANCH_COLOURS.items():
        if any(branch.kind == kind for branch in branches):
            axes.plot([], [], color=colour, lw=0.8, label=kind + (_slopes(curve) if kind == measure.UNLOADING else ""))
    _draw_plateau(axes, curve)


def _follows(strain, stress, eps, sigma):
    """Whether unloading and reloading are the loading again, within a line's width."""
    return abs(stress - np.interp(strain, eps, sigma)).max() < 0.01 * abs(sigma).max()


def _draw_plateau(axes, curve):
    flat = curve.plateau
    if flat is not None:
        axes.hlines(flat.mean, *flat.strain_range, color=INK, lw=0.6, ls=(0, (4, 2)), zorder=3,
                    label=f"plateau {_stress_text(flat.mean, curve)}")


def _slopes(curve):
    """", slope 3.6 MPa" of each unloading, of many their range; elastic grains unload as they were loaded."""
    slopes = [] if curve.elastic_grain else [u.slope for u in measure.unloadings(curve.strain, curve.stress, curve.direction)]
    unit = r"$\,\sigma_I$" if curve.scale == curve.characteristic_stress else f" {curve.unit.name}"
    few = len(slopes) <= MOST_SLOPES
    words = (", " if few else " to ").join(f"{slope:.{1 if slope < 10 else 0}f}" for slope in (slopes if few else (min(slopes), max(slopes))))
    return f", {'' if few else f'{len(slopes)} '}slope{'s' if len(slopes) > 1 else ''} {words}{unit}" if slopes else ""


def _draw_overlay(axes, curves):
    for curve, colour in zip(curves, cycle(RUN_COLOURS)):
        axes.plot(curve.strain, curve.stress, color=colour, alpha=0.35, lw=0.4)
        eps, sigma = measure.envelope(curve.strain, curve.stress)
        words = f": plateau {_stress_text(curve.plateau.mean, curve)}" if curve.plateau else ""
        mean = sigma if curve.elastic_grain else measure.moving_mean(eps, sigma)
        axes.plot(eps, mean, color=colour, lw=1.2, label=curve.label + words)


def _stress_text(stress, curve):
    """A stress in its unit and as a share of sigma_I, as far as each is known."""
    pascal = stress * curve.scale
    text = curve.unit.text(pascal)
    if curve.characteristic_stress is None:
        return text
    return rf"{text} = {pascal / curve.characteristic_stress:.2f}$\,\sigma_I$"


def _draw_characteristic_stress(axes, value, unit, normalise, in_space):
    """The line at sigma_I = F0/<a0>, the paper's characteristic stress; in space F0/<a0>^2."""
    equals = "" if normalise else f" = {value:.2f} {unit.name}"
    axes.axhline(value, color=GREY, lw=0.8, ls=(0, (1, 1.2)), label=rf"$\sigma_I = F_0/\langle a_0\rangle{'^2' if in_space else ''}${equals}")
