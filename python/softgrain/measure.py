"""What the stress-strain curve of a grain between two walls says. Compression counts positive."""

from typing import NamedTuple

import numpy as np

from .run import NotRecorded

WALL_STRESSES = ("stress_top", "stress_bottom")
LOADING, UNLOADING, RELOADING, HOLD = "loading", "unloading", "reloading", "hold"
HELD_STRAIN, HELD_STRESS = 0.01, 0.2  # a hold strays by less: over all strain of the run, over its mean stress


class Branch(NamedTuple):
    """A stretch of the curve: samples first..last (both included) lie on it."""

    kind: str
    first: int
    last: int

    @property
    def samples(self):
        return slice(self.first, self.last + 1)


class Plateau(NamedTuple):
    mean: float  # in the unit of the stress
    deviation: float  # standard deviation: the serration
    strain_range: tuple


class Unloading(NamedTuple):
    reversal: float  # strain where it begins
    end: float  # strain where it ends
    slope: float  # d sigma / d eps, in the unit of the stress


def vertical_stress(series):
    """sigma = F/L, the mean of the two walls [Pa]; one wall alone if only it was recorded."""
    walls = [series[name] for name in WALL_STRESSES if name in series]
    if not walls:
        raise NotRecorded("series.csv has neither stress_top nor stress_bottom")
    return np.mean(walls, axis=0)


def held(series):
    """Of each step from one sample to the next whether its stage only holds: strain and stress, or the strain alone."""
    strain = series["strain"]
    still = np.zeros(max(strain.size - 1, 0), dtype=bool)
    if "leg" not in series or not any(name in series for name in WALL_STRESSES):
        return still
    leg, stress = series["leg"], vertical_stress(series)
    for number in np.unique(leg):
        rows = np.flatnonzero(leg == number)
        way, load = np.ptp(strain[rows]), stress[rows]
        is_kept = way < HELD_STRAIN * np.ptp(strain) and np.ptp(load) < HELD_STRESS * abs(load.mean())
        if rows.size > 1 and (way == 0 or is_kept):
            still[max(rows[0] - 1, 0) : rows[-1]] = True
    return still


def branches(strain, still=None):
    """Cuts a strain history into loading (beyond every strain before), unloading and reloading branches, and holds
    where `still` says so of a step.

    Neighbouring branches share the sample where one ends and the next begins."""
    strain = np.asarray(strain)
    if strain.size < 2:
        return []
    reached = np.maximum.accumulate(strain)[:-1]
    going_down = np.diff(strain) < 0
    beyond = strain[1:] > reached
    kinds = np.where(going_down, UNLOADING, np.where(beyond, LOADING, RELOADING))
    if still is not None:
        kinds = np.where(still, HOLD, kinds)
    cuts = np.flatnonzero(kinds[1:] != kinds[:-1]) + 1
    ends = [0, *cuts, kinds.size]
    return [Branch(str(kinds[a]), int(a), int(b)) for a, b in zip(ends, ends[1:])]


def is_envelope(strain):
    """Which samples are at strains never reached before."""
    return np.append(True, strain[1:] > np.maximum.accumulate(strain)[:-1])


def envelope(strain, stress):
    """The samples at strains never reached before: (strain, stress), strain increasing."""
    strain, stress = np.asarray(strain), np.asarray(stress)
    first_visit = is_envelope(strain)
    return strain[first_visit], stress[first_visit]


def moving_mean(strain, stress, window=0.01):
    """Mean stress over [strain - window/2, strain + window/2] at each sample; strain must increase.

    At the start, where the curve is steep, the window shrinks to both sides; at the end it is cut off."""
    half = np.minimum(window / 2, strain - strain[0])
    # A tolerance far below any sampling interval keeps the two edge samples inside.
    first = np.searchsorted(strain, strain - half - 1e-12)
    last = np.searchsorted(strain, strain + half + 1e-12, side="right")
    total = np.append(0.0, np.cumsum(stress))
    return (total[last] - total[first]) / (last - first)


def plateau(strain, stress, start=0.05):
    """Mean and serration of the envelope beyond strain `start`; None if it ends before."""
    strain, stress = envelope(strain, stress)
    plastic = strain >= start
    if np.count_nonzero(plastic) < 2:
        return None
    return Plateau(stress[plastic].mean(), stress[plastic].std(), (strain[plastic][0], strain[-1]))


def unloadings(strain, stress, still=None):
    """Each unloading, `still` as of `branches`; its slope is fitted from where the stress first falls below 80 % of that at the start
    to where it is last above 20 %."""
    found = []
    for branch in branches(strain, still):
        if branch.kind != UNLOADING:
            continue
        eps, sigma = strain[branch.samples], stress[branch.samples]
        loaded = np.flatnonzero(sigma > 0.2 * sigma[0])
        linear = slice(np.argmax(sigma < 0.8 * sigma[0]), loaded[-1] + 1 if loaded.size else 0)
        if eps[linear].size >= 2:
            slope = np.polyfit(eps[linear], sigma[linear], 1)[0]
            found.append(Unloading(float(eps[0]), float(eps[-1]), float(slope)))
    return found


def characteristic_stress(run):
    """sigma_I = F0/<a0> [Pa] (the paper, section 3), in space F0/<a0>^2; None for elastic grains, which have none, and if the run does not say.

    From the series; else with the mean primary diameter of the first snapshot for <a0>."""
    if run.elastic:
        return None
    if "sigma_I" in run.series:
        return float(run.series["sigma_I"][0])
    attraction = run.case.get("bpm", {}).get("force" if run.in_space else "attraction")
    if attraction is None or len(run) == 0:
        return None
    a0 = 2 * run[0].particles["radius"].mean()
    return attraction / (a0**2 if run.in_space else a0)


def contact_pressure(snapshot):
    """Pressure of the contact forces on each particle: sum_c f_c / (2 pi a) [Pa]; None without contacts."""
    if not {"pair", "force"} <= snapshot.contacts.keys() or snapshot.contacts_of_grains:
        return None
    radius = snapshot.particles["radius"]
    pair, force = snapshot.contacts["pair"], snapshot.contacts["force"]
    thrust = np.zeros(radius.size)
    for side in (0, 1):
        is_particle = (pair[:, side] >= 0) & (pair[:, side] < radius.size)
        np.add.at(thrust, pair[is_particle, side], force[is_particle])
    return thrust / (2 * np.pi * radius)
