"""Parameters from curves whose parameters are known: closed forms first, then runs of the program."""

import contextlib
import importlib.util
import io
import json
import os
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import softgrain
from softgrain.compare import MeasuredCurve, read_measured, run_curve

if importlib.util.find_spec("scipy") is None:
    raise unittest.SkipTest("SciPy is not here, so no fit was tried: tools/install_dependencies.sh --with fit")

from softgrain.fit import FitError, Problem, estimate
from softgrain.fit.__main__ import main
from softgrain.fit.estimate import correlation_of
from softgrain.fit.report import findings

OUTPUT = "[output]\nreport = false\nvtk = false\nsnapshots = 1\n"
CASES = {
    "elastic": "[experiment]\nmodel = 'mpm'\n[mpm]\ncells = 4\n[loading]\nmax_strain = 0.1\nunload_at = []\n",
    "plastic": "[experiment]\nmodel = 'mpm'\n[mpm]\ncells = 4\nlaw = 'von_mises'\nyield_stress = '0.3 MPa'\n"
               "[loading]\nmax_strain = 0.1\nunload_at = []\n",
    "bonded": "[bpm]\nprimaries = 40\n[loading]\nmax_strain = 0.1\nwall_velocity = '1 m/s'\nunload_at = []\n",
}
FREE = (-np.inf, np.inf)
E, NU, YIELD = "mpm.young_modulus", "mpm.poisson_ratio", "mpm.yield_stress"


class Estimates(unittest.TestCase):
    """y = p_1 g_1(t) + p_2 g_2(t) with x = ln p, p_start = 1: no simulation."""

    t = np.linspace(0, 1, 60)

    def fit(self, shapes, truth, seed, noise=0.02):
        measured = truth @ shapes + noise * np.random.default_rng(seed).standard_normal(len(self.t))
        bounds = np.full(len(truth), -np.inf), np.full(len(truth), np.inf)
        return estimate(lambda x: np.exp(x) @ shapes - measured, lambda x: (np.exp(x)[:, None] * shapes).T, bounds)

    def test_the_intervals_hold_the_truth_as_often_as_they_say(self):
        """400 fits of two parameters: 95 % within three standard errors of counting, and a bit for what is not linear."""
        shapes, truth = np.array([self.t, self.t**2]), np.array([2.0, 0.5])
        found = [self.fit(shapes, truth, seed) for seed in range(400)]
        inside = np.mean([abs(e.x - np.log(truth)) <= e.half_widths for e in found], axis=0)
        self.assertTrue((abs(inside - 0.95) < 0.035).all(), inside)
        self.assertAlmostEqual(np.mean([e.noise for e in found]), 0.02, delta=0.0005)

    def test_the_half_width_of_one_parameter_is_that_of_the_textbook(self):
        """y = p t: the standard error of ln p is noise/(p sqrt(sum t^2))."""
        found = self.fit(self.t[None], np.array([3.0]), 1)
        expected = found.noise / (np.exp(found.x[0]) * np.sqrt((self.t**2).sum()))
        self.assertAlmostEqual(found.half_widths[0] / found.quantile, expected * np.sqrt(found.correlation), places=6)
        self.assertAlmostEqual(found.quantile, 2.001, delta=0.01)  # Student's t of 59
        self.assertTrue(found.determined[0] and found.converged)

    def test_of_two_parameters_that_act_as_their_product_only_the_product_is_determined(self):
        """y = p_1 p_2 t."""
        measured = 6 * self.t + 0.02 * np.random.default_rng(3).standard_normal(60)
        found = estimate(lambda x: np.exp(x.sum()) * self.t - measured, lambda x: np.exp(x.sum()) * np.column_stack([self.t, self.t]),
                         (np.full(2, -5), np.full(2, 5)))
        self.assertFalse(found.determined.any())
        np.testing.assert_allclose(abs(found.directions[0]), np.sqrt([0.5, 0.5]), atol=1e-6)
        self.assertLess(found.direction_half_widths[0], 0.02)
        self.assertLess(found.half_width_of([1, 1]), 0.02)
        self.assertGreater(found.direction_half_widths[1], 10)
        self.assertAlmostEqual(found.x.sum(), np.log(6), delta=found.half_width_of([1, 1]))

    def test_a_parameter_at_its_bound_is_not_determined(self):
        found = estimate(lambda x: np.exp(x) * self.t - 3 * self.t, lambda x: (np.exp(x) * self.t)[:, None], ([-1], [0.5]))
        self.assertTrue(found.at_bound[0])
        self.assertFalse(found.determined[0])

    def test_residuals_that_follow_one_another_count_less(self):
        """An autoregressive series r_k = a r_(k-1) + noise has the integrated autocorrelation (1 + a)/(1 - a)."""
        rng = np.random.default_rng(5)
        white = rng.standard_normal(4000)
        self.assertAlmostEqual(correlation_of(white), 1, delta=0.2)
        follow = np.zeros(4000)
        for k in range(1, 4000):
            follow[k] = 0.8 * follow[k - 1] + white[k]
        self.assertAlmostEqual(correlation_of(follow), 9, delta=2)


class Temporary(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def case(self, name):
        path = self.folder / f"{name}.toml"
        path.write_text(CASES[name] + OUTPUT)
        return softgrain.Case(path)

    def curve(self, name, points=60, noise=0.02, seed=0):
        """Of a run of the case as it stands, with noise of a share of the largest stress."""
        run = softgrain.run_case(self.case(name).set("output.samples", 600), self.folder / f"truth_{name}", threads=1, resume=True)
        strain, values = run_curve(run)
        at = np.linspace(strain[0], strain[-1], points)
        values = np.interp(at, strain, values)
        return MeasuredCurve("stress", at, values + noise * values.max() * np.random.default_rng(seed).standard_normal(points))

    def fit(self, case, curve, free, **options):
        problem = Problem(case, curve, free, self.folder / "fit", 2, 100, **options)
        found = estimate(problem.residuals, problem.jacobian, problem.bounds)
        return problem, found, findings(problem, found)

    def csv(self, curve):
        path = self.folder / "measured.csv"
        path.write_text("strain,stress[Pa]\n" + "".join(f"{a:.9g},{b:.9g}\n" for a, b in zip(curve.strain, curve.values)))
        return path

    def call(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main([*map(str, words)])
        return code, out.getvalue(), err.getvalue()


class Grains(Temporary):
    def test_without_noise_the_modulus_comes_back(self):
        _, _, told = self.fit(self.case("elastic").set(E, 4e6), self.curve("elastic", noise=0), [E])
        self.assertAlmostEqual(told["parameters"][E]["value"] / 1e7, 1, delta=2e-3)

    def test_with_noise_the_modulus_lies_in_its_interval(self):
        for seed in (1, 2, 3) if "SOFTGRAIN_TORTURE" in os.environ else (1,):
            _, _, told = self.fit(self.case("elastic").set(E, 6e6), self.curve("elastic", seed=seed), [E])
            entry = told["parameters"][E]
            self.assertTrue(entry["low"] <= 1e7 <= entry["high"], entry)
            self.assertLess(entry["high"] / entry["low"], 1.04)
            self.assertTrue(entry["determined"])
            self.assertAlmostEqual(told["residual"], 0.02, delta=0.006)

    def test_of_modulus_and_poisson_ratio_their_plane_strain_modulus_alone_is_told(self):
        """A grain between walls is Hertz's: its curve depends on E/(1 - nu^2)."""
        case = self.case("elastic").set(E, 7e6).set(NU, 0.3)
        problem, found, told = self.fit(case, self.curve("elastic", seed=4), [E, NU])
        for key in (E, NU):
            self.assertIsNone(told["parameters"][key]["value"])
        plane = told["plane_modulus"]
        self.assertTrue(plane["determined"])
        self.assertTrue(plane["low"] <= 1e7 / (1 - 0.45**2) <= plane["high"], plane)
        self.assertGreater(found.direction_half_widths[1], 10 * found.direction_half_widths[0])
        hertz = np.array([1, 2 * 0.45**2 / (1 - 0.45**2)])
        self.assertGreater(abs(found.directions[0] @ hertz) / np.linalg.norm(hertz), 0.95)

    def test_a_grain_that_flows_tells_its_yield_stress_and_modulus(self):
        case = self.case("plastic").set(E, 7e6).set(YIELD, 2e5)
        _, _, told = self.fit(case, self.curve("plastic", seed=5), [E, YIELD])
        for key, truth in ((E, 1e7), (YIELD, 3e5)):
            entry = told["parameters"][key]
            self.assertTrue(entry["low"] <= truth <= entry["high"], (key, entry))

    def test_a_serrated_bonded_grain_of_another_sample_is_known_as_well_as_its_interval_says(self):
        curve = self.curve("bonded")
        case = self.case("bonded").set("sample.seed", 11).set("bpm.attraction", 70.0)
        problem, _, told = self.fit(case, curve, ["bpm.attraction"], seeds=2)
        entry = told["parameters"]["bpm.attraction"]
        self.assertTrue(entry["low"] <= 100 <= entry["high"], entry)
        self.assertGreater(entry["high"] / entry["low"], 1.1)  # a serrated curve is no good measurement, and it does not pretend
        self.assertEqual({run.case["sample"]["seed"] for run in problem.runs.values()}, {11, 12})

    def test_runs_that_are_done_are_not_made_again(self):
        curve, case = self.curve("elastic"), self.case("elastic").set(E, 9e6)
        first, found, _ = self.fit(case, curve, [E])
        second, again, _ = self.fit(case, curve, [E])
        self.assertGreater(first.runs_made, 3)
        self.assertEqual(second.runs_made, 0)
        self.assertEqual(found.x.tolist(), again.x.tolist())


class Program(Temporary):
    def test_it_writes_a_page_its_numbers_and_a_figure(self):
        self.case("elastic")
        measured = self.csv(self.curve("elastic"))
        words = (self.folder / "elastic.toml", measured, f"--free={E}", f"--set={E}=8e6", "-o", self.folder / "out", "-j2")
        code, out, err = self.call(*words)
        self.assertEqual(code, 0, err)
        told = json.loads((self.folder / "out" / "fit.json").read_text())
        self.assertIn(f"{told['parameters'][E]['value']:.5g}", out)
        self.assertIn(told["points"], (59, 60))  # rounding may carry the last beyond the run
        page = (self.folder / "out" / "fit.md").read_text()
        self.assertIn(f"softgrain fit {self.folder}/elastic.toml", page)
        self.assertIn(out.splitlines()[1], page)
        self.assertTrue((self.folder / "out" / "fit.png").stat().st_size > 10_000)

    def test_what_is_not_determined_has_no_value_and_the_exit_code_is_5(self):
        self.case("elastic")
        measured = self.csv(self.curve("elastic", seed=4))
        code, out, _ = self.call(self.folder / "elastic.toml", measured, f"--free={E}", f"--free={NU}", f"--set={E}=7e6",
                                 f"--set={NU}=0.3", "-j2", "-o", self.folder / "out")
        self.assertEqual(code, 5)
        line = next(line for line in out.splitlines() if line.startswith(NU))
        self.assertIn(" - ", line)
        self.assertIn("not determined", line)
        self.assertIn("E/(1 - nu^2)", out)
        self.assertIn("fix one of them", out)

    def test_mistakes_end_with_2_and_name_the_key(self):
        case = self.folder / "elastic.toml"
        self.case("elastic")
        measured = self.csv(MeasuredCurve("stress", np.linspace(0, 0.1, 20), np.linspace(0, 1e5, 20)))
        for words, expected in (((f"--free={YIELD}",), "must be above 0"), (("--free=mpm.youngs_modulus",), "no such key"),
                                (("--free=mpm.cells",), "not a number that can vary"), (("--free=bpm.exponent",), "no effect"),
                                ((f"--free={E}", "--set=mpm.young=1"), "young"), ((f"--free={E}", "--set=mpm"), "KEY=VALUE"),
                                ((f"--free={E}", "--most-runs=1"), "--most-runs")):
            code, _, err = self.call(case, measured, *words, "-o", self.folder / "out")
            self.assertEqual(code, 2, words)
            self.assertIn(expected, err)
        beyond = self.csv(MeasuredCurve("stress", np.linspace(0.5, 0.8, 20), np.linspace(0, 1e5, 20)))
        code, _, err = self.call(case, beyond, f"--free={E}", "-o", self.folder / "out")
        self.assertEqual(code, 2)
        self.assertIn("more points than parameters", err)

    def test_the_curve_of_a_file_is_that_of_memory(self):
        curve = self.curve("elastic")
        np.testing.assert_allclose(read_measured(self.csv(curve)).values, curve.values, rtol=1e-8)


if __name__ == "__main__":
    unittest.main()
