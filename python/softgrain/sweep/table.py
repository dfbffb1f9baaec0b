"""What came of a sweep: one line per run, as results.csv and as arrays."""

import csv
import io

import numpy as np

from ..run import open_run
from .plan_file import write_whole
from .state import WAITING, condition, state

USUAL_COLUMNS = ("strain", "phi_0", "phi", "z", "z_no_rattlers", "stress_top", "stress_bottom", "stress_xx",
                 "stress_yy", "dissipation", "energy_error", "residual_max", "overlap_max", "wall_seconds")


def read_runs(plan):
    """{name: Run} of those that have begun."""
    directories = ((run.name, plan.directory(run)) for run in plan.runs)
    return {name: open_run(path) for name, path in directories if state(path) and (path / "case.toml").exists()}


def write_results(plan, opened, columns, path):
    """results.csv: name, condition and varied values of each run (SI), then last value and maximum of each column."""
    columns = columns or [name for name in USUAL_COLUMNS if any(name in run.series for run in opened.values())]
    units = {name: unit for run in opened.values() for name, unit in run.units.items()}
    header = ["run", "state", *plan.keys]
    for name in columns:
        unit = f"[{units[name]}]" if units.get(name) else ""
        header += [f"{name}_last{unit}", f"{name}_max{unit}"]
    rows = [[run.name, _state(plan.directory(run)), *values_of(run, opened.get(run.name)),
             *_ends(opened.get(run.name), columns)] for run in plan.runs]
    write_table([header, *rows], path)


def write_table(rows, path):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_whole(path, text.getvalue())


def values_of(planned, run):
    """The varied values in SI; as they were written for a run that has not begun."""
    return [value_of(planned, run, key) for key in planned.values]


def value_of(planned, run, key):
    """The value of "contact.friction" in the resolved case of a run, in SI; where this has no such key, as of one kind
    of grains, what was written, as a number if it is one."""
    written = planned.values[key]
    table, _, name = key.partition(".")
    try:
        return written if run is None else run.case[table][name]
    except (KeyError, TypeError):
        return _number_or_text(written)


def _number_or_text(text):
    try:
        return float(text)
    except ValueError:
        return text


def _state(directory):
    found = condition(directory)
    return "to do" if found == WAITING else found


def _ends(run, columns):
    cells = []
    for name in columns:
        series = run.series.get(name, np.empty(0)) if run is not None else np.empty(0)
        cells += [f"{series[-1]:.9g}", f"{np.nanmax(series):.9g}"] if series.size else ["", ""]
    return cells
