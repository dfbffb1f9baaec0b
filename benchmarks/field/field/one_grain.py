"""Case 1: one elastic disk between walls. Case 6, one elastic sphere, is measured in the same way."""

import csv

import numpy as np

from . import lammps, liggghts, softgrain, yade
from .case import Case, Column, Curve

APPROACH = Column("d/R", "-", "approach to a wall d/R")
GRID = {2: np.array([0.01, 0.02, 0.05, 0.1, 0.2, 0.3]), 3: np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35])}
LARGEST = 0.36  # d/R of the codes of points


def reference(place):
    """The converged finite elements of reference.csv."""
    with open(place.decks / "reference.csv", newline="") as file:
        rows = list(csv.reader(file))
    force = rows[0][3].partition("[")[0]
    laws = list(dict.fromkeys(row[0] for row in rows[1:]))
    return [Curve(law, 0, {"d/R": np.array([float(row[2]) for row in rows[1:] if row[0] == law]),
                           force: np.array([float(row[3]) for row in rows[1:] if row[0] == law])}) for law in laws]


def softgrain_disk(place):
    curves = []
    for law in ("neo_hookean", "small_strain_hooke"):
        series, case, cpu = softgrain.run(place, law, {"mpm.law": law})
        curves.append(softgrain.curve(law, 1, _reduced(series, case, 1), "d/R", cpu))
    return curves


def softgrain_sphere(place):
    series, case, cpu = softgrain.run(place, "neo_hookean", {})
    return [softgrain.curve("neo_hookean", 1, _reduced(series, case, 2), "d/R", cpu)]


def _reduced(series, case, power):
    mpm, radius = case["mpm"], case["grain"]["radius"]
    modulus = mpm["young_modulus"] / (1 - mpm["poisson_ratio"] ** 2)
    name = "F/(E* R)" if power == 1 else "F/(E* R^2)"
    return {"d/R": (series["wall_height"][0] - series["wall_height"]) / (2 * radius),
            name: (series["force_bottom"] + series["force_top"]) / 2 / (modulus * radius**power)}


def lammps_disk(place):
    """A spring as stiff as Johnson's line contact at d/R = 0.05: F = 0.63 E* d for a wall, half of it for two disks."""
    cpu = lammps.run(place, "spring", "two_grains.in", {"law": "hooke", "stiffness": 0.6296 / 2, "radius": 1, "depth": 2 * LARGEST, "out": "spring.txt"})
    overlap, force = lammps.table(place.folder / "spring.txt")[1:].T  # before the first step there is no pair
    return [Curve("linear spring", 1, {"d/R": overlap / 2, "F/(E* R)": force}, cpu)]


def lammps_sphere(place):
    """Hertz's law of two spheres with E* = 1: LAMMPS' prefactor of sqrt(R_eff) delta^(3/2) is 4/3 E*/2."""
    cpu = lammps.run(place, "hertz", "two_grains.in", {"law": "hertz", "stiffness": 2 / 3, "radius": 1, "depth": 2 * LARGEST, "out": "hertz.txt"})
    overlap, force = lammps.table(place.folder / "hertz.txt")[1:].T
    return [Curve("Hertz", 1, {"d/R": overlap / 2, "F/(E* R^2)": force}, cpu)]


ONE_GRAIN = Case("one_grain", "One elastic disk between walls", APPROACH, (Column("F/(E* R)", "-", "force $F/(E^* R)$"),), GRID[2],
                 {"reference": reference, "softgrain": softgrain_disk, "lammps": lammps_disk})
SPHERE = Case("sphere", "One elastic sphere between walls", APPROACH, (Column("F/(E* R^2)", "-", "force $F/(E^* R^2)$"),), GRID[3],
              {"reference": reference, "softgrain": softgrain_sphere, "lammps": lammps_sphere, "yade": yade.sphere,
               "liggghts": liggghts.sphere})
