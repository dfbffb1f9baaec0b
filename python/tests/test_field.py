"""The benchmark set of soft grains: what it counts, what its tables and its page hold."""

import csv
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

FIELD = Path(__file__).resolve().parents[2] / "benchmarks/field"
sys.path.insert(0, str(FIELD))

from field import flowing, lammps, one_grain, packings, page  # noqa: E402
from field.case import Case, Column, Curve, mean_curve  # noqa: E402
from field.cases import CASES  # noqa: E402
from field.work import Place  # noqa: E402


class Counting(unittest.TestCase):
    def test_rattlers_leave_one_after_the_other(self):
        triangle, tail = [(0, 1), (1, 2), (2, 0)], [(2, 3), (3, 4)]  # 4 hangs on 3, which hangs on 2 then; 5 is alone
        z, held = packings.coordination(6, np.array(triangle + tail))
        self.assertAlmostEqual(z, 2 * 5 / 6)
        self.assertEqual(held, 2)
        self.assertEqual(packings.coordination(3, np.empty((0, 2), int)), (0, 0))

    def test_means_of_samples_stand_where_all_of_them_reach(self):
        case = Case("x", "", Column("x", "-", ""), (Column("y", "Pa", ""),), np.array([0.0, 1.0, 2.0, 3.0]), {})
        lines = [Curve("v", seed, {"x": np.array([0.0, end]), "y": np.array([0.0, slope * end])})
                 for seed, slope, end in ((1, 1.0, 2.5), (2, 3.0, 4.0))]
        grid, found = mean_curve(case, lines)
        self.assertEqual(grid.tolist(), [0, 1, 2])
        np.testing.assert_allclose(found["y"], ([0, 2, 4], [0, 1, 2]))

    def test_places_come_back_as_they_were_written(self):
        rng = np.random.default_rng(1)
        start = packings.Start(*rng.uniform(0, 1, (3, 5)), np.array([1, 2, 1, 2, 1]), 1.25, 0.75)
        with tempfile.TemporaryDirectory() as folder:
            packings.write_start(Path(folder) / "s.csv", start)
            again = packings.read_start(Path(folder) / "s.csv")
        for name in ("x", "y", "radius", "kind", "width", "height"):
            np.testing.assert_allclose(getattr(again, name), getattr(start, name), rtol=1e-8)

    def test_spheres_come_back_as_they_were_written(self):
        rng = np.random.default_rng(2)
        spheres = flowing.Spheres(rng.uniform(-1, 1, (4, 3)), rng.uniform(0, 1, 4), np.full(3, 2.5))
        with tempfile.TemporaryDirectory() as folder:
            flowing.write_spheres(Path(folder) / "s.csv", spheres)
            again = flowing.read_spheres(Path(folder) / "s.csv")
        for name in ("centre", "radius", "side"):
            np.testing.assert_allclose(getattr(again, name), getattr(spheres, name), rtol=1e-8)

    def test_pairs_of_a_local_dump_belong_to_their_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "pairs"
            path.write_text("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n0\nITEM: ENTRIES a b\nITEM: TIMESTEP\n9\n"
                            "ITEM: NUMBER OF ENTRIES\n2\nITEM: ENTRIES a b\n1 2 \n3 1 \n")
            frames = lammps.read_pairs(path)
        self.assertEqual([frame.tolist() for frame in frames], [[], [[0, 1], [2, 0]]])


class Codes(unittest.TestCase):
    """Against closed forms, where the programs are here."""

    def place(self, name):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return Place(Path(folder.name), "softgrain", FIELD / name, 1)

    @unittest.skipUnless(shutil.which(lammps.PROGRAM), "LAMMPS is not here")
    def test_lammps_decks_have_the_spring_and_hertz_law_that_they_were_told(self):
        disk, ball = one_grain.lammps_disk(self.place("one_grain"))[0], one_grain.lammps_sphere(self.place("sphere"))[0]
        d = ball.values["d/R"]
        np.testing.assert_allclose(disk.values["F/(E* R)"], 0.6296 * disk.values["d/R"], rtol=1e-4)
        np.testing.assert_allclose(ball.values["F/(E* R^2)"], 4 / 3 * d**1.5, rtol=1e-3)


class Results(unittest.TestCase):
    def test_the_page_is_that_of_the_tables(self):
        self.assertEqual((FIELD / "RESULTS.md").read_text(), page.text(CASES))

    def test_every_case_has_a_deck_a_table_with_units_and_a_cost_beside_ours(self):
        cost = page.read(page.RESULTS / "cost.csv")
        for case in CASES:
            with self.subTest(case.name):
                with (page.RESULTS / f"{case.name}.csv").open(newline="") as file:
                    rows = list(csv.DictReader(file))
                self.assertEqual(tuple(rows[0]), page.header(case))
                codes = {row["code"] for row in rows}
                self.assertLessEqual(codes, set(case.codes))
                timed = {row["code"] for row in cost if row["case"] == case.name}
                self.assertLessEqual(timed, codes)
                self.assertLessEqual(codes - timed, {"reference", "softgrain"})  # jamming: rows of an earlier study
                self.assertTrue(all(row["version"] for row in rows if row["code"] != "reference"))
                self.assertIn("softgrain", codes)
                self.assertTrue(list((FIELD / case.name).glob("case.toml")) or case.name == "two_disks")

    def test_one_grain_is_within_4_percent_of_finite_elements_and_springs_are_not(self):
        rows = page.read(page.RESULTS / "one_grain.csv")

        def force(code, variant):
            return np.array([float(row["F/(E* R)[-]"]) for row in rows if (row["code"], row["variant"]) == (code, variant)])

        for law in ("neo_hookean", "small_strain_hooke"):
            self.assertLess(np.abs(force("softgrain", law) / force("reference", law) - 1).max(), 0.04)
        self.assertGreater(np.abs(force("lammps", "linear spring") / force("reference", "neo_hookean") - 1).max(), 0.5)


if __name__ == "__main__":
    unittest.main()
