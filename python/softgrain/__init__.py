"""Softgrain in Python: `run = softgrain.open("RUN")`, `run = softgrain.run_case(case, "RUN")`, `softgrain.Simulation(case)`.

Needs NumPy and, for snapshots, h5py. `Simulation`, `Grain`, `set_threads` and `threads` need the compiled module as well."""

from typing import TYPE_CHECKING

from .case import Case, CaseError, DoubtfulRun, RunFailed, run_case
from .run import NotARun, NotRecorded, Run, Snapshot, open_run

if TYPE_CHECKING:
    from ._core import set_threads as set_threads, threads as threads
    from .simulation import Grain as Grain, Simulation as Simulation

open = open_run  # softgrain.open reads well where it is used; here it hides the builtin on purpose

__version__ = "0.2.0"

COMPILED = {"Simulation": "simulation", "Grain": "simulation", "set_threads": "_core", "threads": "_core"}

__all__ = ["Case", "CaseError", "DoubtfulRun", "NotARun", "NotRecorded", "Run", "RunFailed", "Snapshot", "__version__", "open",
           "run_case"]


def __dir__():
    """With what is loaded only when it is asked for."""
    return sorted({*globals(), *COMPILED})


def __getattr__(name):
    """What needs the compiled module is loaded when it is asked for."""
    if name not in COMPILED:
        raise AttributeError(f"module 'softgrain' has no attribute '{name}'")
    from importlib import import_module

    try:
        return getattr(import_module(f".{COMPILED[name]}", __name__), name)
    except ModuleNotFoundError as missing:
        if missing.name != "softgrain._core":
            raise
        raise ImportError(f"softgrain.{name} needs the compiled module softgrain._core, which is not beside {__file__} or was built "
                          "for another Python: see docs/guide/python.md") from missing
