"""Snapshots in the formats of other programs. On the command line: `softgrain export RUN --to FORMAT`."""

from .particles import write_csv, write_lammps, write_xyz
from .picture import write_svg

__all__ = ["write_csv", "write_lammps", "write_svg", "write_xyz"]
