"""Softgrain in Python: `run = softgrain.open("RUN")`, `run = softgrain.run_case(case, "RUN")`. Needs NumPy and, for snapshots, h5py."""

from .case import Case, CaseError, RunFailed, run_case
from .run import NotARun, NotRecorded, Run, Snapshot, open_run

open = open_run  # softgrain.open reads well where it is used; here it hides the builtin on purpose

__all__ = ["Case", "CaseError", "NotARun", "NotRecorded", "Run", "RunFailed", "Snapshot", "open", "run_case"]
