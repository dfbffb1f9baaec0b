"""Set-Voronoi cells against arrangements whose cells are known, and against a surface that is known between two spheres."""

import contextlib
import csv
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from small_runs import small_run
from spheres import packing_of

import softgrain
from softgrain import patches, plot
from softgrain.voronoi import cells_of
from softgrain.voronoi.__main__ import main
from softgrain.voronoi.tessellation import Domain, tessellate

CUBE = 2.0 * np.stack(np.meshgrid(*[np.arange(2)] * 3), -1).reshape(-1, 3) + 1
FACE_CENTRED = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]]) * np.sqrt(2) + 0.3
FEW = 90  # points on a grain: one on each quad


class Surfaces(unittest.TestCase):
    def test_smooth_surfaces_have_the_volume_and_the_area_of_their_spheres(self):
        snapshot = packing_of(CUBE, np.linspace(0.5, 1, 8), (4, 4, 4), cells=6, turns=range(8))
        found = patches.measures(snapshot)
        radius = snapshot.particles["radius"]
        np.testing.assert_allclose(found.volume, 4 / 3 * np.pi * radius**3, rtol=1e-12)
        np.testing.assert_allclose(found.area, 4 * np.pi * radius**2, rtol=5e-4)
        self.assertAlmostEqual(1 / patches.fullness_of(216), 0.9995, 4)  # the same as decision 0051 says of the program

    def test_what_is_linear_in_space_keeps_volumes(self):
        """An affine map changes each volume by its determinant: the surface is linear in its vertices."""
        snapshot = packing_of([(2, 2, 2)], [1], (4, 4, 4), cells=4)
        A = np.array([[1.2, 0.3, 0], [0, 0.7, 0.2], [0.1, 0, 0.9]])
        snapshot.outlines["position"][:] = snapshot.outlines["position"] @ A.T
        snapshot.particles["position"][:] = snapshot.particles["position"] @ A.T
        np.testing.assert_allclose(patches.measures(snapshot).volume, 4 / 3 * np.pi * np.linalg.det(A), rtol=1e-12)


class InSpace(unittest.TestCase):
    def test_spheres_of_a_cube_have_cubes_between_walls_and_in_a_cell(self):
        for repeats, neighbours in ((False,) * 3, 3), ((True, True, False), 5):
            with self.subTest(repeats=repeats):
                cells = cells_of(packing_of(CUBE, [1] * 8, (4, 4, 4), repeats), FEW)
                np.testing.assert_allclose(cells.volume, 8, rtol=1e-12)
                np.testing.assert_allclose(cells.phi, np.pi / 6, rtol=1e-12)
                self.assertEqual(set(cells.neighbours), {neighbours})
                walls = cells.faces["wall"] >= 0
                np.testing.assert_allclose(cells.faces["area"][walls], 4, rtol=1e-12)
                across = np.array([2, 2, 1, 1, 0, 0])[cells.faces["wall"][walls]]
                outwards = np.column_stack([cells.faces[f"normal_{axis}"] for axis in "xyz"])[walls]
                np.testing.assert_allclose(outwards[np.arange(len(across)), across], np.where(cells.faces["wall"][walls] % 2, 1, -1))

    def test_the_densest_arrangement_fills_its_share_with_twelve_neighbours(self):
        """Of equal grids all cells are alike; of grids turned each its own way they are as far as points go."""
        side = 2 * np.sqrt(2)
        for turns, close in ([5] * 4, 1e-12), ([1, 2, 3, 4], 2e-3):
            cells = cells_of(packing_of(FACE_CENTRED, [1] * 4, (side,) * 3, (True,) * 3, turns=turns), FEW)
            np.testing.assert_allclose(cells.phi, np.pi / np.sqrt(18), rtol=close)
            self.assertEqual(set(cells.neighbours), {12})
            self.assertAlmostEqual(cells.volume.sum() / side**3, 1, 13)
            large = cells.faces["share"] > 0.01
            np.testing.assert_allclose(cells.faces["share"][large], 1 / 12, rtol=0.03)
            self.assertTrue((cells.faces["grain_b"][large] >= 0).all())

    def test_between_spheres_of_two_sizes_lies_a_hyperboloid_to_which_more_points_come_closer(self):
        """Places as far from a sphere of radius 1 as from one of 1/2 beside it: x = c + e/2 sqrt(1 + r^2/((d/2)^2 - (e/2)^2)),
        d the distance of the centres, e the difference of the radii."""
        y, weight = np.polynomial.legendre.leggauss(60)
        square = y[:, None] ** 2 + y**2
        behind = 1.75 + 0.25 * np.sqrt(1 + square / (0.75**2 - 0.25**2))
        volume = np.einsum("i,j,ij->", weight, weight, behind)
        snapshot = packing_of([(1, 1, 1), (2.5, 1, 1)], [1, 0.5], (3, 2, 2), cells=4, turns=[1, 2])
        errors = [1 - cells_of(snapshot, points).volume[0] / volume for points in (96, 4 * 96, 9 * 96)]
        self.assertLess(errors[0], 0.01)
        self.assertLess(errors[1], errors[0] / 2.5)
        self.assertLess(abs(errors[2]), 0.002)

    def test_cells_of_any_spheres_fill_their_box(self):
        generator = np.random.default_rng(3)
        centres = np.stack(np.meshgrid(*[np.arange(3)] * 3), -1).reshape(-1, 3) * 2.1 + generator.uniform(-0.2, 0.2, (27, 3)) + 1
        radii = generator.uniform(0.4, 0.75, 27)
        for repeats in (True,) * 3, (True, False, True):
            snapshot = packing_of(centres, radii, (6.3,) * 3, repeats, cells=2, turns=range(27))
            cells = cells_of(snapshot, 20)
            self.assertAlmostEqual(cells.volume.sum() / 6.3**3, 1, 13)
            inner = cells.faces["grain_b"] >= 0
            there = {(a, b): area for a, b, area in zip(*(cells.faces[name][inner] for name in ("grain_a", "grain_b", "area")))}
            for (a, b), area in there.items():  # a face has the same size from both sides
                self.assertAlmostEqual(area, there[b, a], 9)

    def test_an_open_box_is_refused(self):
        snapshot = packing_of(CUBE, [1] * 8, (4, 4, 4))
        snapshot.surface["walls"] = snapshot.surface["walls"][:2]
        with self.assertRaisesRegex(softgrain.NotRecorded, "no walls all round"):
            cells_of(snapshot)


class InThePlane(unittest.TestCase):
    def test_points_in_a_sheared_cell_have_its_hexagons(self):
        """A lattice has one cell, whatever its lattice vectors are called: these are of a hexagonal one, sheared by 2."""
        vectors = np.array([[1, 0], [2.5, np.sqrt(0.75)]])
        domain = Domain(np.zeros(2), 4 * vectors, np.array([True, True]))
        steps = np.stack(np.meshgrid(np.arange(4), np.arange(4)), -1).reshape(-1, 2)
        found = tessellate(steps @ vectors + 0.1, np.arange(16), domain, 0.5)
        np.testing.assert_allclose(found.volume, np.sqrt(0.75), rtol=1e-12)
        large = np.linalg.norm(found.faces.area, axis=1) > 1e-9
        np.testing.assert_allclose(np.linalg.norm(found.faces.area[large], axis=1), 1 / np.sqrt(3), rtol=1e-9)
        self.assertEqual(np.bincount(found.faces.a[large]).tolist(), [6] * 16)

    def test_how_far_images_reach_at_first_makes_no_difference(self):
        places = np.random.default_rng(2).random((60, 2))
        for repeats in [(False, False), (True, False), (True, True)]:
            domain = Domain(np.zeros(2), np.eye(2), np.array(repeats))
            near, far = (tessellate(places, np.arange(60), domain, reach).volume for reach in (0.01, 0.9))
            np.testing.assert_allclose(near, far, rtol=1e-9)

    def test_grains_of_a_run_have_the_fraction_that_its_rows_say(self):
        run = small_run("packing")
        for index, row in ((0, 0), (-1, -1)):
            cells = run[index].voronoi()
            self.assertAlmostEqual(cells.grain_volume.sum() / cells.volume.sum(), run.series["phi"][row], 9)

    def test_surfaces_that_overlap_do_not_reach_into_one_another(self):
        """More points change little, also where contact leaves an overlap that is wider than points are apart."""
        run = small_run("packing")
        few, many = (run[-1].voronoi(points).volume for points in (200, 3000))
        np.testing.assert_allclose(few, many, rtol=4e-3)

    def test_the_verb_writes_two_tables_and_plot_draws_histograms(self):
        run = small_run("packing")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "cells.csv"
            with contextlib.redirect_stdout(io.StringIO()) as words:
                self.assertEqual(main([str(run.path), "-o", str(path)]) or 0, 0)
            self.assertEqual(words.getvalue().split(), [str(path), str(path.with_name("cells_faces.csv"))])
            rows, faces = (list(csv.DictReader(Path(name).read_text().splitlines())) for name in words.getvalue().split())
        self.assertEqual(list(rows[0]), ["grain", "x[m]", "y[m]", "volume[m^2]", "cell_volume[m^2]", "phi", "neighbours"])
        self.assertEqual(list(faces[0]), ["grain_a", "grain_b", "wall", "area[m]", "share", "normal_x", "normal_y"])
        self.assertEqual(len(rows), 6)
        for k, row in enumerate(rows):
            around = [face for face in faces if int(face["grain_a"]) == k]
            self.assertAlmostEqual(sum(float(face["share"]) for face in around), 1, 6)
            self.assertEqual(int(row["neighbours"]), sum(int(face["wall"]) < 0 and float(face["share"]) >= 0.01 for face in around))
        with plot.style():
            left, right = plot.draw_voronoi(run).axes
        self.assertEqual(len(left.patches), len(right.lines))

    def test_without_scipy_one_is_told_how_to_get_it(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scipy.py").write_text("raise ImportError('none here')\n")
            path = os.pathsep.join([folder, str(Path(softgrain.__file__).parents[1])])
            done = subprocess.run([sys.executable, "-m", "softgrain.voronoi", str(small_run("packing").path)],
                                  env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("apt install python3-scipy", done.stderr)


if __name__ == "__main__":
    unittest.main()
