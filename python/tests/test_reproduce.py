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

from softgrain import Snapshot
from softgrain.reproduce import __main__ as command, causes, curves, execute, geometry, page, plan, results, single_grain, verdict, verdicts


def curve_of(z=None, stress=None, last=0.36):
    """A compaction sampled evenly, Phi = 0.7 e^eps."""
    strain = np.linspace(0, last, 300)
    phi = 0.7 * np.exp(strain)
    zeros = np.zeros_like(strain)
    z = zeros if z is None else z(phi)
    stress = zeros if stress is None else stress(strain)
    return curves.Compaction(strain, phi, 0.97 * phi, stress, stress, stress, z, z, z)


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

    def test_an_exponent_from_another_packing_fraction_over_another_range_is_found_again(self):
        law = curves.coordination_law(curve_of(lambda phi: 3 + 4 * np.maximum(phi - 0.84, 0) ** 0.5), phi_c=0.84, last=0.92)
        self.assertAlmostEqual(law.exponent, 0.5, delta=0.01)

    def test_one_wrong_value_at_the_start_hardly_moves_an_exponent(self):
        def z(phi):
            values = 3 + 4 * np.maximum(phi - 0.8, 0) ** 0.5
            values[np.argmax(phi >= 0.8)] += 0.3
            return values
        self.assertAlmostEqual(curves.coordination_law(curve_of(z)).exponent, 0.5, delta=0.05)

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


class Bands(unittest.TestCase):
    def test_a_band_spans_its_curves_and_its_line_is_their_mean(self):
        three = [curve_of(stress=lambda e, k=k: k * e) for k in (1, 2, 6)]
        one = curves.band(three, lambda c: c.strain, lambda c: c.stress)
        for values, factor in ((one.mean, 3), (one.low, 1), (one.high, 6)):
            np.testing.assert_allclose(values, factor * one.x, atol=1e-12)

    def test_twice_the_stress_is_a_ratio_of_two_that_scaling_takes_away(self):
        soft, stiff = (curve_of(stress=lambda e, k=k: k * (1 + e)) for k in (1, 2))
        self.assertAlmostEqual(curves.ratio(stiff, soft, "stress"), 2)
        self.assertAlmostEqual(curves.ratio(stiff, soft, "stress", scaled=True), 1)
        self.assertAlmostEqual(curves.difference(stiff, soft, "stress"), 1.24, delta=0.05)


def ring(x, y, radius, vertices=64):
    angle = 2 * np.pi * np.arange(vertices) / vertices
    return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])


class Neighbours(unittest.TestCase):
    """Five disks of radius 1 in a row, gaps 0, 0.1, 0.2, 0.3."""

    centres = np.array([0, 2, 4.1, 6.3, 8.6])

    def snapshot(self, contacts):
        outlines = [ring(x, 0, 1) for x in self.centres]
        grain = np.repeat(np.arange(5), 64)
        return Snapshot(0, 0.0, {"position": np.column_stack([self.centres, 0 * self.centres]), "radius": np.ones(5),
                                 "grain": np.arange(5)}, contacts, outlines={"position": np.vstack(outlines), "grain": grain})

    def test_pairs_nearer_than_a_reach_are_counted(self):
        snapshot = self.snapshot({})
        for reach, pairs in ((0.05, 1), (0.15, 2), (0.25, 3), (0.35, 4)):
            self.assertAlmostEqual(geometry.coordination_within(snapshot, reach), 2 * pairs / 5)

    def test_grains_at_a_wall_are_left_out_and_a_pair_counts_once(self):
        pair = np.array([[0, 1], [1, 0], [1, 2], [2, 3], [3, 4], [0, 5], [4, 6]])  # 5, 6: walls
        snapshot = self.snapshot({"pair": pair, "force": np.ones(7), "position": np.zeros((7, 2)), "normal": np.ones((7, 2))})
        self.assertAlmostEqual(geometry.coordination_of_inner(snapshot), 2)


class Onsets(unittest.TestCase):
    def test_a_coordination_of_snapshots_is_followed_from_one_to_the_next(self):
        class Made:
            times = np.array([0.0, 1.0, 2.0, 3.0])
            series = {"time": times, "strain": 0.05 * times, "phi_0": 0.7 + 0.03 * times}

            def __getitem__(self, index):
                return index
        strain, phi = verdicts.onset_of(Made(), lambda k: 2.0 * k)
        self.assertAlmostEqual(strain, 0.075)
        self.assertAlmostEqual(phi, 0.745)
        self.assertIsNone(verdicts.onset_of(Made(), lambda k: 1.0))
        self.assertEqual(verdicts.onset_of(Made(), lambda k: 3.5), (0.0, 0.7))

    def test_a_tenth_of_the_mean_force_is_load(self):
        contacts = {"pair": np.array([[0, 1], [1, 2], [2, 3], [3, 5]]), "force": np.array([100.0, 100.0, 1.0, 1000.0]),
                    "position": np.zeros((4, 2)), "normal": np.ones((4, 2))}
        self.assertAlmostEqual(geometry.coordination_of_load(Neighbours().snapshot(contacts)), 2 * 2 / 5)


class Plans(unittest.TestCase):
    def test_every_scale_compares_both_models_on_the_same_samples(self):
        for scale in plan.SCALES.values():
            runs = {run.name: run for run in plan.planned_runs(plan.FIGURES, scale)}
            for seed in scale.seeds[plan.FAST, "bpm", 0.0]:
                sample = {tuple((key, runs[plan.packing_name(plan.FAST, model, mu, seed)].values[key])
                                for key in ("sample.grains", "sample.seed"))
                          for model in plan.MODELS for mu in plan.FRICTIONS}
                self.assertEqual(len(sample), 1)

    def test_seeds_speed_and_values_are_taken(self):
        scale = plan.SCALES["quick"].with_seeds(4)
        runs = plan.planned_runs(("fig2",), scale, "1 m/s", {"contact.wall_friction": "0.1"})
        fast = [run for run in runs if run.packing == (plan.FAST, "mpm", 0.5)]
        self.assertEqual([run.values["sample.seed"] for run in fast], [1, 2, 3, 4])
        self.assertEqual({run.values["loading.wall_velocity"] for run in fast}, {"1 m/s"})
        self.assertEqual({run.values["contact.wall_friction"] for run in runs}, {"0.1"})

    def test_quick_packings_have_sixty_grains_and_take_a_minute_on_two_cores(self):
        """By the program's own estimate, of which figures and start take five seconds and the last run of one core as many."""
        runs = plan.planned_runs(plan.FIGURES, plan.SCALES["quick"])
        self.assertGreaterEqual(min(run.values["sample.grains"] for run in runs if run.packing), 60)
        program, seconds, total = os.environ["SOFTGRAIN_PROGRAM"], {}, 0
        with tempfile.TemporaryDirectory() as folder:
            for template in {run.template for run in runs}:
                subprocess.run([program, "new", f"{folder}/{template}", "--template", template], check=True, stdout=subprocess.DEVNULL)
            for run in runs:  # the estimate knows neither samples nor friction
                kind = run.template, *(item for item in run.values.items() if item[0] not in ("sample.seed", "contact.friction"))
                if kind not in seconds:
                    words = [program, "check", "--json", f"{folder}/{run.template}/case.toml", *run.command_values]
                    told = subprocess.run(words, capture_output=True, check=True)
                    seconds[kind] = 3600 * json.loads(told.stdout)["estimate"]["hours"]
                total += seconds[kind]
        self.assertLess(total, 2 * 50, seconds)

    def test_what_shows_a_cause_is_tried_at_every_scale(self):
        for scale in plan.SCALES.values():
            self.assertIn((2, 0.3), scale.attractions)  # yields at sigma_I
            self.assertLessEqual(set(scale.attractions), set(plan.ATTRACTIONS))

    def test_a_slow_bonded_run_ends_where_its_exponent_does_and_asks_for_no_stress(self):
        slow = next(run for run in plan.planned_runs(("fig4",), plan.SCALES["quick"]) if run.packing == (plan.SLOW, "bpm", 0.0))
        self.assertGreater(slow.values["loading.max_packing_fraction"], 1)
        self.assertEqual(slow.values["loading.max_stress"], 0)  # else it would be doubtful

    def test_a_run_tells_the_commands_that_make_it(self):
        run = plan.PlannedRun("one", "compaction-mpm", {"time.step": "5 us"})
        self.assertEqual(run.words, "softgrain new one --template compaction-mpm && softgrain run one/case.toml -o out/one "
                                    "--set 'time.step=5 us'")

    def test_a_value_without_a_key_is_refused(self):
        self.assertEqual(command.values_of(["a.b=c=d"]), {"a.b": "c=d"})
        with self.assertRaisesRegex(ValueError, "takes KEY=VALUE"):
            command.values_of(["a.b"])


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
        spread = verdict.Spread.of([1.0, None, 3.0])
        self.assertEqual((spread.mean, spread.deviation, spread.count), (2, 1, 2))
        self.assertEqual(spread.text(1), "2.0 ± 1.0")
        self.assertEqual(verdict.Spread.of([1.5]).text(1), "1.5")

    def test_phi_that_follows_the_strain_agrees_and_a_wrong_one_does_not(self):
        good = {(plan.FAST, m, f): [curve_of(z=lambda phi: 30 * (phi - 0.7), stress=lambda e: 1e5 * (1 + e))]
                for m in plan.MODELS for f in plan.FRICTIONS}
        self.assertTrue(verdicts._packing_fraction(results.Results({}, good)).agrees)
        wrong = curve_of()
        object.__setattr__(wrong, "phi", 1.01 * wrong.phi)
        bad = {**good, (plan.FAST, "mpm", 0.0): [wrong]}
        self.assertFalse(verdicts._packing_fraction(results.Results({}, bad)).agrees)

    def test_the_first_change_that_makes_it_agree_is_the_cause_and_none_is_open(self):
        wrong, right = (verdict.Changed(cause, words, agrees, f"run {words}") for cause, words, agrees in
                        ((causes.SLOW_WALL, "slow", False), (causes.CONTACT_RULE, "nodes", True)))
        found = verdict.judge("3", "s", "0", False, [wrong, right])
        self.assertEqual((found.cause, found.shown, found.run), (causes.CONTACT_RULE, "nodes", "run nodes"))
        self.assertEqual(verdict.judge("3", "s", "0", False, [wrong]).cause, causes.OPEN)
        self.assertEqual(verdict.judge("3", "s", "0", True, [right]).cause, causes.AS_STATED)

    def test_jamming_is_put_down_to_the_contact_rule_where_that_rule_jams_early(self):
        late, early = (curve_of(z=lambda phi, at=at: 3 * (phi >= at)) for at in (0.82, 0.76))
        made = results.Results({}, {(plan.FAST, "mpm", 0.0): [late], (plan.EARLY, "mpm", 0.0): [early]})
        self.assertEqual(verdicts._jamming(made, "mpm", 0.0).cause, causes.CONTACT_RULE)
        made.packings[plan.EARLY, "mpm", 0.0] = [late]
        self.assertEqual(verdicts._jamming(made, "mpm", 0.0).cause, causes.OPEN)

    def test_an_exponent_of_a_slow_wall_is_its_cause(self):
        fast, slow = (curve_of(z=lambda phi, e=e: 3 + 4 * np.maximum(phi - 0.8, 0) ** e) for e in (1.0, 0.5))
        made = results.Results({}, {(plan.FAST, "mpm", 0.0): [fast], (plan.SLOW, "mpm", 0.0): [slow]})
        found = next(v for v in verdicts._power_law(made) if v.statement.startswith("MPM, mu = 0:"))
        self.assertEqual((found.agrees, found.cause), (False, causes.SLOW_WALL))

    def test_causes_are_counted(self):
        found = [verdict.Verdict("1", "a", "", True), verdict.Verdict("1", "b", "", True), verdict.Verdict("1", "c", "", False, causes.OPEN)]
        self.assertEqual(causes.headline(found), "3 statements: 2 agree as stated; 1 open")

    def test_verdicts_are_written_for_people_and_for_machines(self):
        with tempfile.TemporaryDirectory() as folder:
            found = [verdict.Verdict("3", "Z reaches 5.5", "5.4", True),
                     verdict.Verdict("3", "jams", "late", False, causes.SLOW_WALL, "0.08", "softgrain run x")]
            verdict.write(found, results.Results(), Path(folder), "quick", "softgrain 0")
            self.assertEqual(json.loads((Path(folder) / "verdicts.json").read_text())[0]["ours"], "5.4")
            words = (Path(folder) / "verdicts.md").read_text()
            self.assertIn("| 3 | Z reaches 5.5 | 5.4 | agrees |", words)
            self.assertIn("| differs | **agrees with a slow wall**: 0.08 | (1) |", words)
            self.assertIn("1. `softgrain run x`", words)

    def test_the_page_holds_its_pictures_and_asks_for_nothing_else(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "fig1.png"
            picture.write_bytes(b"\x89PNG not really")
            found = [verdict.Verdict("1", "a < b", "5.4", False, causes.OPEN, "tried", "softgrain run x")]
            words = page.write(found, [picture], folder, {"program": "softgrain 0"}).read_text()
            self.assertIn("data:image/png;base64,iVBORyBub3QgcmVhbGx5", words)
            self.assertIn("a &lt; b", words)
            self.assertNotIn("http", words)
            self.assertNotIn("<script", words)


if __name__ == "__main__":
    unittest.main()
