"""Closed forms for one elastic grain between walls, and what its curve says. Stress sigma = F/L [Pa]."""

import numpy as np

from .. import measure


def johnson_force(approach):
    """x = F/(E* R) of Johnson's line contact (1985): d/R = x/pi (ln(4 pi/x) - 1), d the approach to one wall."""
    x = np.linspace(1e-9, 1.5, 20001)
    return np.interp(approach, x / np.pi * (np.log(4 * np.pi / x) - 1), x)


def paper_force(strain):
    """x = F/(E* R) by the paper's Eq. (2), F = (pi/4) E* R eps."""
    return np.pi / 4 * np.asarray(strain)


def approach(strain):
    """d/R of the grain strain eps = -ln(1 - d/R)."""
    return -np.expm1(-np.asarray(strain))


def reduced_force(run):
    """(eps, F/(E* R)) of an elastic grain while loading further than before."""
    mpm, radius = run.case["mpm"], run.case["grain"]["radius"]
    modulus = mpm["young_modulus"] / (1 - mpm["poisson_ratio"] ** 2)
    force = (run.series["force_top"] + run.series["force_bottom"]) / 2
    strain, force = measure.envelope(run.series["strain"], force)
    return strain, force / (modulus * radius)


def slope_ratio(strain, stress):
    """Mean slope of sigma(eps) beyond eps = 0.25 over that between 0.1 and 0.2: below 1, "a lower slope"."""
    def slope(low, high):
        part = (strain >= low) & (strain <= high)
        return np.polyfit(strain[part], stress[part], 1)[0]

    return float(slope(0.25, strain.max()) / slope(0.1, 0.2))


def linear_strain(strain, stress, drop=0.1):
    """The strain up to which the curve, averaged over 0.5 % of strain, stays within `drop` of the line through its
    first 1 %."""
    mean = measure.moving_mean(strain, stress, 0.005)
    first = (strain > 0.002) & (strain <= 0.01)
    slope = (strain[first] @ mean[first]) / (strain[first] @ strain[first])
    below = np.flatnonzero((strain > 0.01) & (mean < (1 - drop) * slope * strain))
    return float(strain[below[0]]) if below.size else float(strain[-1])
