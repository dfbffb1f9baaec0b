"""The unit in which pictures give stresses: of hydrogels kPa, of metals MPa."""

from typing import NamedTuple

import numpy as np


class StressUnit(NamedTuple):
    name: str
    pascal: float  # what one of it is

    def text(self, stress) -> str:
        """Of a stress [Pa], with three decimals."""
        return f"{stress / self.pascal + 0:.3f} {self.name}"


UNITS = StressUnit("MPa", 1e6), StressUnit("kPa", 1e3), StressUnit("Pa", 1.0)
LEAST = 0.01  # of a unit: curves that stay below it are drawn in the next smaller one


def unit_for(*stresses) -> StressUnit:
    """One unit for all of these stresses [Pa]: MPa where the largest is 10 kPa or more, kPa down to 10 Pa."""
    largest = max((float(np.nanmax(np.abs(some), initial=0)) for some in map(np.asarray, stresses)), default=0)
    return next((unit for unit in UNITS if largest >= LEAST * unit.pascal), UNITS[0] if largest == 0 else UNITS[-1])
