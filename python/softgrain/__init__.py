"""Read the results of softgrain: `run = softgrain.open("RUN")`. Needs NumPy and, for snapshots, h5py."""

from .run import NotARun, NotRecorded, Run, Snapshot, open_run

open = open_run  # softgrain.open reads well where it is used; here it hides the builtin on purpose

__all__ = ["NotARun", "NotRecorded", "Run", "Snapshot", "open"]
