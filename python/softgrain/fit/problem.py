"""A fit as a function of its parameters: each value is a run of the case."""

import hashlib
import json
import math
import os
import warnings
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from pathlib import Path

import numpy as np

from ..case import Case, DoubtfulRun, call_program, run_case
from ..compare import MeasuredCurve, is_smooth, run_curve
from ..run import Run, open_run
from ..sweep.state import doubts, state

OUTPUT = {"output.snapshots": 1, "output.vtk": False, "output.report": False}
STEP_SMOOTH, STEP_SERRATED = 0.02, 0.3  # of ln p in differences: those of serrated curves must be larger than a serration
WINDOW = 0.05  # of strain, over which the run's serrated curves are averaged
ENOUGH_ROWS = 600
FROM_BOUND = 0.01  # of the value, kept from a bound that is not itself allowed


class FitError(ValueError):
    """The fit makes no sense as it was asked for, or no run follows."""


class Problem:
    """residuals(x) and jacobian(x) of ln(p/p_start), in units of the largest measured value."""

    def __init__(self, case: Case, curve: MeasuredCurve, free: list[str], folder: Path, jobs: int, most_runs: int, seeds: int = 1):
        """seeds: samples, from the case's seed on, whose mean curve is the model's."""
        self.case, self.curve, self.free, self.folder, self.jobs, self.most_runs = case, curve, free, Path(folder), jobs, most_runs
        self.scale = float(abs(curve.values).max()) or 1.0
        self.runs_made, self.cpu_seconds, self.runs = 0, 0.0, {}
        resolved = case.resolve()
        self.start = np.array([_start(resolved, key) for key in free])
        self.bounds = _bounds(free, self.start)
        for key, value in OUTPUT.items():
            self.case = self.case.set(key, value)
        self.case = self.case.set("output.samples", max(ENOUGH_ROWS, resolved["output"]["samples"]))
        _refuse_without_effect(self._case_at(np.zeros(len(free))), free)
        first = resolved["sample"]["seed"]
        self.seeds = range(first, first + seeds)

    def values(self, x) -> np.ndarray:
        """Of the parameters, SI."""
        return self.start * np.exp(x)

    def model(self, x) -> np.ndarray:
        """The run's curve at the measured strains within its path."""
        return np.mean([self._curve(x, seed) for seed in self.seeds], axis=0)

    def _curve(self, x, seed):
        strain, values = run_curve(self.run(x, seed), self.curve.name, WINDOW)
        if strain[-1] < self.within[-1]:
            raise FitError(f"the run at {self._words(x)} ended at strain {strain[-1]:.4g}, before the measured {self.within[-1]:.4g}: "
                           "`softgrain info` of its directory tells why")
        return np.interp(self.within, strain, values)

    @cached_property
    def within(self) -> np.ndarray:
        """The measured strains that the path of the case reaches."""
        start = np.zeros(len(self.free))
        self._make([(start, self.seeds[0])])
        strain = self.run(start).series["strain"]
        low, high = strain.min(), strain.max()
        within = self.curve.strain[(self.curve.strain >= low) & (self.curve.strain <= high)]
        if len(within) <= len(self.free):
            raise FitError(f"the case's path reaches strains from {low:.4g} to {high:.4g}, the curve has {len(within)} points there, and "
                           f"{len(self.free)} parameters are free: there must be more points than parameters")
        return within

    @property
    def measured(self) -> np.ndarray:
        return np.interp(self.within, self.curve.strain, self.curve.values)

    def residuals(self, x) -> np.ndarray:
        self._make([(x, seed) for seed in self.seeds])
        return (self.model(x) - self.measured) / self.scale

    def jacobian(self, x) -> np.ndarray:
        """Differences to the side on which there is room; the runs are made side by side."""
        step = STEP_SMOOTH if is_smooth(self.run(x)) else STEP_SERRATED
        steps = np.where(x + step <= self.bounds[1], step, -step)
        places = [x, *(x + step * unit for step, unit in zip(steps, np.eye(len(x))))]
        self._make([(place, seed) for place in places for seed in self.seeds])
        here, *there = map(self.model, places)
        return np.column_stack([(other - here) / step for other, step in zip(there, steps)]) / self.scale

    def _make(self, wanted):
        """All runs wanted, side by side; those that are doubtful are told at the end, together."""
        with warnings.catch_warnings(), ThreadPoolExecutor(self.jobs) as pool:
            warnings.simplefilter("ignore", DoubtfulRun)
            list(pool.map(lambda place: self.run(*place), wanted))

    def run(self, x, seed=None) -> Run:
        """Of the parameters at x; one that is done already is opened. Raises CaseError, RunFailed, FitError."""
        case = self._case_at(x).set("sample.seed", self.seeds[0] if seed is None else seed)
        text = json.dumps([Path(str(case.path)).read_text(), case.values])
        path = self.folder / "runs" / hashlib.sha256(text.encode()).hexdigest()[:16]
        if path not in self.runs:
            if state(path) != "done":
                self.runs_made += 1
                if self.runs_made > self.most_runs:
                    raise FitError(f"gave up after {self.most_runs} runs, the last at {self._words(x)}; --most-runs allows more")
                run_case(case, path, threads=max(1, len(os.sched_getaffinity(0)) // self.jobs), resume=path.exists())
            self.runs[path] = open_run(path)
            self.cpu_seconds += self.runs[path].info.get("cpu_seconds", 0)
        return self.runs[path]

    @property
    def doubtful(self) -> list[Path]:
        return [path for path in self.runs if doubts(path)]

    def _case_at(self, x):
        case = self.case
        for key, value in zip(self.free, self.values(x)):
            case = case.set(key, float(value))
        return case

    def _words(self, x):
        return ", ".join(f"{key} = {value:.6g}" for key, value in zip(self.free, self.values(x)))


def _start(resolved, key):
    table, _, name = key.partition(".")
    value = resolved.get(table, {}).get(name)
    if value is None:
        raise FitError(f"--free {key}: the case has no such key; `softgrain schema --markdown` lists them, as mpm.young_modulus")
    if isinstance(value, (str, list, bool, int)):
        raise FitError(f"--free {key}: it is {value!r}, not a number that can vary continuously")
    if not value > 0:
        raise FitError(f"--free {key}: the search begins at the case's value, which is {value:g}; it must be above 0: "
                       f"--set {key}=... gives another")
    return value


def _bounds(free, start):
    """Of ln(p/start), from the schema of the program; exclusive bounds are kept away from."""
    schema = json.loads(call_program("schema"))["properties"]
    low, high = [], []
    for key, value in zip(free, start):
        table, _, name = key.partition(".")
        kinds = schema[table]["properties"][name].get("anyOf", [schema[table]["properties"][name]])
        number = next(kind for kind in kinds if kind.get("type") == "number")
        least = max(number.get("exclusiveMinimum", 0), number.get("minimum", 0))
        most = min(number.get("exclusiveMaximum", math.inf), number.get("maximum", math.inf))
        low.append(min(0, math.log(least * (1 + FROM_BOUND) / value)) if least > 0 else -math.inf)
        high.append(max(0, math.log(most * (1 - FROM_BOUND) / value)) if most < math.inf else math.inf)
    return np.array(low), np.array(high)


def _refuse_without_effect(case, free):
    idle = [key for key in json.loads(call_program("check", *case.words(), "--json"))["without_effect"] if key in free]
    if idle:
        raise FitError(f"--free {idle[0]}: it has no effect in this case, so no curve can tell it")
