"""What a die says of a powder: equations of compaction fitted to a run, elastic recovery, plasticity. Compression counts positive."""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from . import measure
from .run import NotRecorded

WINDOW = (0.2, 0.8)  # of the largest pressure


class Constant(NamedTuple):
    value: float
    half_width: float  # of the 95 % interval

    def text(self):
        """"1.234 ± 0.005", with two digits of the interval."""
        if not 0 < self.half_width < math.inf:
            return f"{self.value:.4g}"
        digits = max(0, 1 - math.floor(math.log10(self.half_width)))
        return f"{self.value:.{digits}f} ± {self.half_width:.{digits}f}"


class Line(NamedTuple):
    """y = slope x + intercept by least squares, with the covariance of both; residuals count as independent."""

    slope: float
    intercept: float
    covariance: np.ndarray  # of (slope, intercept)
    r_squared: float
    quantile: float  # Student's t for 95 %

    def at(self, x):
        return self.slope * np.asarray(x) + self.intercept

    def interval(self, gradient):
        """Half the 95 % interval of a function of slope and intercept with this gradient, to first order."""
        gradient = np.asarray(gradient)
        return float(self.quantile * np.sqrt(gradient @ self.covariance @ gradient))


class Fit(NamedTuple):
    """An equation of compaction in its linear form."""

    line: Line
    window: tuple  # of pressures, both included [Pa]
    constants: dict  # name: Constant, in SI


class Compaction(NamedTuple):
    """The way in, up to the largest pressure: arrays of one length."""

    pressure: np.ndarray  # mean of bottom and top wall [Pa]
    density: np.ndarray  # relative density D = Phi
    reduction: np.ndarray  # Kawakita's C = 1 - V/V_start


class Recovery(NamedTuple):
    """How much longer the compact is than under the largest pressure, over its length there; None: never let go."""

    axial_unloaded: float | None  # when the top wall bears nothing any more
    axial: float | None  # at the end
    radial: float | None


def loading(run):
    """Rows at strains that were never reached before, up to the largest pressure. Raises NotRecorded."""
    series = run.series
    if not {"phi", "strain", "wall_height", "width"} <= series.keys():
        raise NotRecorded(f"{run.path}: series.csv has no phi, strain, wall_height or width: that is of packings")
    pressure = measure.vertical_stress(series)
    volume = series["wall_height"] * series["width"]
    rows = measure.is_envelope(series["strain"]) & (np.arange(pressure.size) <= np.argmax(pressure)) & (pressure > 0)
    return Compaction(pressure[rows], series["phi"][rows], 1 - volume[rows] / volume[0])


@lru_cache
def students_t(freedom):
    """The quantile of 97.5 %: with t = sqrt(n) tan(theta), Student's density is in proportion to cos(theta)^(n-1)."""
    theta = np.linspace(0, np.pi / 2, 100_001)
    density = np.cos(theta) ** (freedom - 1)
    below = np.append(0, np.cumsum((density[1:] + density[:-1]) / 2))
    return math.sqrt(freedom) * math.tan(np.interp(0.95, below / below[-1], theta))


def fit_line(x, y):
    """Raises NotRecorded for fewer than three points."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if x.size < 3 or np.ptp(x) == 0:
        raise NotRecorded(f"{x.size} rows in the window are too few for a line and its intervals: take a wider --window, or more output.samples")
    away = x - x.mean()
    slope = away @ y / (away @ away)
    intercept = y.mean() - slope * x.mean()
    rest = y - slope * x - intercept
    variance = rest @ rest / (x.size - 2)
    of_slope = variance / (away @ away)
    cross = -x.mean() * of_slope
    covariance = np.array([[of_slope, cross], [cross, variance / x.size + x.mean() ** 2 * of_slope]])
    spread = np.sum((y - y.mean()) ** 2)
    return Line(slope, intercept, covariance, 1 - rest @ rest / spread if spread > 0 else 1.0, students_t(x.size - 2))


def heckel(pressure, density, window=None):
    """ln(1/(1-D)) = K P + A (Heckel 1961); the yield pressure is 1/K."""
    window, rows = _rows(pressure, window, np.asarray(density) < 1)
    line = fit_line(pressure[rows], -np.log1p(-density[rows]))
    return Fit(line, window, {
        "K": Constant(line.slope, line.interval((1, 0))),
        "A": Constant(line.intercept, line.interval((0, 1))),
        "1/K": Constant(1 / line.slope, line.interval((line.slope**-2, 0)))})


def panelli_ambrozio(pressure, density, window=None):
    """ln(1/(1-D)) = A sqrt(P) + B (Panelli & Ambrozio 2001)."""
    window, rows = _rows(pressure, window, np.asarray(density) < 1)
    line = fit_line(np.sqrt(pressure[rows]), -np.log1p(-density[rows]))
    return Fit(line, window, {
        "A": Constant(line.slope, line.interval((1, 0))), "B": Constant(line.intercept, line.interval((0, 1)))})


def kawakita(pressure, reduction, window=None):
    """P/C = P/a + 1/(a b) (Kawakita & Ludde 1971), C = 1 - V/V_start: a is the largest C, 1/b the pressure of half of it."""
    window, rows = _rows(pressure, window, np.asarray(reduction) > 0)
    line = fit_line(pressure[rows], pressure[rows] / reduction[rows])
    slope, intercept = line.slope, line.intercept
    return Fit(line, window, {
        "a": Constant(1 / slope, line.interval((slope**-2, 0))),
        "b": Constant(slope / intercept, line.interval((1 / intercept, -slope / intercept**2))),
        "1/b": Constant(intercept / slope, line.interval((-intercept / slope**2, 1 / slope)))})


def _rows(pressure, window, usable):
    pressure = np.asarray(pressure)
    if window is None:
        window = tuple(share * pressure.max(initial=0) for share in WINDOW)
    return window, usable & (pressure >= window[0]) & (pressure <= window[1])


def recovery(series):
    """By the walls: under pressure where the box is lowest; unloaded where the side walls begin to open, or at the end."""
    height, width = series["wall_height"], series["width"]
    pressed = height.size - 1 - int(np.argmin(height[::-1]))
    after = height[pressed:]
    opened = np.flatnonzero(width[pressed:] > width[pressed] * (1 + 1e-9))
    if after[-1] == after[0]:
        return Recovery(None, None, None)
    unloaded = after[opened[0] if opened.size else -1]
    if not opened.size:
        return Recovery(unloaded / after[0] - 1, None, None)
    return Recovery(unloaded / after[0] - 1, after[-1] / after[0] - 1, width[-1] / width[pressed] - 1)


def plasticity_index(series):
    """Plastic work over the total work of the walls up to the largest compression; None: nothing flows."""
    if "dissipation_plastic" not in series:
        return None
    pressed = int(np.argmax(series["wall_work"]))
    return float(series["dissipation_plastic"][pressed] / series["wall_work"][pressed])
