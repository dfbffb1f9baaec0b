"""What the stress-strain curve of a grain between two walls says. Compression counts positive."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .run import NotRecorded

WALL_STRESSES = ("stress_top", "stress_bottom")
LOADING, UNLOADING, RELOADING, HOLD = "loading", "unloading", "reloading", "hold"
HELD_STRAIN, HELD_STRESS = 0.01, 0.2  # a hold strays by less: over all strain of the run, over its stress


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


def directions(series):
    """Of each step from one sample to the next: 1 where the walls go on, -1 where they turn back, 0 where a leg only
    holds strain and stress, or the strain alone.

    Walls that keep a stress go to and fro as grains move. In a leg that does so, only ways of 1 % of the run's strain
    count on which the stress rises, or falls, with the strain."""
    strain = series["strain"]
    direction = np.where(np.diff(strain) < 0, -1, 1)
    if "leg" not in series or not any(name in series for name in WALL_STRESSES):
        return direction
    leg, stress, noise = series["leg"], vertical_stress(series), HELD_STRAIN * np.ptp(strain)
    for number in np.unique(leg):
        rows = np.flatnonzero(leg == number)
        first, last = max(rows[0] - 1, 0), rows[-1]
        if rows.size > 1 and _is_held(strain[rows], stress[rows], noise):
            direction[first:last] = 0
        elif np.unique(direction[first:last]).size > 1:
            direction[first:last] = 0
            for a, b in pairwise(first + turns(strain[first : last + 1], noise)):
                way, rise = strain[b] - strain[a], (stress[b] - stress[a]) / (max(stress[a], stress[b]) or 1)
                if abs(way) >= noise and np.sign(way) * rise > HELD_STRESS:
                    direction[a:b] = np.sign(way)
    return direction


def _is_held(strain, stress, noise):
    way = np.ptp(strain)
    return way == 0 or (way < noise and np.ptp(stress) < HELD_STRESS * abs(stress.mean()))


def turns(path, noise):
    """Where a path turns for at least `noise`, from its first to its last sample (indices, increasing)."""
    found, furthest, sign = [], 0, 0
    for i, value in enumerate(path):
        ahead = value - path[furthest]
        if sign * ahead > 0:
            furthest = i
        elif abs(ahead) >= noise:
            found.append(furthest)
            sign, furthest = np.sign(ahead), i
    return np.unique([0, *found, furthest, len(path) - 1])


def branches(strain, direction=None):
    """Cuts a strain history into loading (beyond every strain before), unloading and reloading branches, and holds;
    `direction` of each step as of `directions`, by default that of the strain.

    Neighbouring branches share the sample where one ends and the next begins."""
    strain = np.asarray(strain)
    if strain.size < 2:
        return []
    if direction is None:
        direction = np.where(np.diff(strain) < 0, -1, 1)
    reached = np.maximum.accumulate(strain)
    found = []
    cuts = (np.flatnonzero(np.diff(direction)) + 1).tolist()
    for a, b in pairwise([0, *cuts, direction.size]):
        if direction[a] <= 0:
            found.append(Branch(UNLOADING if direction[a] < 0 else HOLD, a, b))
            continue
        beyond = np.flatnonzero(strain[a + 1 : b + 1] > reached[a])
        new = a + int(beyond[0]) if beyond.size else b
        found += [Branch(kind, i, j) for kind, i, j in ((RELOADING, a, new), (LOADING, new, b)) if i < j]
    return found


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


def unloadings(strain, stress, direction=None):
    """Each unloading, `direction` as of `branches`; its slope is fitted from where the stress first falls below 80 % of
    that at the start to where it is last above 20 %."""
    found = []
    for branch in branches(strain, direction):
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
