"""YADE's runs: grains are spheres with a law of their overlap."""

import numpy as np

from .case import Curve
from .packings import coordination, write_start
from .work import cpu_seconds_of, first_line_of

PROGRAM = "yade"
STEPS_PER_CONTACT = 20


def version():
    return first_line_of([PROGRAM, "--version"], "ersion").rpartition(" ")[2]


def run(place, name, deck, variables):
    """CPU time [s] of a script of ../yade."""
    return cpu_seconds_of([PROGRAM, "-n", "-x", "-j", "1", place.decks.parent / "yade" / deck], place.folder, f"{name}.log",
                          {key: str(value) for key, value in variables.items()})


def sphere(place):
    from .one_grain import LARGEST

    cpu = run(place, "hertz", "two_spheres.py", {"OUT": place.folder / "hertz.txt", "DEPTH": 2 * LARGEST})
    overlap, force = np.loadtxt(place.folder / "hertz.txt").T
    return [Curve("Hertz", 1, {"d/R": overlap / 2, "F/(E* R^2)": force}, cpu)]


def packing(place, name, start, stiffness, friction, density, strains, duration, rows=200):
    """As lammps.packing, for one kind of grains; damping is YADE's own, 0.2 of the forces."""
    place.folder.mkdir(parents=True, exist_ok=True)
    write_start(place.folder / f"{name}.csv", start)
    (kn,) = set(stiffness.values())
    lightest = density * np.pi * start.radius.min() ** 2 / 2
    every = max(1, round(duration / (np.pi * np.sqrt(lightest / kn) / STEPS_PER_CONTACT) / rows))
    steps = every * rows
    cpu = run(place, name, "packing.py", {
        "START": place.folder / f"{name}.csv", "OUT": place.folder / name, "STEPS": steps, "EVERY": every, "DT": duration / steps,
        "KN": kn, "FRICTION": friction, "DENSITY": density, "RATE_X": strains[0] / duration, "RATE_Y": strains[1] / duration})
    width, height, xx, yy, kinetic = np.loadtxt(place.folder / f"{name}.txt").T
    frames = [np.array([pair.split(",") for pair in line.split()], int).reshape(-1, 2)
              for line in (place.folder / f"{name}.pairs").read_text().splitlines()]
    z = np.array([coordination(len(start.x), pairs) for pairs in frames])
    area = np.pi * (start.radius**2).sum()
    return {"phi_0": area / (width * height), "strain": np.log(start.height / height), "stress_xx": xx, "stress_yy": yy,
            "z": z[:, 0], "z_no_rattlers": z[:, 1], "kinetic_energy": kinetic}, cpu, steps
