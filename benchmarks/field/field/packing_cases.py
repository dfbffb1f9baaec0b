"""Cases 3, 4 and 5: packings in a periodic cell."""

from dataclasses import dataclass, field

import numpy as np

from . import lammps, softgrain, yade
from .case import Case, Column
from .packings import read_start, start_of_run, write_start

PHI = Column("phi_0", "-", r"packing fraction $\Phi_0$")
Z = Column("z_no_rattlers", "-", "$Z$ without rattlers")
PRESSURE = Column("p/E*", "-", "pressure $p/E^*$")
VERTICAL = Column("stress_yy/E*", "-", r"stress $\sigma_{yy}/E^*$")
MODULUS = 10e6 / (1 - 0.45**2)  # [Pa] E* of cases 3 and 4
SOFT_MODULUS = 1e6 / (1 - 0.49**2)  # of case 5
SPRING = 0.317  # k_n of two disks over E*: the force of finite elements at an overlap of 0.1 R
RIGID = 20  # k_n of two rigid disks in codes of springs, over that of soft ones; of a soft and a rigid one 2


@dataclass(frozen=True)
class Variant:
    """A packing: the values that softgrain changes in the case's deck, and what codes of springs take instead."""

    name: str
    values: dict
    friction: float
    springs: dict = field(default_factory=lambda: {(1, 1): SPRING})  # {(kind, kind): k_n over E*}; {}: none can stand for it
    start: str = "start"  # of the file with the places

    @property
    def folder(self):
        return self.name.replace(" ", "").replace("=", "").replace(",", "_").replace("%", "_percent_")


@dataclass(frozen=True)
class Loading:
    """What codes of springs do to the cell, as softgrain's deck says it."""

    modulus: float  # [Pa] E*
    density: float  # [kg/m^3]
    velocity: float  # [m/s] at which opposite ends come together
    last: float  # Phi_0 at the end
    isotropic: bool


def scaled(columns, modulus):
    """With pressure and stress over E*."""
    return columns | {"p/E*": (columns["stress_xx"] + columns["stress_yy"]) / 2 / modulus, "stress_yy/E*": columns["stress_yy"] / modulus}


def ours(variants, loading):
    """Measures softgrain; the places where a sample starts are kept for the other codes."""

    def measure(place):
        curves = []
        for variant in variants:
            for seed in range(1, place.samples + 1):
                name = f"{variant.folder}_seed{seed}"
                series, _, cpu = softgrain.run(place, name, {**variant.values, "sample.seed": seed})
                kept = place.decks / f"{variant.start}_seed{seed}.csv"
                if not kept.exists():
                    write_start(kept, start_of_run(place.folder / name))
                curves.append(softgrain.curve(variant.name, seed, scaled(series, loading.modulus), "phi_0", cpu))
        return curves

    return measure


def springs(code, variants, loading):
    """Measures a code of springs, from the same places."""

    def measure(place):
        curves = []
        for variant in variants:
            if not variant.springs or (code is yade and len(set(variant.springs.values())) > 1):
                continue
            for seed in range(1, place.samples + 1):
                start = read_start(place.decks / f"{variant.start}_seed{seed}.csv")
                strain = np.log(loading.last * start.width * start.height / (np.pi * (start.radius**2).sum()))
                strains = (strain / 2, strain / 2) if loading.isotropic else (0, strain)
                duration = start.height * -np.expm1(-strains[1]) / loading.velocity
                stiffness = {pair: share * loading.modulus for pair, share in variant.springs.items()}
                columns, cpu, _ = code.packing(place, f"{variant.folder}_seed{seed}", start, stiffness, variant.friction,
                                               loading.density, strains, duration)
                curves.append(softgrain.curve(variant.name, seed, scaled(columns, loading.modulus), "phi_0", cpu))
        return curves

    return measure


def codes(variants, loading):
    return {"softgrain": ours(variants, loading), "lammps": springs(lammps, variants, loading), "yade": springs(yade, variants, loading)}


JAMMING = Case(
    "jamming", "Isotropic jamming of 300 disks", PHI, (Z, PRESSURE), np.array([0.82, 0.84, 0.85, 0.86, 0.87, 0.88, 0.89, 0.9, 0.91]),
    codes([Variant(f"mu = {mu:g}", {"contact.friction": mu}, mu) for mu in (0.0, 0.3)],
          Loading(MODULUS, 990, 0.05, 0.915, True)))

COMPACTION = Case(
    "compaction", "Uniaxial compaction of 300 disks, elastic and plastic", PHI, (Z, VERTICAL),
    np.array([0.82, 0.84, 0.86, 0.88, 0.9, 0.92, 0.94]),
    codes([Variant(f"{kind}, mu = {mu:g}", {"contact.friction": mu, "mpm.law": law}, mu, {(1, 1): SPRING} if kind == "elastic" else {})
           for mu in (0.3, 0.0) for kind, law in (("elastic", "neo_hookean"), ("plastic", "von_mises"))],
          Loading(MODULUS, 990, 0.1, 0.95, False)))


def _mixture(percent, values):
    mixed, rigid = (2 * SPRING, RIGID * SPRING) if percent else (SPRING, SPRING)
    kinds = {(1, 1): SPRING, (1, 2): mixed, (2, 2): rigid}
    return Variant(f"{percent} % rigid", values, 0.3, kinds, f"start_{percent}_percent_rigid")


MIXTURE = Case(
    "mixture", "Soft disks among rigid ones", PHI, (Z, PRESSURE), np.array([0.82, 0.84, 0.86, 0.88, 0.9, 0.91]),
    codes([_mixture(0, {"kind.rigid.model": "mpm"}), _mixture(20, {"kind.rigid.share": 0.25}), _mixture(50, {"kind.rigid.share": 1})],
          Loading(SOFT_MODULUS, 1100, 0.02, 0.915, True)))
