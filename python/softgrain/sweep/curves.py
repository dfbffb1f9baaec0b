"""Curves of runs that differ by their seed alone, at equal strain or equal packing fraction."""

import numpy as np

from .. import measure
from .plan import SEED
from .table import values_of, write_table

PLACES = 101  # of curves.csv, over all runs
USUAL_COLUMNS = ("strain", "phi_0", "phi", "z", "z_no_rattlers", "stress_top", "stress_bottom", "stress_xx",
                 "stress_yy", "dissipation")


def groups_of(plan, opened):
    """{values without the seed, as they were written: runs with more than one row}."""
    groups = {}
    for planned in plan.runs:
        run = opened.get(planned.name)
        if run is not None and run.series.get("strain", np.empty(0)).size > 1:
            values = tuple(value for key, value in planned.values.items() if key != SEED)
            groups.setdefault(values, []).append((planned, run))
    return groups


def curve_of(run, column, over):
    """(abscissa, values) where the abscissa is larger than ever before."""
    return measure.envelope(run.series[over], run.series[column])


def mean_curve(runs, column, over="strain", places=None):
    """(abscissa, mean, standard deviation) over the runs, where all of them have been; of `places` those there."""
    curves = [curve_of(run, column, over) for run in runs]
    low, high = max(along[0] for along, _ in curves), min(along[-1] for along, _ in curves)
    if places is None:
        places = np.linspace(low, high, 2 * PLACES)
    at = places[(places >= low) & (places <= high)]
    values = [np.interp(at, *curve) for curve in curves]
    return at, np.mean(values, axis=0), np.std(values, axis=0)


def write_curves(plan, opened, columns, over, path):
    """curves.csv: for each group its values in SI and the number of its runs, then the abscissa, at places that all
    groups share, and mean and standard deviation over the seeds of each column. False: nothing to write yet."""
    groups = groups_of(plan, opened)
    runs = [run for members in groups.values() for _, run in members]
    columns = [name for name in (columns or USUAL_COLUMNS) if name != over and all(name in run.series for run in runs)]
    if not runs or not columns or any(over not in run.series for run in runs):
        return False
    units = runs[0].units
    keys = [key for key in plan.keys if key != SEED]
    ends = [curve_of(run, over, over)[0][[0, -1]] for run in runs]
    places = np.linspace(min(first for first, _ in ends), max(last for _, last in ends), PLACES)
    header = [*keys, "runs", over]
    for name in columns:
        unit = f"[{units[name]}]" if units[name] else ""
        header += [f"{name}_mean{unit}", f"{name}_deviation{unit}"]
    rows = []
    for members in groups.values():
        planned, first = members[0]
        of_group = [value for key, value in zip(planned.values, values_of(planned, first)) if key != SEED]
        found = [mean_curve([run for _, run in members], name, over, places) for name in columns]
        numbers = np.column_stack([found[0][0], *(part for _, mean, spread in found for part in (mean, spread))])
        rows += [[*of_group, len(members), *(f"{number:.9g}" for number in row)] for row in numbers]
    write_table([header, *rows], path)
    return True
