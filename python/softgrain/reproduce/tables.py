"""The curves behind the figures as small CSV files."""

import csv

import numpy as np

from .. import measure
from .single_grain import reduced_force

COLUMNS = ("strain", "phi", "phi_deformed", "z", "z_no_rattlers", "z_with_walls", "stress", "stress_top", "stress_bottom")
HEADER = ("seed", "strain", "phi_0", "phi", "z", "z_no_rattlers", "z_with_walls", "stress[Pa]", "stress_top[Pa]", "stress_bottom[Pa]")
ROWS = 80  # at most, evenly, of a packing


def write(results, folder):
    """WAY_MODEL_muMU.csv for each kind of packing, grain_*.csv for the single grains."""
    for (way, model, friction), curves in results.packings.items():
        rows = [(seed, *(f"{getattr(curve, name)[k]:.5g}" for name in COLUMNS))
                for seed, curve in enumerate(curves, 1) for k in _some(curve.strain.size)]
        write_rows(folder / f"{way}_{model}_mu{friction:g}.csv", HEADER, rows)
    for name, runs in results.grains.items():
        run = runs[0]
        if run.elastic:
            header, columns = ("strain", "F/(E* R)"), reduced_force(run)
        else:
            header, columns = ("strain", "stress[Pa]"), (run.series["strain"], measure.vertical_stress(run.series))
        write_rows(folder / f"{name}.csv", header,
               [tuple(f"{column[k]:.6g}" for column in columns) for k in _some(columns[0].size, 400)])


def _some(count, most=ROWS):
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))


def write_rows(path, header, rows):
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(header)
        table.writerows(rows)
