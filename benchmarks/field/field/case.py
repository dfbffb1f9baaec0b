"""What a case of the set is, and what one run of a code gives."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np


@dataclass(frozen=True)
class Column:
    """A measured quantity: its name in the tables, its unit, and its words in figures."""

    name: str
    unit: str
    label: str

    @property
    def heading(self):
        return f"{self.name}[{self.unit}]"


@dataclass(frozen=True)
class Curve:
    """One run of a code: values of the case's columns over its abscissa, in rising order."""

    variant: str  # "mu = 0.3"; runs of the same variant are samples of one thing
    sample: int  # the seed
    values: dict  # column name -> numpy array
    cpu_seconds: float = 0.0


@dataclass(frozen=True)
class Case:
    """One of the set: what is measured, where, and how each code measures it."""

    name: str  # of its folder
    title: str
    x: Column
    ys: tuple  # of Column
    grid: np.ndarray  # of x, at which curves are compared
    codes: dict  # code -> function(Place) -> [Curve]
    logarithmic: bool = False  # the last of `ys` is drawn so
    figure_variants: tuple = field(default=())  # what the figure shows; none: all


@dataclass(frozen=True)
class Code:
    """A program that can run cases: its name, and its version on this machine, "" where it is not here."""

    name: str
    title: str
    version: Callable[[], str]


def mean_curve(case, curves):
    """{column: (mean, standard deviation over the samples)} on the part of the grid that all samples reach, and that part."""
    low = max(curve.values[case.x.name][0] for curve in curves)
    high = min(curve.values[case.x.name][-1] for curve in curves)
    grid = case.grid[(case.grid >= low - 1e-12) & (case.grid <= high + 1e-12)]
    found = {}
    for y in case.ys:
        if all(y.name in curve.values for curve in curves):
            values = np.array([np.interp(grid, curve.values[case.x.name], curve.values[y.name]) for curve in curves])
            found[y.name] = values.mean(axis=0), values.std(axis=0)
    return grid, found
