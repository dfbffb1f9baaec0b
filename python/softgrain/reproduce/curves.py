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
    """Z - Z0 = A (Phi - Phi_c)^exponent, with the 95 % confidence interval of the fit alone."""

    exponent: float
    half_width: float
    z0: float  # Z at Phi_c
    z1: float  # the largest Z


def coordination_law(curve, least=0.01, phi_c=REFERENCE_PACKING_FRACTION, last=np.inf, name="z"):
    """The free exponent, by least squares of the logarithms from Phi_c + least to `last`. None with too few samples.

    Neighbouring samples are not independent: the interval takes one independent sample per WINDOW of strain."""
    z = getattr(curve, name)
    z0 = float(np.interp(phi_c, curve.phi, z))
    beyond = (curve.phi > phi_c + least) & (curve.phi <= last) & (z > z0)
    if np.count_nonzero(beyond) < 5:
        return None
    x = np.log(curve.phi[beyond] - phi_c)
    y = np.log(z[beyond] - z0)
    (slope, intercept), spread = np.polyfit(x, y, 1), x - x.mean()
    residual = y - slope * x - intercept
    independent = max(3.0, np.ptp(curve.strain[beyond]) / WINDOW)
    error = np.sqrt(residual.var() / (independent - 2 + 1e-9) / spread.var())
    return PowerLaw(float(slope), float(1.96 * error), z0, float(z.max()))


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
