"""The table of grains against closed forms: spheres, ellipsoids, forces that balance, and the rows of runs."""

import contextlib
import csv
import io
import tempfile
import unittest
from pathlib import Path

import numpy as np
from small_runs import OUTPUT, small_run
from spheres import packing_of
from synthetic import write_run

import softgrain
from softgrain import patches
from softgrain.export import fabric, grain_table
from softgrain.export.__main__ import main as export
from softgrain.export.grains import contact_areas

SPHERES = {"experiment": {"model": "mpm", "loading": "isotropic", "dimension": 3}, "mpm": {"cells": 2},
           "sample": {"grains": 4, "packing_fraction": 0.35}, "loading": {"wall_velocity": "5 m/s", "max_strain": 0.35}}
PUSH = 3.0  # [N]


def pressed_cube():
    """Eight spheres of radius 1 on a cube; each pushes with PUSH on its three neighbours and its three walls."""
    centres = 2.0 * np.stack(np.meshgrid(*[np.arange(2)] * 3, indexing="ij"), -1).reshape(-1, 3) + 1
    snapshot = packing_of(centres, [1] * 8, (4, 4, 4), cells=4)
    pair, force, normal, place = [], [], [], []
    of_vertex = np.zeros_like(snapshot.outlines["position"])
    for a, x in enumerate(centres):
        for axis in range(3):
            for sign in (-1, 1):
                n = sign * np.eye(3)[axis]
                b = np.flatnonzero(np.linalg.norm(centres - x - 2 * n, axis=1) < 0.1)
                vertex = np.argmin(np.linalg.norm(snapshot.outlines["position"] - (x + n), axis=1) + 9 * (snapshot.outlines["grain"] != a))
                of_vertex[vertex] -= PUSH * n
                if len(b) and b[0] < a:
                    continue
                pair.append((a, b[0] if len(b) else 8 + {2: 0, 1: 2, 0: 4}[axis] + (sign > 0)))
                force.append(PUSH)
                normal.append(n)
                place.append(x + n)
    snapshot.contacts.update(pair=np.array(pair), force=np.array(force), normal=np.array(normal), position=np.array(place),
                             total_force=PUSH * np.array(normal))
    snapshot.outlines["force"] = of_vertex
    return snapshot


class Areas(unittest.TestCase):
    def test_points_all_over_a_grain_stand_for_its_whole_surface(self):
        """With edges, as soft grains bring them, and without, as rigid ones do."""
        snapshot = packing_of([(0, 0, 0)], [1], (4, 4, 4), cells=4)
        vertices, quads = len(snapshot.outlines["position"]), len(snapshot.surface["quad"])
        for edges in (2 * quads, 0):
            count = vertices + quads + edges
            number = np.arange(count)
            patch = np.where((number >= vertices) & (number < vertices + quads), number - vertices, -1)
            edge = np.where(number >= vertices + quads, number - vertices - quads, -1)
            snapshot.points.update(vertex=np.where(number < vertices, number, 0), grain=np.zeros(count, int), patch=patch, edge=edge,
                                   wall=np.zeros(count, int), pushes=np.ones(count, bool), gap=np.zeros(count), facing=np.full(count, -1))
            self.assertAlmostEqual(contact_areas(snapshot)[0] / patches.patch_areas(snapshot).sum(), 1, 12)


class Shapes(unittest.TestCase):
    def test_an_ellipsoid_is_the_affine_image_of_a_sphere(self):
        """V = 4/3 pi det A, and the gyration tensor A A^T/5, whatever the turn of the sphere's grid."""
        A = np.array([[1.3, 0.4, 0], [0, 0.8, 0.1], [0.2, 0, 0.9]])
        for map_ in np.eye(3), A:
            snapshot = packing_of([(0, 0, 0)], [1], (4, 4, 4), cells=6, turns=[3])
            snapshot.outlines["position"][:] = snapshot.outlines["position"] @ map_.T + (1, 2, 3)
            snapshot.particles["position"][:] = (1, 2, 3.1)  # a centre that is none makes no difference
            snapshot.outlines["force"] = np.zeros_like(snapshot.outlines["position"])
            snapshot.contacts.update(pair=np.empty((0, 2), int), force=np.empty(0), normal=np.empty((0, 3)), position=np.empty((0, 3)),
                                     total_force=np.empty((0, 3)))
            table = grain_table(snapshot)
            self.assertAlmostEqual(table["volume"][0] / (4 / 3 * np.pi * np.linalg.det(map_)), 1, 9)
            expected = map_ @ map_.T / 5
            for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
                self.assertAlmostEqual(table[f"gyration_{'xyz'[i]}{'xyz'[j]}"][0], expected[i, j], delta=3e-4)
        self.assertLess(table["sphericity"][0], 0.97)

    def test_a_sphere_has_sphericity_1(self):
        self.assertAlmostEqual(grain_table(pressed_cube())["sphericity"].max(), 1, 3)

    def test_a_polygon_has_its_own_moments(self):
        """A disk at rest of a small run: R^2/4, less what its polygon lacks."""
        snapshot = small_run("packing")[0]
        table, radius = grain_table(snapshot), snapshot.body_radii()
        np.testing.assert_allclose(table["volume"], np.pi * radius**2)
        np.testing.assert_allclose(table["gyration_xx"] / radius**2, 0.25, rtol=0.05)
        np.testing.assert_allclose(table["gyration_xy"] / radius**2, 0, atol=2e-3)


class Stresses(unittest.TestCase):
    def test_spheres_that_are_pressed_alike_bear_what_their_walls_do(self):
        """Sum of V_g sigma_g over the box = force of a wall over its area: 4 PUSH over 16."""
        snapshot = pressed_cube()
        table = grain_table(snapshot)
        for name in ("stress", "love_weber"):
            for pair in ("xx", "yy", "zz"):
                values = table[f"{name}_{pair}"] * table["volume"] / 64
                self.assertAlmostEqual(values.sum(), PUSH / 4, 12)
                np.testing.assert_allclose(values, values[0])
            np.testing.assert_allclose(table[f"{name}_xy"], 0, atol=1e-12)
        self.assertEqual(table["contacts"].tolist(), [6] * 8)
        np.testing.assert_allclose(fabric(snapshot), np.eye(3) / 3, atol=1e-15)

    def test_grains_of_a_run_add_up_to_its_columns(self):
        """By contacts, less what the motion has in the columns; by vertices as far as grains are at rest.

        With friction (the disks) the place of a contact with a wall, which its normal forces weigh, is not quite that of its force."""
        with tempfile.TemporaryDirectory() as folder:
            runs = {"spheres": softgrain.run_case(softgrain.Case({**SPHERES, "output": OUTPUT}), Path(folder) / "spheres"),
                    "disks": small_run("packing")}
            for name, run in runs.items():
                with self.subTest(name):
                    snapshot, series = run[-1], run.series
                    table, axes = grain_table(snapshot), ("xx", "yy", "zz")[:2 if name == "disks" else 3]
                    if name == "spheres":
                        corners = snapshot.surface["walls"].reshape(-1, 3)
                        box = np.ptp(corners, axis=0).prod()
                    else:
                        box = np.ptp(snapshot.walls[:, [0, 2]]) * np.ptp(snapshot.walls[:, [1, 3]])
                    by_contacts, by_vertices = (sum((table["volume"] * table[f"{kind}_{axis}"]).sum() for axis in axes) / box
                                                for kind in ("love_weber", "stress"))
                    columns = sum(series[f"stress_{axis}"][-1] for axis in axes)
                    self.assertGreater(columns, 0)
                    self.assertAlmostEqual((by_contacts + len(axes) * series["stress_kinetic"][-1]) / columns, 1, delta=1e-9 if name == "spheres" else 2e-4)
                    self.assertAlmostEqual(by_vertices / by_contacts, 1, delta=0.02)
                    self.assertAlmostEqual(np.trace(fabric(snapshot)), 1, 12)
                    if name == "spheres":
                        area = table["contact_area"]
                        self.assertTrue(((area > 0) & (area < table["area"]))[table["contacts"] > 0].all())


class Files(unittest.TestCase):
    def test_the_verb_writes_units(self):
        run = small_run("packing")
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            path = Path(folder) / "grains.csv"
            self.assertEqual(export([str(run.path), "--to=grains", "-o", str(path)]) or 0, 0)
            rows = list(csv.DictReader(path.read_text().splitlines()))
        self.assertEqual(list(rows[0]), ["grain", "x[m]", "y[m]", "volume[m^2]", "area[m]", "sphericity", "gyration_xx[m^2]", "gyration_yy[m^2]",
                                         "gyration_xy[m^2]", "contacts", "stress_xx[Pa]", "stress_yy[Pa]", "stress_xy[Pa]",
                                         "love_weber_xx[Pa]", "love_weber_yy[Pa]", "love_weber_xy[Pa]"])
        self.assertEqual(len(rows), 6)

    def test_bonded_grains_have_no_such_table(self):
        with tempfile.TemporaryDirectory() as folder:
            run = softgrain.open(write_run(Path(folder) / "run"))
            with self.assertRaises(softgrain.NotRecorded):
                grain_table(run[-1])


if __name__ == "__main__":
    unittest.main()
