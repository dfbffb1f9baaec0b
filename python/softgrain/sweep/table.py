"""What came of a sweep: one line per run, as results.csv and as arrays."""

import csv

import numpy as np

from ..run import open_run
from .execute import doubts, state

USUAL_COLUMNS = ("strain", "phi_0", "phi", "z", "z_no_rattlers", "stress_top", "stress_bottom", "stress_xx",
                 "stress_yy", "dissipation", "energy_error", "residual_max", "overlap_max", "wall_seconds")


def read_runs(plan):
    """{planned run: its Run} of those that have begun."""
    return {run.name: open_run(plan.directory(run)) for run in plan.runs if state(plan.directory(run))}


def write_results(plan, opened, columns, path):
    """results.csv: name, state ("doubtful" for a run that is done, but not to be trusted) and varied values of each run (SI), then last value and maximum of each column."""
    columns = columns or [name for name in USUAL_COLUMNS if any(name in run.series for run in opened.values())]
    units = {name: unit for run in opened.values() for name, unit in run.units.items()}
    header = ["run", "state", *plan.varied]
    for name in columns:
        unit = f"[{units[name]}]" if units.get(name) else ""
        header += [f"{name}_last{unit}", f"{name}_max{unit}"]
    rows = [[run.name, _state(plan.directory(run)), *_values(run, opened.get(run.name)),
             *_ends(opened.get(run.name), columns)] for run in plan.runs]
    temporary = path.with_name(path.name + ".tmp")
    with temporary.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])
    temporary.replace(path)


def _state(directory):
    return "doubtful" if doubts(directory) else state(directory) or "to do"


def value_of(run, key):
    """The value of "contact.friction" in the resolved case of a run, in SI."""
    table, _, name = key.partition(".")
    return run.case[table][name]


def _values(planned, run):
    """The varied values in SI; as they were written for a run that has not begun."""
    return [written if run is None else value_of(run, key) for key, written in planned.values.items()]


def _ends(run, columns):
    cells = []
    for name in columns:
        series = run.series.get(name, np.empty(0)) if run is not None else np.empty(0)
        cells += [f"{series[-1]:.9g}", f"{np.nanmax(series):.9g}"] if series.size else ["", ""]
    return cells
