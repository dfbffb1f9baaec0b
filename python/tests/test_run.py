"""The reader, against files written here with csv text and h5py."""

import re
import tempfile
import unittest
from pathlib import Path

import numpy as np
import synthetic

import softgrain


class Reading(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "squeeze"

    def test_a_run_knows_its_case_its_provenance_and_its_name(self):
        run = softgrain.open(synthetic.write_run(self.folder))
        self.assertEqual(run.name, "squeeze")
        self.assertEqual(run.case["bpm"]["attraction"], 100)
        self.assertEqual(run.info["program"]["version"], "9.8.7")

    def test_columns_are_found_by_name_and_their_units_beside_them(self):
        synthetic.write_run(self.folder, snapshots=0)
        text = "step,strain,stress_top[Pa],odd[N/m]\n0,0,0,1\n10,0.5,2e5,nan\n"
        (self.folder / "series.csv").write_text(text)
        run = softgrain.open(self.folder)
        np.testing.assert_array_equal(run.series["stress_top"], [0, 2e5])
        np.testing.assert_array_equal(run.series["odd"], [1, np.nan])
        self.assertEqual(run.units, {"step": "", "strain": "", "stress_top": "Pa", "odd": "N/m"})

    def test_a_last_line_that_was_cut_short_is_left_out(self):
        synthetic.write_run(self.folder, snapshots=0)
        for torn in ("20,0.", "20,0.7,3", "20,0.7,"):
            (self.folder / "series.csv").write_text("step,strain,stress_top[Pa]\n0,0,0\n10,0.5,2e5\n" + torn)
            self.assertEqual(softgrain.open(self.folder).series["strain"].tolist(), [0, 0.5])

    def test_whatever_happened_to_a_series_it_is_read_whole_or_refused(self):
        synthetic.write_run(self.folder, snapshots=0)
        series = self.folder / "series.csv"
        whole, random = series.read_bytes()[:3000], np.random.default_rng(2)
        refused = 0
        for _ in range(300):
            damaged, at, length = bytearray(whole), random.integers(len(whole)), random.integers(1, 30)
            match random.integers(4):
                case 0: damaged[at] ^= 1 << random.integers(8)
                case 1: del damaged[at:at + length]
                case 2: damaged[at:at] = whole[length:3 * length]
                case 3: damaged[at:at + length] = random.bytes(length)
            series.write_bytes(damaged)
            try:
                table = softgrain.open(self.folder).series
                self.assertEqual(len({len(column) for column in table.values()}), 1)
            except ValueError:
                refused += 1
        self.assertGreater(refused, 30)

    def test_what_is_printed_of_a_run_and_of_a_snapshot_fits_on_a_line(self):
        run = softgrain.open(synthetic.write_run(self.folder))
        self.assertIn("225 rows, 7 snapshots", repr(run))
        self.assertIn("<Snapshot of step 22400, 0.224 s; particles: position, pressure, radius (109); contacts:", repr(run[-1]))
        self.assertLess(len(repr(run[-1])), 200)

    def test_the_times_of_snapshots_are_those_in_them(self):
        run = softgrain.open(synthetic.write_run(self.folder))
        np.testing.assert_array_equal(run.times, [snapshot.time for snapshot in run])

    def test_a_run_that_has_only_begun_is_empty_but_readable(self):
        self.folder.mkdir()
        (self.folder / "case.toml").write_text("")
        run = softgrain.open(self.folder)
        self.assertEqual((len(run), run.series, run.info), (0, {}, {}))
        (self.folder / "series.csv").write_text("step,strain\n")
        self.assertEqual(softgrain.open(self.folder).series, {})

    def test_contacts_of_elastic_grains_join_the_centres_of_grains(self):
        run = softgrain.open(synthetic.write_run(self.folder))
        bonded = run[-1]
        self.assertFalse(bonded.contacts_of_grains)
        self.assertIs(bonded.bodies(), bonded.particles["position"])
        points = dict(position=np.array([[0, 0], [3, 0], [3, 3], [10, 10.0]]), radius=np.array([1, 2, 1, 1.0]),
                      grain=np.array([0, 0, 0, 1]))
        contacts = dict(pair=np.array([[0, 1]]), force=np.array([5.0]), position=np.array([[5, 5.0]]))
        elastic = softgrain.Snapshot(step=0, time=0, particles=points, contacts=contacts)
        np.testing.assert_allclose(elastic.bodies(), [[2.5, 0.5], [10, 10]])

    def test_snapshots_come_in_the_order_of_their_steps_with_all_their_fields(self):
        run = softgrain.open(synthetic.write_run(self.folder, fields=("pressure", "coordination")))
        self.assertEqual(len(run), 7)
        steps = [run[i].step for i in range(len(run))]
        self.assertEqual(steps, sorted(steps))
        last = run[-1]
        self.assertAlmostEqual(last.time, 1e-5 * last.step)
        self.assertEqual(last.particles["position"].shape[1], 2)
        self.assertEqual(last.particles["radius"].ndim, 1)  # one column is a scalar
        self.assertIn("coordination", last.particles)
        self.assertEqual(len(last.contacts["pair"]), len(last.contacts["force"]))
        self.assertEqual(last.walls.shape, (2, 4))

    def test_a_directory_that_is_no_run_and_a_file_that_is_no_snapshot_are_refused(self):
        with self.assertRaisesRegex(softgrain.NotARun, "case.toml"):
            softgrain.open(self.folder)
        run = softgrain.open(synthetic.write_run(self.folder))
        run.snapshots[0].write_bytes(b"not HDF5")
        with self.assertRaises(OSError):
            run[0]


class Package(unittest.TestCase):
    def test_its_version_is_that_of_the_program(self):
        project = (Path(__file__).resolve().parents[2] / "CMakeLists.txt").read_text()
        self.assertEqual(softgrain.__version__, re.search(r"project\(softgrain\s+VERSION ([\d.]+)", project)[1])

    def test_it_offers_all_it_has_for_completion(self):
        self.assertLessEqual({"Simulation", "Grain", "Case", "open", "__version__", "set_threads"}, set(dir(softgrain)))


if __name__ == "__main__":
    unittest.main()
