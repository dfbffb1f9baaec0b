"""Least squares in the logarithms of parameters, and what the data say of each: pure numbers, no simulation."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

CONFIDENCE = 0.95
DETERMINED = 0.1  # half of an interval in ln p, up to which a parameter counts as determined: 10 % to either side
ENOUGH = 1e-4  # relative fall of the sum of squares that is not worth another step: a tenth of a standard error for 100 points
SMALLEST_STEP = 3e-4  # in ln p


class Estimate(NamedTuple):
    """x = ln(p/p_start). Half-widths are those of 95 % intervals of the linearised problem."""

    x: np.ndarray
    half_widths: np.ndarray
    noise: float  # standard deviation of the residuals, in their unit
    correlation: float  # how many neighbouring residuals say the same: 1 for independent ones
    directions: np.ndarray  # rows: unit vectors in ln p, the best determined first (right singular vectors)
    direction_half_widths: np.ndarray
    quantile: float  # half-width over standard error
    at_bound: np.ndarray  # whether the search ended at a bound
    converged: bool

    @property
    def determined(self) -> np.ndarray:
        return (self.half_widths <= DETERMINED) & ~self.at_bound

    def half_width_of(self, direction) -> float:
        """Of the combination sum_i d_i ln p_i."""
        return float(np.hypot.reduce(self.directions @ np.asarray(direction, float) * self.direction_half_widths))


def estimate(residuals, jacobian, bounds, most_steps=30) -> Estimate:
    """Minimises |residuals(x)|^2 from x = 0; `bounds` is (lowest, highest) of x. The order of the residuals is that of the strain:
    their correlation widens the intervals."""
    low, high = (np.asarray(b, float) for b in bounds)
    # SciPy measures steps against the length of x, which is 0 where we begin: y = x + 1
    found = least_squares(lambda y: residuals(y - 1), np.ones(len(low)), lambda y: jacobian(y - 1), bounds=(low + 1, high + 1),
                          ftol=ENOUGH, xtol=SMALLEST_STEP, gtol=1e-12, max_nfev=most_steps)
    count, free = found.jac.shape
    left = max(1, count - free)
    noise = float(np.sqrt(2 * found.cost / left))
    correlation = min(correlation_of(found.fun), left / 2)
    quantile = float(student.ppf((1 + CONFIDENCE) / 2, max(1.0, count / correlation - free)))
    # J = U S V^T: the combination v . ln p has the standard error noise/s
    _, s, directions = np.linalg.svd(found.jac, full_matrices=False)
    errors = noise * np.sqrt(correlation) / np.maximum(s, 1e-12 * max(s.max(initial=0), 1e-300))
    half_widths = quantile * np.sqrt((directions**2 * errors[:, None] ** 2).sum(axis=0))
    return Estimate(found.x - 1, half_widths, noise, correlation, directions, quantile * errors, quantile, found.active_mask != 0,
                    found.status > 0)


def correlation_of(residuals) -> float:
    """Integrated autocorrelation 1 + 2 sum rho_k over the first lags at which rho is above what chance gives, 2/sqrt(n); at least 1."""
    r = np.asarray(residuals, float) - np.mean(residuals)
    power = r @ r
    if power == 0:
        return 1.0
    total = 1.0
    for lag in range(1, len(r) // 2):
        rho = r[lag:] @ r[:-lag] / power
        if rho < 2 / np.sqrt(len(r)):
            break
        total += 2 * rho
    return float(total)
