"""The laws of points that `experiments/hydrogels` compares with, against what they say of one sphere and of few."""

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "experiments" / "hydrogels"))

import laws  # noqa: E402

NU = 0.45
HERTZ = 4 / 3 / (1 - NU**2)  # of a sphere of radius 1 and modulus 1 on a wall, over d^1.5


def force_on_one(several):
    """One sphere between two walls, whose centre comes nearer to each by 0.1."""
    packing = laws.Packing(np.array([[5.0, 5.0, 1.0]]), np.ones(1), [10, 10, 2], NU)
    packing.press(1.8)
    return packing.relax(several)[0]


class OneSphere(unittest.TestCase):
    def test_between_two_walls_obeys_hertz(self):
        self.assertAlmostEqual(force_on_one(several=False), HERTZ * 0.1**1.5, 9)

    def test_each_of_two_contacts_is_pushed_out_by_the_other_as_on_a_half_space(self):
        """On the axis of its force a half-space moves by (1 + nu) (3 - 2 nu) F/(2 pi E d): Boussinesq. d is 1.8 here."""
        force = force_on_one(several=True)
        pushed = laws.GEOMETRIC_FACTOR * (1 + NU) * (3 - 2 * NU) * force / (2 * np.pi * 1.8)
        self.assertAlmostEqual(force / (HERTZ * (0.1 + pushed) ** 1.5), 1, 3)


class SomeSpheres(unittest.TestCase):
    def test_a_column_bears_the_same_force_all_along(self):
        """Three spheres on each other between walls: Hertz at 2 walls and 2 pairs, of which each is as soft as 2^(1/3)^2 walls."""
        packing = laws.Packing(np.array([[2.0, 2.0, z] for z in (1.0, 3.0, 5.0)]), np.ones(3), [4, 4, 6], NU)
        packing.press(5.4)
        force, left = packing.relax(several=False)
        self.assertLess(left, 1e-4)
        wall = (force / HERTZ) ** (2 / 3)
        pair = (force / (HERTZ / 2 * np.sqrt(0.5))) ** (2 / 3)
        self.assertAlmostEqual(2 * wall + 2 * pair, 0.6, 4)


if __name__ == "__main__":
    unittest.main()
