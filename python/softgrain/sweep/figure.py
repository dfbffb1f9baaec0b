"""The figure of a sweep: curves, and values at the end, mean and spread over the seeds."""

from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from .. import NotRecorded
from ..plot.style import DOUBLE_COLUMN, MM, RUN_COLOURS
from .curves import groups_of, mean_curve
from .plan import SEED
from .table import value_of

USUAL_PANELS = ("stress_top", "z_no_rattlers")
ROW_HEIGHT = 58  # [mm]
MOST_LABELS, MOST_PANELS = 12, 4
AXES = {"strain": r"strain $\varepsilon$", "phi": r"packing fraction $\Phi$",
        "phi_0": r"packing fraction of undeformed grains $\Phi_0$"}


def draw_sweep(plan, opened, columns, over="strain"):
    """A row of panels for each column: mean over the seeds, and one standard deviation to each side; beside it the last
    value, over the first varied number, or over each number of a design's points."""
    groups = groups_of(plan, opened)
    members = [member for group in groups.values() for member in group]
    if not members:
        raise NotRecorded("no run has more than one row yet")
    runs = [run for _, run in members]
    if any(over not in run.series for run in runs):
        raise NotRecorded(f"not all runs have {over}, the column for --over")
    columns = [name for name in (columns or USUAL_PANELS) if all(name in run.series for run in runs)]
    if not columns:
        raise NotRecorded("no column to draw that all runs have; name one with --column")
    numeric = [key for key in plan.keys
               if key != SEED and all(isinstance(value_of(*member, key), (int, float)) for member in members)]
    places = [key for key in numeric if key in plan.points][:MOST_PANELS]
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, ROW_HEIGHT * len(columns) * MM), layout="constrained")
    panels = figure.subplots(len(columns), 1 + max(1, len(places)), squeeze=False)
    for (curves, *ends), name in zip(panels, columns):
        _draw_curves(curves, plan, groups, name, over)
        for axes, key in zip(ends, places):
            _draw_points(axes, groups, key, name)
        if not places:
            _draw_ends(ends[0], members, numeric, [key for key in plan.keys if key != SEED], name)
    if len(groups) <= MOST_LABELS and not plan.points:  # points have too many digits for a legend
        panels[0, 0].legend(fontsize=6)
    return figure


def _label(values, keys):
    return ", ".join(f"{key.rpartition('.')[2]} {value}" for key, value in zip(keys, values)) or "mean over the seeds"


def _draw_curves(axes, plan, groups, column, over):
    keys = [key for key in plan.keys if key != SEED]
    for (values, members), colour in zip(groups.items(), cycle(RUN_COLOURS)):
        along, mean, spread = mean_curve([run for _, run in members], column, over)
        axes.plot(along, mean, color=colour, label=_label(values, keys), lw=1 if len(groups) <= MOST_LABELS else 0.5)
        axes.fill_between(along, mean - spread, mean + spread, color=colour, alpha=0.2, lw=0)
    axes.set_xlabel(AXES[over])
    axes.set_ylabel(_name(column, next(iter(groups.values()))[0][1]))


def _draw_points(axes, groups, key, column):
    """A point for each group: the mean of the last values over one number of the design."""
    for members in groups.values():
        ends = [run.series[column][-1] for _, run in members]
        axes.errorbar(value_of(*members[0], key), np.mean(ends), np.std(ends), color=RUN_COLOURS[0], marker="o",
                      ms=2.5, capsize=1)
    axes.set_xlabel(key)
    axes.set_ylabel("last " + _name(column, members[0][1]))


def _draw_ends(axes, members, numeric, keys, column):
    """The last value against the first key whose values are numbers; the other keys part the lines."""
    if not numeric:
        axes.set_axis_off()
        return
    key, others = numeric[0], [other for other in keys if other != numeric[0]]
    lines = {}
    for planned, run in members:
        values = tuple(planned.values[other] for other in others)
        lines.setdefault(values, {}).setdefault(value_of(planned, run, key), []).append(run.series[column][-1])
    for (values, ends), colour in zip(lines.items(), cycle(RUN_COLOURS)):
        ends = dict(sorted(ends.items()))
        axes.errorbar(list(ends), [np.mean(end) for end in ends.values()], [np.std(end) for end in ends.values()],
                      color=colour, marker="o", ms=3, capsize=2, label=_label(values, others))
    axes.set_xlabel(key)
    axes.set_ylabel("last " + _name(column, members[0][1]))


def _name(column, run):
    unit = run.units[column]
    return f"{column} [{unit}]" if unit else column
