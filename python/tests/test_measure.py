"""The numbers read off a stress-strain curve, against curves whose numbers are known beforehand."""

import tempfile
import unittest

import numpy as np
import synthetic

import softgrain
from softgrain import measure


class Curves(unittest.TestCase):
    def test_a_strain_path_falls_into_its_branches(self):
        strain = [0, 1, 2, 1.5, 1, 1.5, 2, 3, 4]
        found = [(b.kind, strain[b.first], strain[b.last]) for b in measure.branches(strain)]
        expected = [("loading", 0, 2), ("unloading", 2, 1), ("reloading", 1, 2), ("loading", 2, 4)]
        self.assertEqual(found, expected)
        self.assertEqual(measure.branches([0.0]), [])

    def test_walls_that_keep_a_stress_and_stray_do_not_unload(self):
        rise, drive = np.linspace(0, 0.1, 50, endpoint=False), np.linspace(0.105, 0.2, 50)
        kept = np.concatenate([np.linspace(0.1, 0.115, 10), 0.112 - 0.003 * np.cos(np.arange(60)), [0.108, 0.104]])
        strain = np.concatenate([rise, kept, drive])
        stress = np.concatenate([1e6 * rise, 1e5 * (1 + 0.02 * np.sin(7 * np.arange(kept.size))), 1e6 * drive])
        leg = np.repeat([0.0, 1.0, 2.0], [rise.size, kept.size, drive.size])
        series = {"strain": strain, "leg": leg, "stress_top": stress}
        direction = measure.directions(series)
        kinds = [b.kind for b in measure.branches(strain, direction)]
        self.assertEqual(kinds, ["loading", "hold", "reloading", "loading"])
        self.assertEqual(measure.unloadings(strain, stress, direction), [])

    def test_waves_of_the_walls_unload_once_a_period(self):
        strain = np.concatenate([np.linspace(0, 0.1, 50, endpoint=False), 0.1 + 0.01 * np.sin(np.linspace(0, 6 * np.pi, 300))])
        leg = np.repeat([0.0, 1.0], [50, 300])
        series = {"strain": strain, "leg": leg, "stress_top": 1e6 * np.maximum(strain - 0.08, 0)}
        kinds = [b.kind for b in measure.branches(strain, measure.directions(series))]
        self.assertEqual(kinds, ["loading", "unloading", "reloading", "unloading", "reloading", "unloading", "reloading"])

    def test_a_path_turns_where_it_goes_back_by_more_than_its_noise(self):
        self.assertEqual(measure.turns([0, 1, 2, 1.9, 3, 1, 1.1, 0, 0.05], 0.5).tolist(), [0, 4, 7, 8])
        self.assertEqual(measure.turns([0, 0.1, 0], 0.5).tolist(), [0, 2])

    def test_the_envelope_visits_each_strain_once(self):
        strain, stress = measure.envelope([0, 1, 2, 1, 2, 3], [0, 5, 6, 0, 9, 7])
        self.assertEqual((strain.tolist(), stress.tolist()), ([0, 1, 2, 3], [0, 5, 6, 7]))

    def test_the_moving_mean_averages_over_one_percent_of_strain_however_it_is_sampled(self):
        generator = np.random.default_rng(1)
        strain = np.sort(generator.uniform(0, 0.1, 300))
        stress = generator.normal(size=300)
        mean = measure.moving_mean(strain, stress, 0.01)
        for i in np.flatnonzero(strain > strain[0] + 0.005):
            inside = abs(strain - strain[i]) <= 0.005
            self.assertAlmostEqual(mean[i], stress[inside].mean())
        self.assertEqual(mean[0], stress[0])

    def test_the_plateau_leaves_out_the_elastic_rise_and_the_unloading(self):
        strain = synthetic.strain_path()
        flat = measure.plateau(strain, synthetic.stress_path(strain))
        self.assertAlmostEqual(flat.mean, synthetic.PLATEAU)
        self.assertAlmostEqual(flat.deviation, 0, places=6)
        self.assertAlmostEqual(flat.strain_range[1], 0.2)
        self.assertIsNone(measure.plateau([0, 0.01, 0.02], [0, 1, 2]))

    def test_an_unloading_has_the_slope_it_was_made_with(self):
        strain = synthetic.strain_path()
        (unloading,) = measure.unloadings(strain, synthetic.stress_path(strain))
        self.assertAlmostEqual(unloading.reversal, 0.1)
        self.assertAlmostEqual(unloading.end, 0.088)
        self.assertAlmostEqual(unloading.slope / synthetic.UNLOADING_STIFFNESS, 1)


class Grain(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.run_with = lambda **k: softgrain.open(synthetic.write_run(temporary.name + "/run", **k))

    def test_the_papers_numbers_give_the_papers_characteristic_stress(self):
        self.assertAlmostEqual(measure.characteristic_stress(self.run_with()), 0.5e6)  # 100 N/m over 0.2 mm

    def test_the_characteristic_stress_of_the_series_comes_first(self):
        run = self.run_with(snapshots=0)
        self.assertIsNone(measure.characteristic_stress(run))
        run.series["sigma_I"] = np.array([0.46e6, 0.46e6])
        self.assertEqual(measure.characteristic_stress(run), 0.46e6)

    def test_equal_forces_in_a_triangular_lattice_give_its_pressure(self):
        position, pair = synthetic.hexagonal_grain()
        particles = {"position": position, "radius": np.full(len(position), synthetic.RADIUS)}
        contacts = {"pair": pair, "force": np.full(len(pair), 3.0)}
        pressure = measure.contact_pressure(softgrain.Snapshot(0, 0.0, particles, contacts))
        centre = np.argmin(np.hypot(*position.T))
        # The lattice as a whole bears sqrt(3)/2 f/a; its disks fill the share pi/sqrt(12) of its area.
        lattice = np.sqrt(3) / 2 * 3.0 / synthetic.RADIUS
        self.assertAlmostEqual(pressure[centre] * np.pi / np.sqrt(12), lattice)
        self.assertIsNone(measure.contact_pressure(softgrain.Snapshot(0, 0.0, particles)))


if __name__ == "__main__":
    unittest.main()
