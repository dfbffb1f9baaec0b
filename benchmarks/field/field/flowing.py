"""Cases 7 and 8: spheres that flow, against the mechanically derived rule (MDR), LAMMPS' law for them.

The rule gives the force of a contact from its overlap, the sphere's flow, and how its other contacts confine it."""

import csv
from dataclasses import dataclass

import numpy as np

from . import lammps, softgrain
from .case import Case, Column, Curve
from .one_grain import reference
from .packings import coordination
from .work import write_rows

DENSITY, MODULUS, NU = 1000.0, 10e6, 0.3  # [kg/m^3], [Pa], of both cases
CONFINEMENT = 0.5  # psi_b, from which confinement on the rule's grain answers as a bulk: the value of LAMMPS' examples
SPEED_OF_SPHERE, LAST_APPROACH = 0.05, 0.36  # [m/s] of each wall; d/R
SPEED_OF_BOX, LAST_PHI = 0.2, 0.983  # [m/s] of each wall
RADIUS = 1e-3  # [m] of case 7


@dataclass(frozen=True)
class Spheres:
    """Places in a box with its middle at 0."""

    centre: np.ndarray  # (n, 3) [m]
    radius: np.ndarray  # (n,) [m]
    side: np.ndarray  # (3,) [m]


def write_spheres(path, spheres):
    write_rows(path, ("x[m]", "y[m]", "z[m]", "radius[m]", "side[m]"),
               [[f"{v:.9g}" for v in (*c, r, spheres.side[0])] for c, r in zip(spheres.centre, spheres.radius)])


def read_spheres(path):
    with path.open(newline="") as file:
        rows = np.array([[float(word) for word in row] for row in list(csv.reader(file))[1:]])
    return Spheres(rows[:, :3], rows[:, 3], np.full(3, rows[0, 4]))


def mdr(place, name, spheres, yield_stress, speed, travel, rows=200):
    """LAMMPS' run: (travel of a wall [m], forces on the six walls (rows, 6) [N], pairs in contact of each row, CPU time [s]).

    `speed` (3,): of each wall inwards [m/s]; `travel`: how far those along z come [m]."""
    place.folder.mkdir(parents=True, exist_ok=True)
    lines = ["grains", "", f"{len(spheres.radius)} atoms", "1 atom types", ""]
    lines += [f"{-s / 2:.12g} {s / 2:.12g} {axis}lo {axis}hi" for s, axis in zip(spheres.side, "xyz")]
    lines += ["", "Atoms", ""]
    lines += [f"{i + 1} 1 {2 * r:.12g} {DENSITY:g} {x:.12g} {y:.12g} {z:.12g}"
              for i, ((x, y, z), r) in enumerate(zip(spheres.centre, spheres.radius))]
    (place.folder / f"{name}.data").write_text("\n".join(lines) + "\n")
    smallest = spheres.radius.min()
    bulk = MODULUS / (3 * (1 - 2 * NU)) * smallest  # [N/m]
    step = 0.02 * np.sqrt(DENSITY * 4 / 3 * np.pi * smallest**3 / bulk)  # a quarter of what the manual begins with
    duration = travel / speed[2]
    every = max(1, round(duration / step / rows))
    half = dict(zip(("half_x", "half_y", "half_z"), spheres.side / 2))
    cpu = lammps.run(place, name, "mdr.in", {
        "start": f"{name}.data", "out": name, "steps": every * rows, "every": every, "dt": f"{duration / every / rows:.10g}", **half,
        "v_x": speed[0], "v_y": speed[1], "v_z": speed[2], "modulus": MODULUS, "nu": NU, "yield_stress": yield_stress,
        "psi_b": CONFINEMENT, "skin": smallest})
    table = lammps.table(place.folder / f"{name}.txt")[1:]
    return table[:, 0], np.abs(table[:, 1:7]), lammps.read_pairs(place.folder / f"{name}.pairs")[1:], cpu


SHARES = (100, 20)  # E/Y of case 7


def softgrain_sphere(place):
    curves = []
    for share in SHARES:
        series, case, cpu = softgrain.run(place, f"share{share}", {"mpm.yield_stress": MODULUS / share})
        force = (series["force_bottom"] + series["force_top"]) / 2
        approach = (series["wall_height"][0] - series["wall_height"]) / 2
        curves.append(softgrain.curve(f"E/Y = {share}", 1, _reduced(approach, force, share, case["grain"]["radius"]), "d/R", cpu))
    return curves


def mdr_sphere(place):
    alone = Spheres(np.zeros((1, 3)), np.array([RADIUS]), np.array([4, 4, 2]) * RADIUS)
    curves = []
    for share in SHARES:
        travel, force, _, cpu = mdr(place, f"share{share}", alone, MODULUS / share, (0, 0, SPEED_OF_SPHERE), LAST_APPROACH * RADIUS)
        curves.append(Curve(f"E/Y = {share}", 1, _reduced(travel, force[:, 4:].mean(axis=1), share, RADIUS), cpu))
    return curves


def _reduced(approach, force, share, radius):
    return {"d/R": approach / radius, "F/(Y R^2)": force / (MODULUS / share * radius**2)}


YIELD_STRESS = MODULUS / 20  # of case 8


def softgrain_powder(place):
    import softgrain as package

    curves = []
    for seed in range(1, place.samples + 1):
        name = f"seed{seed}"
        series, _, cpu = softgrain.run(place, name, {"sample.seed": seed})
        kept = place.decks / f"start_seed{seed}.csv"
        if not kept.exists():
            first = package.open_run(place.folder / name)[0]
            side = series["wall_height"][0]
            write_spheres(kept, Spheres(first.bodies() - side / 2, first.body_radii(), np.full(3, side)))
        pressure = (series["stress_bottom"] + series["stress_top"] + 4 * series["stress_side"]) / 6
        curves.append(softgrain.curve("E/Y = 20", seed, {"phi_0": series["phi_0"], "p/Y": pressure / YIELD_STRESS, "z": series["z"]},
                                      "phi_0", cpu))
    return curves


def mdr_powder(place):
    curves = []
    for seed in range(1, place.samples + 1):
        spheres = read_spheres(place.decks / f"start_seed{seed}.csv")
        volume = 4 / 3 * np.pi * (spheres.radius**3).sum()
        last = (volume / LAST_PHI) ** (1 / 3)
        travel, force, pairs, cpu = mdr(place, f"seed{seed}", spheres, YIELD_STRESS, (SPEED_OF_BOX,) * 3, (spheres.side[2] - last) / 2)
        side = spheres.side[2] - 2 * travel
        z = [coordination(len(spheres.radius), some)[0] for some in pairs]
        curves.append(Curve("E/Y = 20", seed, {"phi_0": volume / side**3, "p/Y": force.mean(axis=1) / side**2 / YIELD_STRESS,
                                              "z": np.array(z)}, cpu))
    return curves


METAL_SPHERE = Case(
    "metal_sphere", "One sphere that flows between walls", Column("d/R", "-", "approach to a wall d/R"),
    (Column("F/(Y R^2)", "-", "force $F/(Y R^2)$"),), np.array([0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]),
    {"reference": reference, "softgrain": softgrain_sphere, "lammps": mdr_sphere})
POWDER = Case(
    "powder", "64 spheres that flow in a box", Column("phi_0", "-", r"packing fraction $\Phi_0$"),
    (Column("p/Y", "-", "pressure $p/Y$"), Column("z", "-", "$Z$")), np.array([0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.88, 0.9, 0.92, 0.94, 0.96, 0.98]),
    {"softgrain": softgrain_powder, "lammps": mdr_powder})
