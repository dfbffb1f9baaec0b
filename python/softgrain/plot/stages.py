"""Which snapshots tell the story of a run: the start, each reversal, each unloaded state, the end."""

from typing import NamedTuple

import numpy as np

from .. import measure
from ..stress_unit import unit_for

MOST_STAGES = 6


class Stage(NamedTuple):
    snapshot: int
    strain: float | None  # None if series.csv does not say
    stress: float | None  # [Pa]


def headings(stages):
    """One for each: its letter, strain and stress, all stresses in one unit."""
    unit = unit_for([stage.stress or 0 for stage in stages])
    return [f"({letter})  " + "\n".join(words_of(stage, unit)) for letter, stage in zip("abcdef", stages)]


def words_of(stage, unit):
    """Strain and stress of a stage, as far as they are known."""
    words = [] if stage.strain is None else [rf"$\varepsilon$ = {stage.strain + 0:.3f}"]
    return words + ([] if stage.stress is None else [rf"$\sigma$ = {unit.text(stage.stress)}"])


def choose_stages(run, times):
    """The snapshots of the moments that matter, each once, in order; evenly spaced ones if there are none."""
    times = np.asarray(times)
    chosen = _snapshots_of_moments(run.series, times) if {"time", "strain"} <= run.series.keys() else set()
    if len(chosen) < min(3, times.size):
        evenly = np.linspace(0, times.size - 1, min(MOST_STAGES, times.size))
        chosen = set(evenly.round().astype(int).tolist())
    return [stage_at(run.series, snapshot, times[snapshot]) for snapshot in sorted(chosen)]


def _snapshots_of_moments(series, times):
    """The first and the last snapshot; of each unloading the last one before it, the one nearest its end."""
    time = series["time"]
    sampling_interval = np.diff(time).max(initial=0)
    chosen = {0, times.size - 1}
    for branch in measure.branches(series["strain"], measure.directions(series)):
        if branch.kind == measure.UNLOADING and len(chosen) + 2 <= MOST_STAGES:
            # The series knows the moment of the reversal only to one interval.
            loaded = np.searchsorted(times, time[branch.first] + 0.5 * sampling_interval) - 1
            chosen |= {max(0, int(loaded)), int(np.argmin(abs(times - time[branch.last])))}
    return chosen


def stage_at(series, snapshot, time):
    """Strain and stress at the time of a snapshot, between the rows of the series."""
    def now(column):
        known = {"time", column} <= series.keys()
        return float(np.interp(time, series["time"], series[column])) if known else None

    stresses = [stress for stress in map(now, measure.WALL_STRESSES) if stress is not None]
    return Stage(snapshot, now("strain"), float(np.mean(stresses)) if stresses else None)
