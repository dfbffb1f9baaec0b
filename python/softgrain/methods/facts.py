"""The numbers of a run that a paper states, from run.json, series.csv, the case and its snapshots."""

import hashlib
from typing import NamedTuple

import h5py
import numpy as np

from .. import NotRecorded, measure


class Facts(NamedTuple):
    """SI units; None where the run does not say."""

    model: str  # "bpm", "mpm" or "rigid"
    in_space: bool
    grains: int
    particles: int  # primaries or material points, in all
    steps: int
    time_step: tuple  # shortest and longest mean over the steps between two rows [s]
    strain: float  # the largest
    inertial_number: tuple | None  # median and largest over the rows under load
    steps_converged: int
    residual: float  # largest, over the mean radius of a body
    residual_limit: float
    overlap: float  # largest, over the mean radius of a body
    energy_error: float  # over the largest energy of the run
    version: str
    commit: str
    case_hash: str  # SHA-256 of case.toml
    content_hash: str  # XXH3-128 of the newest snapshot's arrays
    year: str


def facts_of(run) -> Facts:
    """Raises NotRecorded where the run has no snapshot, no row or no report yet."""
    if len(run) == 0 or not {"time", "step", "strain"} <= run.series.keys() or "report" not in run.info:
        raise NotRecorded(f"{run.path} has no snapshot, no row or no run.json: it has not begun")
    snapshot, report, program = run[0], run.info["report"], run.info["program"]
    return Facts(
        model=run.case["experiment"]["model"], in_space=run.in_space, grains=_grains(snapshot), particles=len(snapshot.particles["position"]),
        steps=report["steps"], time_step=_time_steps(run.series), strain=float(run.series["strain"].max()),
        inertial_number=_inertial_number(run), steps_converged=report["steps_converged"], residual=report["residual_max"],
        residual_limit=report["residual_limit"], overlap=report["overlap_max"],
        energy_error=abs(report["energy_error"]) / (report["energy_scale"] or 1), version=program["version"],
        commit=program["commit"], case_hash=hashlib.sha256((run.path / "case.toml").read_bytes()).hexdigest(),
        content_hash=_content_hash(run.snapshots[-1]), year=run.info.get("started", "")[:4])


def _grains(snapshot):
    grain = snapshot.particles.get("grain")
    return 1 if grain is None else int(np.max(grain)) + 1


def _time_steps(series):
    """Steps that were rejected or cut short make a mean over two rows smaller."""
    steps, time = np.diff(series["step"]), np.diff(series["time"])
    means = time[steps > 0] / steps[steps > 0]
    return (float(means.min()), float(means.max())) if means.size else (0.0, 0.0)


def _inertial_number(run):
    """The column of packings; of one grain I = |d eps/dt| d sqrt(rho/sigma), theory (63), with its diameter d and the vertical stress.

    Over rows with at least a hundredth of the largest stress: while nothing touches, the number means nothing."""
    series = run.series
    try:
        stress = measure.vertical_stress(series)
    except NotRecorded:
        return None
    loaded = stress > 0.01 * stress.max()
    if "inertial_number" in series:
        values = series["inertial_number"][loaded]
    else:
        rate = np.gradient(series["strain"], series["time"]) if len(stress) > 1 else np.zeros(len(stress))
        grain = run.case["grain"]
        values = abs(rate[loaded]) * 2 * grain["radius"] * np.sqrt(grain["density"] / stress[loaded])
    return (float(np.median(values)), float(values.max())) if values.size else None


def _content_hash(path):
    with h5py.File(path, "r", locking=False) as file:
        found = file.attrs.get("content_hash", "")
    return found.decode() if isinstance(found, bytes) else str(found)
