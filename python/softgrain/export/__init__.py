"""Snapshots in the formats of other programs. On the command line: `softgrain export RUN --to FORMAT`."""

from .contacts import write_contacts
from .grains import fabric, grain_table, write_grains
from .particles import write_csv, write_lammps, write_xyz
from .rocrate import write_rocrate
from .svg import scale_of, write_svg
from .vtkhdf import write_vtkhdf

__all__ = ["fabric", "grain_table", "scale_of", "write_contacts", "write_csv", "write_grains", "write_lammps", "write_rocrate", "write_svg", "write_vtkhdf", "write_xyz"]
