"""A simulation in memory, step by step, with its state as NumPy arrays. Needs the compiled module `softgrain._core`."""

import math
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ._core import Simulation as CompiledSimulation, StepReport
from .case import Case
from .run import Snapshot


class Grain(NamedTuple):
    """One grain: read-only arrays (n, 2) on the simulation's own memory, which follow its steps."""

    position: np.ndarray  # of primaries, grid nodes or material points [m]
    velocity: np.ndarray  # theirs [m/s]
    outline: np.ndarray  # vertices, counter-clockwise [m]; empty for bpm, whose outlines `scene` finds


class Simulation(CompiledSimulation):
    """What a case describes, before its first step: `for s in Simulation(case).steps(until=0.3, every=100): ...`.

    The numbers are those of `softgrain run`; nothing is written. Raises CaseError, and RunFailed in a step."""

    def __init__(self, case: Case | dict | str | Path, motion: Callable[[float], float] | None = None,
                 duration: float | None = None):
        """motion: a loading path instead of the case's, for `duration` [s]: the rate of the distance of the walls [m/s]
        at a time [s], negative while they come together. It is asked once a step."""
        case = case if isinstance(case, Case) else Case(case)
        super().__init__(str(case.path), [f"{key}={value}" for key, value in case.values])
        self.units: dict[str, str] = {}  # of the last row observed
        self._motion = motion
        if motion is not None:
            me = weakref.proxy(self)  # a motion may know its simulation, and both must be able to go
            self.follow(math.nan if duration is None else duration, lambda time: _rate(me._motion(time), time))

    def run(self, until: float = math.inf) -> None:
        """Steps until the strain has reached `until`, or the end of the path. Other threads run meanwhile; Ctrl-C raises
        KeyboardInterrupt between two steps, after which the simulation can go on."""
        super().run(_strain(until))

    def step(self, count: int = 1) -> StepReport:
        """Up to `count` steps, fewer at the end of the path; what the last one did."""
        return super().step(_count("count", count, 0))

    def steps(self, until: float = math.inf, every: int = 1) -> Iterator["Simulation"]:
        """This simulation after each `every` steps, until the strain has reached `until`, or the end of the path."""
        return self._steps(_strain(until), _count("every", every, 1))

    def _steps(self, until, every):
        while not self.finished and self.strain < until:
            self.step(every)
            yield self

    def observe(self) -> dict[str, float]:
        """The row of series.csv now. Forces on walls are means over the steps since the last row."""
        row = self.row()
        self.units = {name: unit for name, unit, _ in row}
        return {name: value for name, _, value in row}

    @property
    def grains(self) -> list[Grain]:
        """Views of all grains. They keep the simulation alive; a copy keeps the present state."""
        return [Grain(*views) for views in self.views()]

    def scene(self) -> Snapshot:
        """The state now, as a snapshot of a run has it: arrays of their own, with pressures, contacts, outlines and walls."""
        return Snapshot(step=self.steps_done, time=self.time, **self.scene_parts())


def _count(name, value, least):
    if not value >= least or value != int(value):
        raise ValueError(f"{name} must be a whole number, at least {least}, got {value}")
    return int(value)


def _strain(until):
    if math.isnan(until):
        raise ValueError("until is nan: it must be a strain, or inf for the end of the path")
    return until


def _rate(value, time):
    """What a motion asks for, if it is a number [m/s]."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"the motion asks for {value!r} at {time:.6g} s: it must return a rate [m/s], a number") from None
