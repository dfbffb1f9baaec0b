"""Sweeps, with a stand-in for softgrain that writes a row whose numbers follow from its values."""

import os
import signal
import stat
import subprocess
import sys
import time
import unittest
from pathlib import Path

import numpy as np

from softgrain.sweep import PlanError, read_plan, scripts
from softgrain.sweep.curves import mean_curve
from stand_in import PROGRAM, Temporary


class Plans(unittest.TestCase):
    def plan(self, *varied):
        return read_plan("softgrain", "case.toml", ["solver.max_sweeps=9"], varied, "out")

    def test_every_combination_is_a_run_named_by_its_values(self):
        plan = self.plan("contact.friction=0,0.5", "sample.seed=1..3")
        self.assertEqual([run.name for run in plan.runs],
                         [f"friction_{mu}-seed_{seed}" for mu in ("0", "0.5") for seed in (1, 2, 3)])
        self.assertEqual(plan.run_command(plan.runs[4]),
                         ["softgrain", "run", "case.toml", "--set=output.vtk=false", "--set=output.report=false",
                          "--set=output.snapshots=4", "--set=solver.max_sweeps=9", "--set=contact.friction=0.5",
                          "--set=sample.seed=2", "-o", "out/runs/friction_0.5-seed_2", "--resume"])

    def test_files_that_a_run_usually_writes_come_back_by_set(self):
        plan = read_plan("softgrain", "case.toml", ["output.vtk=true"], ["output.snapshots=2,9"], "out")
        words = plan.run_command(plan.runs[0])
        self.assertEqual([word for word in words if "output" in word],
                         ["--set=output.report=false", "--set=output.vtk=true", "--set=output.snapshots=2"])

    def test_reals_are_counted_from_first_to_last_by_a_step_without_rounding(self):
        values = lambda word: next(iter(self.plan(word).varied.values()))  # noqa: E731
        self.assertEqual(values("contact.friction=0:0.5:0.1"), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"])
        self.assertEqual(values("contact.friction=0.1:0.34:0.1"), ["0.1", "0.2", "0.3"])
        self.assertEqual(values("mpm.young_modulus=1:5:2 MPa,20 MPa"), ["1 MPa", "3 MPa", "5 MPa", "20 MPa"])
        self.assertEqual(values("contact.friction=0.5:0:-0.25"), ["0.5", "0.25", "0"])
        self.assertEqual(values("contact.friction=0..0.5:6"), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"])
        self.assertEqual(values("mpm.young_modulus=1..2:4 MPa,5 MPa"), ["1 MPa", "1.33333333 MPa", "1.66666667 MPa", "2 MPa", "5 MPa"])
        self.assertEqual(values("contact.friction=1e-3..-1e-3:3"), ["0.001", "0", "-0.001"])
        for word in ("0:0.1", "0:0.5:0", "0:0.5:-0.1", "0:x:1", "0:1e9:1"):
            with self.assertRaisesRegex(PlanError, "FIRST:LAST:STEP"):
                self.plan(f"contact.friction={word}")

    def test_a_range_of_reals_with_dots_is_told_how_it_is_written(self):
        for word in ("0..0.5", "0.1..0.5", "0..0.5:1", "0..0.5:0.1", "0..1:x"):
            with self.assertRaisesRegex(PlanError, "0:0.5:0.1"):
                self.plan(f"contact.friction={word}")

    def test_quantities_and_lists_are_values_and_make_names_that_files_can_have(self):
        plan = self.plan("time.step=0.05 us,1e-7", "loading.unload_at=[0.1,0.2],[]")
        self.assertEqual(plan.varied["time.step"], ["0.05 us", "1e-7"])
        self.assertEqual(plan.varied["loading.unload_at"], ["[0.1,0.2]", "[]"])
        self.assertEqual(plan.runs[0].name, "step_0.05us-unload_at__0.1_0.2_")

    def test_a_name_that_is_too_long_for_a_directory_ends_in_a_hash(self):
        lists = ["[" + ", ".join(f"{0.001 * k + 0.0001 * last:.4f}" for k in range(60)) + "]" for last in (1, 2)]
        plan = self.plan(f"loading.unload_at={lists[0]},{lists[1]}")
        names = [run.name for run in plan.runs]
        self.assertEqual(len(set(names)), 2)
        for name in names:
            self.assertLessEqual(len(name), 200)  # of the 255 that file systems take
            self.assertTrue(name.startswith("unload_at_"))
        self.assertEqual(names, [run.name for run in self.plan(f"loading.unload_at={lists[0]},{lists[1]}").runs])

    def test_keys_of_one_ending_are_named_in_full(self):
        self.assertEqual(self.plan("solver.tolerance=1", "mpm.tolerance=2").runs[0].name,
                         "solver.tolerance_1-mpm.tolerance_2")

    def test_what_makes_no_plan_is_refused(self):
        for wrong in (["friction"], ["a.b="], ["a.b=1,,2"], ["a.b=3..1"], ["a.b=1", "a.b=2"], ["a.b=1,1"],
                      ["a.b=1..10000000"]):
            with self.subTest(wrong), self.assertRaises(PlanError):
                self.plan(*wrong)


class Sweeps(Temporary):
    def test_the_table_has_last_values_and_maxima_of_each_run(self):
        code, out, _ = self.sweep("--jobs=2")
        self.assertEqual((code, out.split()), (0, [f"{self.out}/{name}" for name in ("results.csv", "curves.csv", "sweep.png")]))
        rows = self.results()
        self.assertEqual(len(rows), 6)
        for row in rows:
            stress = 100 * float(row["contact.friction"]) + int(row["sample.seed"])
            self.assertEqual(row["state"], "done")
            self.assertEqual(float(row["stress_top_last[Pa]"]), stress)
            self.assertEqual(float(row["stress_top_max[Pa]"]), 3 * stress)

    def test_what_is_done_is_not_done_again_and_new_values_are_added(self):
        self.sweep(seeds="1..2")
        code, _, err = self.sweep(seeds="1..3")
        self.assertEqual(code, 0)
        self.assertIn("4 of 6 runs: done before", err)
        self.assertEqual([self.calls(f"friction_0-seed_{seed}") for seed in (1, 2, 3)], [1, 1, 1])

    def test_a_failed_run_stops_no_other_and_is_named(self):
        code, _, err = self.sweep("--jobs=1", frictions="7,0", seeds="1")
        self.assertEqual(code, 3)
        self.assertIn("friction_7-seed_1: failed (3): the grain has burst", err)
        self.assertIn("1 of 2 runs failed: friction_7-seed_1", err)
        self.assertEqual([row["state"] for row in self.results()], ["failed", "done"])

    def test_a_wrong_value_is_refused_before_the_first_run(self):
        code, _, err = self.sweep(frictions="0,-1")
        self.assertEqual(code, 2)
        self.assertIn("out of range", err)
        self.assertFalse(self.out.exists())

    def test_a_directory_with_runs_of_another_case_is_refused(self):
        self.sweep(frictions="0", seeds="1")
        (self.out / "runs/friction_0-seed_1/case.toml").write_text("[contact]\nfriction = 0.25\n")
        code, _, err = self.sweep(frictions="0", seeds="1")
        self.assertEqual(code, 2)
        self.assertIn("of another case", err)

    def test_the_list_numbers_the_runs_and_an_index_makes_one_of_them(self):
        code, out, _ = self.sweep("--list")
        lines = [line.split("\t") for line in out.splitlines()]
        self.assertEqual((code, len(lines), lines[4][:2]), (0, 6, ["4", "to do"]))
        self.assertFalse(self.out.exists())
        process = self.start("--index=4")
        self.assertEqual((process.wait(), process.communicate()[0]), (0, ""))
        self.assertEqual([path.name for path in (self.out / "runs").iterdir()], ["friction_0.5-seed_2"])
        self.assertEqual(self.sweep("--index=6")[0], 2)

    def test_a_signal_stops_the_runs_and_the_sweep_asks_to_come_again(self):
        process = self.start("--jobs=1", frictions="9,0", seeds="1", before=["nohup"])
        waiting = self.out / "runs/friction_9-seed_1/run.json"
        for _ in range(1000):
            if waiting.exists():
                break
            time.sleep(0.01)
        process.send_signal(signal.SIGHUP)  # ignored: started by nohup
        time.sleep(0.2)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 75)
        self.assertEqual(self.calls("friction_0-seed_1"), 0)  # no other run began

    def test_without_matplotlib_there_is_the_table_and_no_figure(self):
        stub = self.folder / "matplotlib.py"
        stub.write_text("raise ImportError('No module named matplotlib')")
        environment = {**os.environ, "PYTHONPATH": str(self.folder)}
        result = subprocess.run([sys.executable, PROGRAM, "sweep", *self.words()], env=environment, capture_output=True,
                                text=True)
        self.assertEqual(result.returncode, 0)
        self.assertIn("no figure: No module named matplotlib", result.stderr)
        self.assertEqual(len(self.results()), 6)

    def test_mean_and_spread_are_taken_over_the_seeds(self):
        self.sweep(frictions="0", seeds="1,3")
        plan = read_plan("", "", [], ["contact.friction=0", "sample.seed=1,3"], self.out)
        from softgrain.sweep.table import read_runs
        strain, mean, spread = mean_curve(list(read_runs(plan).values()), "stress_top")
        half = np.searchsorted(strain, 0.25)
        self.assertAlmostEqual(mean[half] / strain[half], 2 * 6, places=9)  # 3 * seed at strain 0.5, linear
        self.assertAlmostEqual(spread[half] / mean[half], 0.5, places=9)


class Scripts(Temporary):
    def stub(self, name, text):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("#!/bin/bash\n" + text)
        path.chmod(stat.S_IRWXU)

    def submit(self, index):
        """The array's script with stand-ins for srun, softgrain and scontrol, as Slurm would start it."""
        environment = {"PATH": f"{self.folder}/bin:/usr/bin:/bin", "SLURM_ARRAY_TASK_ID": str(index),
                       "SLURM_JOB_ID": "41"}
        return subprocess.run(["/bin/bash", self.out / "array.sh"], env=environment, capture_output=True, text=True)

    def test_the_array_makes_each_run_once_and_requeues_the_one_that_asks_for_it(self):
        self.assertEqual(self.sweep("--slurm", "--set=loading.wall_velocity=1 m/s")[0], 0)
        text = (self.out / "array.sh").read_text()
        self.assertIn("#SBATCH --array=0-5\n", text)
        self.assertIn("#SBATCH --signal=USR2@", text)
        self.stub("srun", 'printf "%s\\n" "$@"; exit $((SLURM_ARRAY_TASK_ID == 5 ? 75 : 0))')
        self.stub("scontrol", 'echo "scontrol $*"')
        done = self.submit(2)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stdout.splitlines()[-2:], ["--index", "2"])
        self.assertIn(f"sweep\n{self.out.resolve()}/plan.toml\n", done.stdout)
        self.assertIn('"loading.wall_velocity" = "1 m/s"\n', (self.out / "plan.toml").read_text())
        again = self.submit(5)
        self.assertEqual(again.returncode, 75)
        self.assertIn("scontrol requeue 41", again.stdout)

    def test_paths_with_blanks_and_percent_signs_are_quoted_for_slurm(self):
        plan = read_plan("softgrain", "case.toml", [], ["sample.seed=1,2"], Path(self.out) / "50 % of it")
        text = scripts.slurm_scripts(plan, ["softgrain"], 1, None, 1001)["array.sh"]
        self.assertIn('#SBATCH --job-name="50 % of it"\n', text)
        self.assertIn(f'#SBATCH --output="{plan.folder.resolve().parent}/50 %% of it/slurm-%A_%a.txt"\n', text)

    def test_the_snakefile_is_python_but_for_its_rules_and_names_every_run(self):
        self.assertEqual(self.sweep("--snakemake")[0], 0)
        text = (self.out / "Snakefile").read_text()
        names = {}
        exec(text.partition("rule all")[0], names)
        self.assertEqual(list(names["RUNS"].values()), list(range(6)))
        self.assertEqual(names["FOLDER"], self.out.resolve())
        self.assertEqual(names["COMMAND"], f"{self.program} sweep {self.out.resolve()}/plan.toml")
        self.assertEqual(text.count("\nrule "), 3)


if __name__ == "__main__":
    unittest.main()
