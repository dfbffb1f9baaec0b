"""LIGGGHTS' runs: grains are points with a law of their overlap; `multicontact` lets contacts of a grain feel each other."""

import numpy as np

from .case import Curve
from .work import cpu_seconds_of, first_line_of

PROGRAM = "liggghts"
MODULUS, STEPS = 1e7, 4000  # of the deck: E* [Pa], steps
# d/R at the end; with multicontact forces jump from 0.3 on
LAST = {"default": 0.36, "multicontact": 0.26}


def version():
    return first_line_of([PROGRAM, "-h"], "Version").partition("(Version ")[2].partition(",")[0]


def sphere(place):
    curves = []
    for variant, surface in (("Hertz", "default"), ("Hertz, multicontact", "multicontact")):
        cpu = cpu_seconds_of([PROGRAM, "-screen", "none", "-log", f"{surface}.liggghts.log", "-in",
                              place.decks.parent / "liggghts" / "two_spheres.in", "-var", "surface", surface, "-var", "multicontact",
                              int(surface == "multicontact"), "-var", "last", LAST[surface], "-var", "out", f"{surface}.txt"], place.folder, f"{surface}.log")
        step, force = np.loadtxt(place.folder / f"{surface}.txt", comments="#").T
        approach = step / STEPS * LAST[surface]
        curves.append(Curve(variant, 1, {"d/R": approach, "F/(E* R^2)": np.abs(force) / MODULUS}, cpu))
    return curves
