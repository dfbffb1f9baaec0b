"""What the compaction of a packing says: stress over strain, coordination over packing fraction. SI units."""

from dataclasses import dataclass

import numpy as np

from .. import measure

REFERENCE_PACKING_FRACTION = 0.8  # Phi0 of the paper's reference state
WINDOW = 0.02  # of strain, over which stresses and Z are averaged: walls are hit, not pressed, at 5 m/s
COORDINATIONS = ("z", "z_no_rattlers", "z_with_walls")


@dataclass(frozen=True)
class Compaction:
    """Means over WINDOW of strain, sample by sample; Phi is that of undeformed grains, as the paper's 0.7 e^eps."""

    strain: np.ndarray
    phi: np.ndarray  # Phi_0, undeformed grains
    phi_deformed: np.ndarray  # true area of the grains
    stress: np.ndarray  # mean of the top and the bottom wall [Pa]
    stress_top: np.ndarray
    stress_bottom: np.ndarray
    z: np.ndarray  # 2 N_pairs / N_grains
    z_no_rattlers: np.ndarray
    z_with_walls: np.ndarray  # 2 (N_pairs + N_wall_pairs) / N_grains

    @property
    def sides(self):
        """(2 N_pairs + N_wall_pairs)/N_grains: the mean number of sides of the grains, taken as polygons."""
        return (self.z + self.z_with_walls) / 2

    @property
    def after_reference(self):
        """Samples beyond the reference state."""
        return self.phi >= REFERENCE_PACKING_FRACTION

    @property
    def reference_stress(self):
        """sigma0 [Pa], where Phi = 0.8."""
        return float(np.interp(REFERENCE_PACKING_FRACTION, self.phi, self.stress))

    @property
    def strain_from_reference(self):
        """eps' = ln(h0/h), zero where Phi = 0.8."""
        return self.strain - np.interp(REFERENCE_PACKING_FRACTION, self.phi, self.strain)


def compaction(run):
    """The curves of a compaction. Rows after the last strain reached are left out."""
    series = run.series
    strain = series["strain"]
    _, first = np.unique(np.maximum.accumulate(strain), return_index=True)
    strain = strain[first]

    def mean(name):
        return measure.moving_mean(strain, series[name][first], WINDOW)

    top, bottom = mean("stress_top"), mean("stress_bottom")
    return Compaction(strain, series["phi_0"][first], series["phi"][first], (top + bottom) / 2, top, bottom,
                      *(mean(name) for name in COORDINATIONS))


@dataclass(frozen=True)
class PowerLaw:
    """Z = Z0 + A (Phi - Phi_c)^exponent, with the 95 % confidence interval of the exponent by the fit alone."""

    exponent: float
    half_width: float
    z0: float
    prefactor: float  # A


def coordination_law(curve, phi_c=REFERENCE_PACKING_FRACTION, last=1.0, name="z"):
    """Least squares of Z from Phi_c to `last`, Z0 and A free as well: one noisy value at Phi_c decides nothing. None with
    too few samples, or where Z does not rise.

    Neighbouring samples are not independent: the interval takes one independent sample per WINDOW of strain."""
    rows = (curve.phi >= phi_c) & (curve.phi <= last)
    x, z = curve.phi[rows] - phi_c, getattr(curve, name)[rows]
    if x.size < 6 or np.ptp(z) == 0:
        return None
    exponents = np.arange(0.05, 2.5, 0.01)
    exponent = exponents[np.argmin([_power_fit(x, z, a)[1] for a in exponents])]
    exponents = exponent + np.arange(-0.01, 0.0101, 0.0005)
    exponent = float(exponents[np.argmin([_power_fit(x, z, a)[1] for a in exponents])])
    (z0, prefactor), squares = _power_fit(x, z, exponent)
    inside = x > 0
    slopes = np.column_stack([np.ones_like(x), x**exponent, np.zeros_like(x)])
    slopes[inside, 2] = prefactor * x[inside] ** exponent * np.log(x[inside])
    independent = max(4.0, np.ptp(curve.strain[rows]) / WINDOW)
    variance = squares / (independent - 3) * np.linalg.pinv(slopes.T @ slopes)[2, 2] if prefactor else np.inf
    return PowerLaw(exponent, float(1.96 * np.sqrt(variance)), float(z0), float(prefactor)) if prefactor > 0 else None


def _power_fit(x, z, exponent):
    """(Z0, A) of Z = Z0 + A x^exponent, and the sum of the squares that are left."""
    rows = np.column_stack([np.ones_like(x), x**exponent])
    found = np.linalg.lstsq(rows, z, rcond=None)[0]
    return found, float(((rows @ found - z) ** 2).sum())


def curvature(curve, last=np.inf):
    """How far sigma(eps') at half of the strain, up to Phi = `last`, lies below the chord, over the chord's rise: 0
    linear, > 0 convex."""
    after = curve.after_reference & (curve.phi <= last)
    x, y = curve.strain_from_reference[after], curve.stress[after]
    middle = np.interp((x[0] + x[-1]) / 2, x, y)
    return float(((y[0] + y[-1]) / 2 - middle) / (y[-1] - y[0]))


def onset(curve, z=3.0):
    """(eps, Phi) where Z first reaches `z`, or None."""
    reached = np.flatnonzero(curve.z >= z)
    return (float(curve.strain[reached[0]]), float(curve.phi[reached[0]])) if reached.size else None


def ratio(rough, smooth, name, scaled=False):
    """Mean over Phi from 0.82 on of rough over smooth at equal Phi; `scaled`: each over its value at Phi = 0.8."""
    phi = common_phi(rough, smooth)
    values = [np.interp(phi, curve.phi, getattr(curve, name)) for curve in (rough, smooth)]
    if scaled:
        values = [value / np.interp(REFERENCE_PACKING_FRACTION, curve.phi, getattr(curve, name))
                  for value, curve in zip(values, (rough, smooth))]
    return float(np.mean(values[0] / values[1]))


def difference(rough, smooth, name):
    """Mean over Phi from 0.82 on of rough less smooth at equal Phi."""
    phi = common_phi(rough, smooth)
    return float(np.mean(np.interp(phi, rough.phi, getattr(rough, name)) - np.interp(phi, smooth.phi, getattr(smooth, name))))


def common_phi(*curves):
    return np.linspace(0.82, min(curve.phi.max() for curve in curves) - 0.01, 40)


@dataclass(frozen=True)
class Band:
    """Mean, least and largest of several curves over one axis."""

    x: np.ndarray
    mean: np.ndarray
    low: np.ndarray
    high: np.ndarray


def band(curves, of_x, of_y, count=150):
    """Of of_y(curve) over of_x(curve), where all curves have values."""
    xs = [of_x(curve) for curve in curves]
    x = np.linspace(max(values[0] for values in xs), min(values[-1] for values in xs), count)
    ys = np.array([np.interp(x, values, of_y(curve)) for values, curve in zip(xs, curves)])
    return Band(x, ys.mean(axis=0), ys.min(axis=0), ys.max(axis=0))
