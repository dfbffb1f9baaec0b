"""Designs: points that fill a box of ranges evenly, by SciPy's quasi-Monte Carlo."""

import re

from .values import PlanError

KINDS = ("sobol", "lhs")
MOST_POINTS = 100_000


def design_points(words, ranges):
    """{key: values, one for each point} of "sobol:64" or "lhs:64", or with the seed of its scrambling "sobol:64:7".

    A Sobol sequence that is made longer keeps its first points; a Latin hypercube puts one point into each of the
    64 slices of every range. Raises PlanError, also where SciPy is missing."""
    kind, count, seed = _read(words)
    if not ranges:
        raise PlanError(f"{words} fills ranges, and there is none, as contact.friction = 0..0.5")
    try:
        from scipy.stats import qmc
    except ImportError as missing:
        raise PlanError(f"{words} needs SciPy ({missing}); on Debian: apt install python3-scipy") from missing
    sampler = {"sobol": qmc.Sobol, "lhs": qmc.LatinHypercube}[kind](d=len(ranges), seed=seed)
    places = sampler.random(count)
    return {key: tuple(span.at(place) for place in column) for (key, span), column in zip(ranges.items(), places.T)}


def _read(words):
    found = re.fullmatch(r"(\w+):(\d+)(?::(\d+))?", words)
    if not found or found[1] not in KINDS:
        raise PlanError(f"{words}: want sobol:N or lhs:N, and if you like a seed, as in sobol:64 or lhs:64:7")
    kind, count, seed = found[1], int(found[2]), int(found[3] or 0)
    if not 1 <= count <= MOST_POINTS:
        raise PlanError(f"{words}: from 1 to {MOST_POINTS} points")
    if kind == "sobol" and count & (count - 1):
        above = 1 << count.bit_length()
        raise PlanError(f"{words}: a Sobol sequence is even at powers of 2: sobol:{above // 2} or sobol:{above}")
    return kind, count, seed
