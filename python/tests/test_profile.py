"""Density and wall stress by height, against what can be counted by hand."""

import unittest

import numpy as np
from softgrain import NotRecorded, profile
from softgrain.run import Snapshot

WALLS = np.array([[0, 0, 2, 0], [0, 4, 2, 4], [0, 0, 0, 4], [2, 0, 2, 4]], float)  # bottom, top, left, right


def boxed(outlines, **more):
    position = np.concatenate(outlines)
    grain = np.repeat(np.arange(len(outlines)), [len(outline) for outline in outlines])
    particles = {"position": position, "radius": np.ones(len(position)), "grain": grain}
    return Snapshot(0, 0.0, particles, walls=WALLS, outlines={"position": position, "grain": grain}, **more)


class Density(unittest.TestCase):
    def test_a_triangle_and_a_square_fill_what_they_fill(self):
        triangle = np.array([(0, 0), (2, 0), (0, 2)], float)  # of each slab of height 1: 1.5, 0.5
        square = np.array([(1, 2.5), (2, 2.5), (2, 3.5), (1, 3.5)], float)
        found = profile.density_by_height(boxed([triangle, square]), slabs=4)
        np.testing.assert_allclose(found.height, [0.5, 1.5, 2.5, 3.5])
        np.testing.assert_allclose(2 * found.density, [1.5, 0.5, 0.5, 0.5], atol=1e-14)

    def test_an_elastic_disk_is_the_smooth_curve_through_its_nodes(self):
        angle = 2 * np.pi * np.arange(32) / 32
        disk = np.column_stack([1 + np.cos(angle), 2 + np.sin(angle)])
        none = np.empty((0, 2))
        of_grains = dict(pair=none, force=np.empty(0), position=none, normal=none, total_force=none)
        found = profile.density_by_height(boxed([disk], contacts=of_grains), slabs=8)
        level = np.linspace(-1, 1, 5)  # area of a disk below a level: y sqrt(1 - y^2) + asin y + pi/2
        exact = np.diff(level * np.sqrt(1 - level**2) + np.arcsin(level))
        np.testing.assert_allclose(found.density[2:6], exact, rtol=2e-3)
        np.testing.assert_allclose(found.density[[0, 1, 6, 7]], 0, atol=1e-14)


class Walls(unittest.TestCase):
    def test_forces_of_both_side_walls_lie_at_their_heights(self):
        outline = np.array([(0, 0), (2, 0), (2, 4), (0, 4)], float)
        contacts = {
            "pair": np.array([(0, 3), (0, 4), (0, 4), (0, 1)]),  # one grain, so walls are 1 to 4: left, right, right, bottom
            "force": np.array([3.0, 5.0, 7.0, 100.0]),
            "position": np.array([(0, 0.5), (2, 0.7), (2, 3.5), (1, 0)]),
            "normal": np.array([(-1, 0), (1, 0), (1, 0), (0, -1)], float),
            "total_force": np.array([(-3, -1), (5, -2), (7, 0.5), (0, -100)]),  # of the grain on the wall
        }
        found = profile.wall_stress_by_height(boxed([outline], contacts=contacts), slabs=2)
        np.testing.assert_allclose(found.normal, [8 / 4, 7 / 4])
        np.testing.assert_allclose(found.shear, [-3 / 4, 0.5 / 4])

    def test_a_cell_has_no_side_walls(self):
        with self.assertRaisesRegex(NotRecorded, "no box with four walls"):
            profile.wall_stress_by_height(boxed([np.eye(3)[:, :2]], cell=np.eye(2)))


if __name__ == "__main__":
    unittest.main()
