"""What is read off the curves of a reproduction, against curves whose numbers are known beforehand."""

import contextlib
import io
import json
import os
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

from softgrain.reproduce import curves, execute, plan, single_grain, verdicts


def curve_of(z=None, stress=None, last=0.36):
    """A compaction sampled evenly, Phi = 0.7 e^eps."""
    strain = np.linspace(0, last, 300)
    phi = 0.7 * np.exp(strain)
    zeros = np.zeros_like(strain)
    z = zeros if z is None else z(phi)
    stress = zeros if stress is None else stress(strain)
    return curves.Compaction(strain, phi, 0.97 * phi, stress, stress, stress, z)


class Compactions(unittest.TestCase):
    def test_the_exponent_of_a_power_law_is_found_again(self):
        for exponent in (0.5, 1.0, 1.3):
            law = curves.coordination_law(curve_of(lambda phi, e=exponent: 3 + 4 * np.maximum(phi - 0.8, 0) ** e))
            self.assertAlmostEqual(law.exponent, exponent, delta=0.02)
            self.assertLess(law.half_width, 0.05)
            self.assertAlmostEqual(law.z0, 3, delta=0.05)

    def test_noise_widens_the_interval_of_the_exponent_and_it_holds_the_truth(self):
        noise = np.random.default_rng(3)
        held = 0
        for _ in range(40):
            rough = np.interp(np.arange(300), np.arange(0, 300, 15), noise.normal(scale=0.1, size=20))
            law = curves.coordination_law(curve_of(lambda phi: 3 + 4 * np.maximum(phi - 0.8, 0) ** 0.5 + rough))
            held += abs(law.exponent - 0.5) < law.half_width
            self.assertGreater(law.half_width, 0.02)
        self.assertGreater(held, 25)

    def test_a_coordination_that_never_rises_has_no_exponent(self):
        self.assertIsNone(curves.coordination_law(curve_of()))

    def test_a_line_has_no_curvature_and_a_parabola_a_quarter(self):
        start = np.log(0.8 / 0.7)
        self.assertAlmostEqual(curves.curvature(curve_of(stress=lambda e: 1 + 5 * (e - start))), 0, delta=1e-6)
        parabola = curve_of(stress=lambda e: np.maximum(e - start, 0) ** 2)
        self.assertAlmostEqual(curves.curvature(parabola), 0.25, delta=0.01)

    def test_the_reference_state_is_where_phi_is_eight_tenths(self):
        curve = curve_of(stress=lambda e: 1e5 * e)
        self.assertAlmostEqual(curve.reference_stress, 1e5 * np.log(0.8 / 0.7), delta=1)
        self.assertAlmostEqual(float(np.interp(0.8, curve.phi, curve.strain_from_reference)), 0, delta=1e-9)

    def test_the_onset_is_where_z_first_reaches_three(self):
        strain, phi = curves.onset(curve_of(z=lambda phi: 30 * (phi - 0.7)))
        self.assertAlmostEqual(phi, 0.8, delta=0.002)
        self.assertAlmostEqual(strain, np.log(0.8 / 0.7), delta=0.002)
        self.assertIsNone(curves.onset(curve_of()))


class SingleGrains(unittest.TestCase):
    def test_johnsons_force_satisfies_his_equation(self):
        for d in (0.005, 0.02, 0.05):
            x = single_grain.johnson_force(d)
            self.assertAlmostEqual(x / np.pi * (np.log(4 * np.pi / x) - 1), d, delta=1e-6)

    def test_the_papers_equation_is_73_percent_stiffer_than_johnsons_at_one_percent(self):
        strain = -np.log1p(-0.01)
        self.assertAlmostEqual(single_grain.paper_force(strain) / single_grain.johnson_force(0.01), 1.73, delta=0.02)

    def test_the_slope_ratio_of_a_line_is_one_and_of_a_softening_curve_lower(self):
        strain = np.linspace(0, 0.4, 200)
        self.assertAlmostEqual(single_grain.slope_ratio(strain, 3 * strain), 1, delta=1e-9)
        self.assertLess(single_grain.slope_ratio(strain, np.sqrt(strain)), 0.8)

    def test_a_curve_leaves_its_line_where_it_falls_below(self):
        strain = np.linspace(0, 0.1, 2001)
        bent = np.minimum(strain, 0.02 + 0 * strain)
        self.assertAlmostEqual(single_grain.linear_strain(strain, bent, drop=0.1), 0.02 / 0.9, delta=2e-3)


class Plans(unittest.TestCase):
    def test_every_scale_compares_both_models_on_the_same_samples(self):
        for scale in plan.SCALES.values():
            runs = {run.name: run for run in plan.planned_runs(plan.FIGURES, scale)}
            for seed in scale.seeds:
                sample = {tuple((key, runs[plan.packing_name(model, mu, seed)].values[key])
                                for key in ("sample.grains", "sample.seed"))
                          for model in plan.MODELS for mu in plan.FRICTIONS}
                self.assertEqual(len(sample), 1)
        self.assertEqual(len(plan.planned_runs(plan.FIGURES, plan.SCALES["paper"])), 7)


# Waits for a signal if friction = 9, as a program does that stops after its step; fails if it is 7.
STAND_IN = """#!/bin/sh
echo "$@" >> FOLDER/calls
if [ $1 = new ]; then mkdir -p $2; touch $2/case.toml; exit; fi
mkdir -p $4
case "$*" in *friction=7*) echo broken >&2; exit 3;; esac
echo '{"state": "running"}' > $4/run.json
case "$*" in *friction=9*)
  trap 'echo stopped > $4/stopped; exit 75' TERM
  while :; do sleep 0.02; done;;
esac
echo '{"state": "done"}' > $4/run.json
"""


class Runs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.program = self.folder / "program"
        self.program.write_text(STAND_IN.replace("FOLDER", str(self.folder)))
        self.program.chmod(stat.S_IRWXU)

    def execute(self, name, friction):
        run = plan.PlannedRun(name, "compaction-mpm", {"contact.friction": friction})
        with contextlib.redirect_stderr(io.StringIO()):
            execute.execute([run], self.folder / "runs", str(self.program), 2)

    def runs(self):
        return [line for line in (self.folder / "calls").read_text().splitlines() if line.startswith("run ")]

    def test_a_run_is_not_made_again_unless_its_values_changed(self):
        for friction in (0, 0, 1, 1):
            self.execute("one", friction)
        self.assertEqual(len(self.runs()), 2)
        self.assertIn("--force --set=contact.friction=1", self.runs()[-1])

    def test_a_run_that_was_stopped_is_gone_on_with(self):
        self.execute("one", 0)
        (self.folder / "runs/one/run.json").write_text('{"state": "stopped"}')
        self.execute("one", 0)
        self.assertIn("--resume --set=contact.friction=0", self.runs()[-1])

    def test_a_failure_is_told(self):
        with self.assertRaises(execute.RunFailed) as failure:
            self.execute("one", 7)
        self.assertEqual((failure.exception.code, str(failure.exception)), (3, "one: broken"))

    def test_a_signal_ends_the_runs_and_no_figure_is_drawn(self):
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[1]),
                       "SOFTGRAIN_PROGRAM": str(self.program)}
        runs = ("from softgrain.reproduce import __main__ as main, plan\n"
                "main.planned_runs = lambda *_: [plan.PlannedRun(name, 't', {'contact.friction': 9}) for name in 'abc']\n"
                f"raise SystemExit(main.main(['-o', {str(self.folder)!r}, '-j2']))")
        process = subprocess.Popen([sys.executable, "-c", runs], env=environment, stderr=subprocess.PIPE, text=True)
        folder = self.folder / "runs"
        for _ in range(1000):
            if (folder / "a/run.json").exists() and (folder / "b/run.json").exists():
                break
            time.sleep(0.01)
        time.sleep(0.1)  # until the traps are set
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 75)
        self.assertIn("the same command goes on", said)
        self.assertEqual(sorted(path.parent.name for path in folder.glob("*/stopped")), ["a", "b"])
        self.assertEqual(len(self.runs()), 2)  # c never began


class Verdicts(unittest.TestCase):
    def test_a_spread_is_mean_and_deviation_and_leaves_out_what_was_not_found(self):
        spread = verdicts.Spread.of([1.0, None, 3.0])
        self.assertEqual((spread.mean, spread.deviation, spread.count), (2, 1, 2))
        self.assertEqual(spread.text(1), "2.0 ± 1.0")
        self.assertEqual(verdicts.Spread.of([1.5]).text(1), "1.5")

    def test_phi_that_follows_the_strain_agrees_and_a_wrong_one_does_not(self):
        good = {key: [curve_of(z=lambda phi: 30 * (phi - 0.7), stress=lambda e: 1e5 * (1 + e))]
                for key in ((m, f) for m in plan.MODELS for f in plan.FRICTIONS)}
        first = next(verdicts._coordination(verdicts.Results({}, good)))
        self.assertTrue(first.agrees)
        wrong = curve_of()
        object.__setattr__(wrong, "phi", 1.01 * wrong.phi)
        bad = {**good, ("mpm", 0.0): [wrong]}
        self.assertFalse(next(verdicts._coordination(verdicts.Results({}, bad))).agrees)

    def test_verdicts_are_written_for_people_and_for_machines(self):
        with tempfile.TemporaryDirectory() as folder:
            found = [verdicts.Verdict("3", "Z reaches 5.5", "5.4", True)]
            verdicts.write(found, verdicts.Results({}, {}), Path(folder), "quick", "softgrain 0")
            self.assertEqual(json.loads((Path(folder) / "verdicts.json").read_text())[0]["ours"], "5.4")
            self.assertIn("| 3 | Z reaches 5.5 | 5.4 | agrees |", (Path(folder) / "verdicts.md").read_text())


if __name__ == "__main__":
    unittest.main()
