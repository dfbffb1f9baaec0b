"""Measured curves from CSV, the same quantity of a run, and how far they are apart. Compression counts positive."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .. import NotRecorded, measure
from ..run import Run

STRESS = "stress"  # the mean of the two walls; other names are columns of series.csv
UNITS = {"": 1, "%": 0.01, "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/m": 1, "kN/m": 1e3, "N/mm": 1e3}
FEWEST_POINTS = 3


class MeasuredCurve(NamedTuple):
    """Points in the order of the strain, SI; of a curve that turns back only those at strains never reached before."""

    name: str  # of the quantity: stress, or a column of series.csv
    strain: np.ndarray
    values: np.ndarray


class Comparison(NamedTuple):
    """Over the strains that both have; differences are run minus measured."""

    strain: np.ndarray
    measured: np.ndarray
    run: np.ndarray

    @property
    def difference(self):
        return self.run - self.measured

    @property
    def rms(self) -> float:
        return float(np.sqrt(np.mean(self.difference**2)))

    @property
    def largest(self) -> tuple[float, float]:
        """(strain, difference) where they are farthest apart."""
        k = int(np.argmax(abs(self.difference)))
        return float(self.strain[k]), float(self.difference[k])


def read_measured(path) -> MeasuredCurve:
    """A table with a header `strain,stress[MPa]`: two columns, or more of which the first two are taken; lines with # are
    comments; the separator is a comma, a semicolon or a tab. Raises ValueError with the line and the remedy."""
    lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    lines = [(number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise ValueError(f"{path} is empty; it must have a header, strain,stress[MPa], and a line for each point")
    header = lines[0][1]
    separator = next((mark for mark in (";", "\t") if mark in header), ",")
    cells = [cell.strip() for cell in header.split(separator)]
    names, factors = zip(*(_name_and_factor(path, cell) for cell in cells[:2]))
    if len(names) < 2 or names[0] != "strain":
        raise ValueError(f"{path}:{lines[0][0]}: the header is '{header}'; it must begin with two columns, strain and what was measured: "
                         "strain,stress[MPa] or strain,force_top[N/m]")
    rows = np.array([_numbers(path, number, line.split(separator)) for number, line in lines[1:]]).reshape(-1, 2) * factors
    strain, values = measure.envelope(*rows.T) if len(rows) else rows.T
    if len(strain) < FEWEST_POINTS:
        raise ValueError(f"{path} has {len(strain)} points of rising strain; at least {FEWEST_POINTS} are needed")
    return MeasuredCurve(names[1], strain, values)


def is_smooth(run: Run) -> bool:
    """Whether a curve has no serration: that of one elastic grain."""
    return run.elastic and "phi" not in run.series


def run_curve(run: Run, name: str = STRESS, window: float = 0.01) -> tuple[np.ndarray, np.ndarray]:
    """(strain, values) of a run at strains never reached before; of bonded grains and packings, whose curves are serrated, the
    mean over a window of strain, by default that of `softgrain plot`. Raises NotRecorded."""
    series = run.series
    if "strain" not in series or (name != STRESS and name not in series):
        raise NotRecorded(f"{run.path}: series.csv has no {name if 'strain' in series else 'strain'}; the measured column must be named "
                          f"{STRESS} (the mean of the two walls) or as a column there")
    values = measure.vertical_stress(series) if name == STRESS else series[name]
    strain, values = measure.envelope(series["strain"], values)
    return strain, values if is_smooth(run) else measure.moving_mean(strain, values, window)


def compare(run: Run, curve: MeasuredCurve) -> Comparison:
    """At the measured strains within the run's, its values between its rows. Raises ValueError where they have none in common."""
    strain, values = run_curve(run, curve.name)
    common = (curve.strain >= strain[0]) & (curve.strain <= strain[-1])
    if np.count_nonzero(common) < FEWEST_POINTS:
        raise ValueError(f"{run.path} has strains from {strain[0]:.4g} to {strain[-1]:.4g}, the measured curve from "
                         f"{curve.strain[0]:.4g} to {curve.strain[-1]:.4g}: fewer than {FEWEST_POINTS} of its points are common")
    at = curve.strain[common]
    return Comparison(at, curve.values[common], np.interp(at, strain, values))


def _name_and_factor(path, cell):
    """("stress", 1e6) of "stress[MPa]"."""
    name, _, rest = cell.partition("[")
    unit = rest.rstrip("] ")
    if unit not in UNITS:
        known = ", ".join(word for word in UNITS if word)
        raise ValueError(f"{path}: the unit '{unit}' of {name.strip()} is not known; use one of {known}, or none")
    return name.strip(), UNITS[unit]


def _numbers(path, number, cells):
    try:
        found = [float(cell) for cell in cells[:2]]
    except ValueError:
        found = []
    if len(found) < 2 or not all(map(math.isfinite, found)):
        raise ValueError(f"{path}:{number}: '{','.join(cells)}' is no point: two numbers are needed, with a decimal point")
    return found
