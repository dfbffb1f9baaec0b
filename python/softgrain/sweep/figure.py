"""The figure of a sweep: curves over the strain and values at the end, mean and spread over the seeds."""

from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from .. import NotRecorded, measure
from ..plot.style import DOUBLE_COLUMN, MM, RUN_COLOURS
from .plan import SEED
from .table import value_of

USUAL_PANELS = ("stress_top", "z_no_rattlers")
ROW_HEIGHT = 58  # [mm]
STRAINS = 200  # of a mean curve


def draw_sweep(plan, opened, columns):
    """A row of panels for each column: mean over the seeds, and one standard deviation to each side."""
    runs = [(run.values, opened[run.name]) for run in plan.runs if _has_rows(opened.get(run.name))]
    if not runs:
        raise NotRecorded("no run has more than one row yet")
    columns = [name for name in (columns or USUAL_PANELS) if all(name in run.series for _, run in runs)]
    if not columns:
        raise NotRecorded("no column to draw that all runs have; name one with --column")
    keys = [key for key in plan.varied if key != SEED]
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, ROW_HEIGHT * len(columns) * MM), layout="constrained")
    panels = figure.subplots(len(columns), 2, squeeze=False)
    for (curves, ends), name in zip(panels, columns):
        _draw_curves(curves, _groups(runs, keys), name)
        _draw_ends(ends, runs, keys, name)
    panels[0, 0].legend(fontsize=6)
    return figure


def mean_curve(runs, column):
    """(strain, mean, standard deviation) over the runs, at strains that all of them reached."""
    envelopes = [measure.envelope(run.series["strain"], run.series[column]) for run in runs]
    strain = np.linspace(max(e[0][0] for e in envelopes), min(e[0][-1] for e in envelopes), STRAINS)
    values = [np.interp(strain, *envelope) for envelope in envelopes]
    return strain, np.mean(values, axis=0), np.std(values, axis=0)


def _has_rows(run):
    return run is not None and run.series.get("strain", np.empty(0)).size > 1


def _groups(runs, keys):
    """{label: runs that differ by their seed alone}."""
    groups = {}
    for values, run in runs:
        label = ", ".join(f"{key.rpartition('.')[2]} {values[key]}" for key in keys) or "mean over the seeds"
        groups.setdefault(label, []).append(run)
    return groups


def _draw_curves(axes, groups, column):
    for (label, runs), colour in zip(groups.items(), cycle(RUN_COLOURS)):
        strain, mean, spread = mean_curve(runs, column)
        axes.plot(strain, mean, color=colour, label=label)
        axes.fill_between(strain, mean - spread, mean + spread, color=colour, alpha=0.2, lw=0)
    axes.set_xlabel(r"strain $\varepsilon$")
    axes.set_ylabel(_name(column, next(iter(groups.values()))[0]))


def _draw_ends(axes, runs, keys, column):
    """The last value against the first key whose values are numbers; the other keys part the lines."""
    numeric = [key for key in keys if all(isinstance(value_of(run, key), (int, float)) for _, run in runs)]
    if not numeric:
        axes.set_axis_off()
        return
    key, others = numeric[0], [other for other in keys if other != numeric[0]]
    for (label, members), colour in zip(_groups(runs, others).items(), cycle(RUN_COLOURS)):
        places = sorted({value_of(run, key) for run in members})
        ends = [[run.series[column][-1] for run in members if value_of(run, key) == place] for place in places]
        axes.errorbar(places, [np.mean(end) for end in ends], [np.std(end) for end in ends], color=colour,
                      marker="o", ms=3, capsize=2, label=label)
    axes.set_xlabel(key)
    axes.set_ylabel("last " + _name(column, runs[0][1]))


def _name(column, run):
    unit = run.units[column]
    return f"{column} [{unit}]" if unit else column
