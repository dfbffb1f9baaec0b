"""Case 2: Sulsky's two disks, which collide and part."""

import numpy as np

from . import lammps
from .case import Case, Column, Curve
from .work import ROOT, CodeFailed, cpu_seconds_of, read_columns

TIME = Column("time", "s", "time [s]")
KINETIC = Column("kinetic/start", "-", "kinetic energy / that at the start")
DISTANCE = Column("distance", "m", "distance of the centres [m]")
STIFFNESS = 0.317 * 1000 / (1 - 0.3**2)  # [N/m] of a spring, as in the packings


def softgrain(place):
    program = next(iter(sorted((ROOT / "build").glob("*/benchmarks/two_disks"))), None)
    if program is None:
        raise CodeFailed("two_disks is not built: cmake --build build/bench --target two_disks")
    curves = []
    for way, cells in (("explicit", 16), ("implicit", 16), ("points", 24)):
        cpu = cpu_seconds_of([program, way, cells], place.folder, f"{way}.csv")
        columns = read_columns(place.folder / f"{way}.csv")
        curves.append(_curve(f"{way}, {cells} cells", columns["time"], columns["kinetic_energy"], columns["distance"], cpu))
    return curves


def springs(place):
    cpu = lammps.run(place, "two_disks", "two_disks.in", {"kn": STIFFNESS, "out": "two_disks.txt"})
    steps = np.loadtxt(place.folder / "two_disks.txt", comments="#", ndmin=2)
    return [_curve("linear spring", 1e-3 * steps[:, 0], steps[:, 1], steps[:, 2], cpu)]


def _curve(variant, time, kinetic, distance, cpu):
    return Curve(variant, 1, {"time": time, "kinetic/start": kinetic / kinetic[0], "distance": distance}, cpu)


TWO_DISKS = Case("two_disks", "Sulsky's two disks", TIME, (KINETIC, DISTANCE), np.array([0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2, 1.5]),
                 {"softgrain": softgrain, "lammps": springs})
