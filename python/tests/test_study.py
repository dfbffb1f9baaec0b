"""Studies of many runs: plans in files, designs, how far they are, what failed, interruptions, and hands that carry them out."""

import csv
import fcntl
import os
import shutil
import subprocess
import sys
import time
import unittest
import unittest.mock

import numpy as np

from softgrain import NotRecorded
from softgrain.sweep import PlanError, read_plan, read_plan_file, scripts
from softgrain.sweep.figure import draw_sweep
from softgrain.sweep.status import duration, status_text
from softgrain.sweep.table import read_runs, values_of
from softgrain.sweep.values import read_range
from stand_in import PROGRAM, Temporary


class Studies(Temporary):
    def setUp(self):
        super().setUp()
        undrawn = unittest.mock.patch("softgrain.sweep.figure.draw_sweep", side_effect=NotRecorded("it costs more than all the rest"))
        undrawn.start()
        self.addCleanup(undrawn.stop)


class PlanFiles(Studies):
    def write(self, text, name="plan.toml"):
        path = self.folder / name
        path.write_text(text)
        return path

    def test_a_file_says_the_same_as_the_words_of_the_command_line(self):
        path = self.write("""
case = "case.toml"
output = "out"
seeds = 3

[set]
time.step = "0.05 us"
solver.max_sweeps = 9

[vary]
"contact.friction" = [0, 0.10, 1e-7]
mpm.young_modulus = "1..2:3 MPa"
loading.unload_at = [[0.1, 0.2], []]
mpm.law = ["neo_hookean", "von_mises"]
""")
        plan = read_plan_file("softgrain", path)
        same = read_plan("softgrain", self.folder / "case.toml", ["time.step=0.05 us", "solver.max_sweeps=9"],
                         ["contact.friction=0,0.10,1e-7", "mpm.young_modulus=1 MPa,1.5 MPa,2 MPa", "loading.unload_at=[0.1, 0.2],[]",
                          "mpm.law=neo_hookean,von_mises", "sample.seed=1..3"], self.out)
        self.assertEqual(plan, same)
        self.assertEqual(len(plan.runs), 3 * 3 * 2 * 2 * 3)

    def test_the_plan_that_a_sweep_leaves_is_read_as_the_same_runs(self):
        self.sweep("--set=loading.wall_velocity=1 m/s", frictions="0:0.5:0.5", seeds="3..6")
        kept = self.out / "plan.toml"
        again = read_plan_file(str(self.program), kept)
        given = read_plan(str(self.program), self.folder / "case.toml", ["loading.wall_velocity=1 m/s"],
                          ["contact.friction=0:0.5:0.5", "sample.seed=3..6"], self.out)
        self.assertEqual([(run.name, run.values) for run in again.runs], [(run.name, run.values) for run in given.runs])
        self.assertEqual((again.fixed, again.case.resolve(), again.folder), (given.fixed, given.case.resolve(), given.folder))
        self.assertIn('"sample.seed" = "3..6"\n', kept.read_text())
        code, _, err = self.call(self.out)  # the directory alone goes on
        self.assertEqual((code, "8 of 8 runs: done before" in err), (0, True))

    def test_a_plan_that_was_written_by_hand_in_the_folder_of_its_runs_stays_as_it_was(self):
        self.out.mkdir()
        text = '# mine\ncase = "../case.toml"\nseeds = 2\n'
        self.write(text, "out/plan.toml")
        self.assertEqual(self.call(self.out / "plan.toml")[0], 0)
        self.assertEqual((self.out / "plan.toml").read_text(), text)
        code, _, err = self.sweep(frictions="0", seeds="1")
        self.assertEqual((code, "written by hand" in err, (self.out / "plan.toml").read_text()), (2, True, text))
        self.assertEqual(len(self.results()), 2)

    def test_what_is_wrong_in_a_file_is_told_with_its_line(self):
        for text, words in (
                ('case = "c.toml"\n[varry]\na.b = 1\n', "line 2: 'varry' is no table of a plan; do you mean vary?"),
                ('case = "c.toml"\noutptu = "x"\n', "line 2: 'outptu' is no key of a plan; do you mean output?"),
                ('case = "c.toml"\n[vary]\ncontact.friction = "0..0.5"\n', "line 3: contact.friction: '0..0.5'"),
                ('case = "c.toml"\ndesign = "sobol:8"\n[range]\ncontact.friction = "0.5..0"\n', "line 4: contact.friction = 0.5..0: the"),
                ('case = "c.toml"\ndesign = "sobol:100"\n[range]\na.b = "0..1"\n', "line 2: sobol:100: .* sobol:64 or sobol:128"),
                ('case = "c.toml"\n[points]\na.b = 3\n', r"line 3: a.b = 3: want a list"),
                ('case = "c.toml"\n[points]\na.b = [1, 2]\na.c = [1]\n', "a.b has 2, a.c has 1"),
                ('case = "c.toml"\n[range]\na.b = "0..1"\n', "line 2: .* there is none: design ="),
                ('case = "c.toml"\n', "nothing varies"),
                ('[vary]\na.b = 1\n', "it is no plan"),
                ('case = c.toml\n', "plan.toml: Invalid value .at line 1"),
                ('case = 3\n', "line 1: case = 3: want text")):
            with self.subTest(text), self.assertRaisesRegex(PlanError, words):
                read_plan_file("", self.write(text))

    def test_words_that_belong_into_the_plan_are_refused_beside_it(self):
        path = self.write('case = "case.toml"\nseeds = 2\n')
        code, _, err = self.call(path, "--vary=contact.friction=0,1")
        self.assertEqual((code, "--vary: " in err, "write it there" in err), (2, True, True))
        self.assertEqual(self.call(self.folder / "nowhere.toml")[0], 4)
        self.assertIn("-o DIR", self.call(self.folder / "case.toml", "--vary=sample.seed=1")[2])
        self.assertIn("a word too many", self.call(path, "more")[2])
        self.assertIn("there is none: --design", self.call(self.folder / "case.toml", "--range=a.b=0..1", "-o", self.out)[2])


class Designs(unittest.TestCase):
    RANGES = ("contact.friction=0..0.5", "mpm.young_modulus=1..100 MPa,log")

    def points(self, design):
        plan = read_plan("softgrain", "case.toml", [], [], "out", design, self.RANGES)
        self.assertEqual([run.name for run in plan.runs][:2], ["point_0", "point_1"])
        friction = np.array(plan.points["contact.friction"], float) / 0.5
        modulus = np.array([float(text.removesuffix(" MPa")) for text in plan.points["mpm.young_modulus"]])
        return np.column_stack([friction, np.log10(modulus) / 2])

    def test_of_each_slice_of_a_range_one_point_is_taken(self):
        for design in ("lhs:32", "sobol:32"):
            for column in self.points(design).T:
                self.assertEqual(sorted((column * 32 - 1e-4).astype(int)), list(range(32)), design)

    def test_a_sobol_sequence_has_one_point_in_each_box_of_every_shape(self):
        places = self.points("sobol:64")
        for wide in (1, 2, 4, 8, 16, 32, 64):  # a net in base 2: wide * high = 64 boxes
            boxes = {(int(x * wide), int(y * 64 / wide)) for x, y in places}
            self.assertEqual(len(boxes), 64)

    def test_a_longer_sobol_sequence_keeps_its_points_and_another_seed_has_others(self):
        few, many = self.points("sobol:16:5"), self.points("sobol:64:5")
        np.testing.assert_array_equal(few, many[:16])
        self.assertFalse(np.allclose(few, self.points("sobol:16:6")))

    def test_each_point_meets_each_varied_value(self):
        plan = read_plan("softgrain", "case.toml", [], ["sample.seed=1..3"], "out", "sobol:4", self.RANGES)
        self.assertEqual([run.name for run in plan.runs][2:5], ["point_0-seed_3", "point_1-seed_1", "point_1-seed_2"])
        self.assertEqual(plan.runs[4].values["contact.friction"], plan.points["contact.friction"][1])

    def test_ranges_and_designs_that_make_no_sense_are_refused(self):
        for text in ("0.5", "0..", "1..0", "0..1,log", "1..2,lin", "a..b", "1..2, MPa"):
            with self.subTest(text), self.assertRaises(PlanError):
                read_range("a.b", text)
        for design, ranges in (("sobol", self.RANGES), ("grid:9", self.RANGES), ("lhs:0", self.RANGES), ("lhs:8", ()), ("", self.RANGES)):
            with self.subTest(design), self.assertRaises(PlanError):
                read_plan("", "", [], [], "", design, ranges)
        with self.assertRaisesRegex(PlanError, "contact.friction is varied, and a number of each point"):
            read_plan("", "", [], ["contact.friction=0,1"], "", "lhs:4", self.RANGES)


class DesignsCarriedOut(Studies):
    def words(self, *arguments):
        return [self.folder / "case.toml", "-o", self.out, *arguments]

    def test_the_points_stand_in_the_plan_so_that_other_machines_need_no_scipy(self):
        code, _, err = self.sweep("--design=sobol:4", "--range=contact.friction=0..0.5", "--vary=sample.seed=1,3")
        self.assertEqual(code, 0, err)
        rows = self.results()
        self.assertEqual(len(rows), 8)
        for row in rows:
            stress = 100 * float(row["contact.friction"]) + int(row["sample.seed"])
            self.assertAlmostEqual(float(row["stress_top_last[Pa]"]), stress, places=6)
        plan = read_plan_file(str(self.program), self.out / "plan.toml")
        curves, last = draw_sweep(plan, read_runs(plan), []).axes
        self.assertEqual((len(curves.lines), len(last.containers), last.get_xlabel()), (4, 4, "contact.friction"))
        with unittest.mock.patch.dict(sys.modules, {"scipy": None, "scipy.stats": None}):
            self.assertIn("8 runs, 100.0 %", self.call("status", self.out)[1])
            code, _, err = self.sweep("--design=lhs:4", "--range=contact.friction=0..1")
            self.assertEqual(code, 2)
            self.assertRegex(err, "needs SciPy .*apt install python3-scipy")


class Curves(Studies):
    def curves(self):
        with (self.out / "curves.csv").open() as file:
            return list(csv.DictReader(file))

    def test_means_are_taken_at_equal_strain(self):
        self.sweep(seeds="1,3")
        rows = self.curves()
        self.assertEqual({row["contact.friction"] for row in rows}, {"0.0", "0.5"})
        self.assertEqual({row["runs"] for row in rows}, {"2"})
        for row in rows:  # up to 3 s at strain 0.5, down to s at 1: s = 100 mu + 1, and + 3
            strain, mean = float(row["strain"]), 100 * float(row["contact.friction"]) + 2
            shape = 6 * strain if strain <= 0.5 else 5 - 4 * strain
            self.assertAlmostEqual(float(row["stress_top_mean[Pa]"]), shape * mean, places=5)
            self.assertAlmostEqual(float(row["stress_top_deviation[Pa]"]), shape, places=5)

    def test_means_at_equal_packing_fraction_are_those_of_curves_over_it(self):
        self.sweep(seeds="1,3")
        for number, seed in enumerate((1, 3)):  # stress = 1000 (phi - 0.6) + 20 number, at other strains and other phi
            phi = np.linspace(0.6 + 0.02 * number, 0.9, 31)
            stress = 1000 * (phi - 0.6) + 20 * number
            rows = [f"{e},{p},{s}" for e, p, s in zip(np.linspace(0, 0.3 + number, 31), phi, stress)]
            (self.out / f"runs/friction_0-seed_{seed}/series.csv").write_text("\n".join(["strain,phi,stress_top[Pa]", *rows, ""]))
        (self.folder / "case.toml").touch()
        code, out, err = self.sweep("--over=phi", frictions="0", seeds="1,3")
        self.assertEqual((code, len(out.split())), (0, 2), err)
        rows = self.curves()
        places = np.array([float(row["phi"]) for row in rows])
        self.assertGreaterEqual(places.min(), 0.62)
        self.assertGreater(places.max(), 0.899)
        np.testing.assert_allclose([float(row["stress_top_mean[Pa]"]) for row in rows], 1000 * (places - 0.6) + 10, atol=1e-4)
        np.testing.assert_allclose([float(row["stress_top_deviation[Pa]"]) for row in rows], 10, atol=1e-4)


class Values(unittest.TestCase):
    def test_a_key_that_the_resolved_case_lacks_keeps_what_was_written(self):
        class Kinds:
            case = {"kind": [{"name": "sand", "number": 3}], "contact": {"friction": 0.5}}

        plan = read_plan("", "", [], ["kind.sand.share=1", "kind.sand.law.name=ogden", "contact.friction=0.50"], "")
        self.assertEqual(values_of(plan.runs[0], Kinds), [1.0, "ogden", 0.5])


class Interrupted(Studies):
    def status(self):
        code, out, _ = self.call("status", self.out)
        self.assertEqual(code, 0)
        return out

    def test_failed_runs_are_told_and_left_alone_until_they_are_to_be_tried_again(self):
        self.sweep("--jobs=1", frictions="7,0", seeds="1")
        said = self.status()
        self.assertRegex(said, r"2 runs, 100\.0 %")
        self.assertRegex(said, r"(?m)^  failed +1 .*--retry-failed")
        self.assertIn("friction_7-seed_1: the grain has burst\n", said)
        code, _, err = self.sweep(frictions="7,0", seeds="1")
        self.assertEqual((code, self.calls("friction_7-seed_1")), (3, 1))
        self.assertIn("1 of 2 runs: failed before; --retry-failed", err)
        process = self.start("--index=0", frictions="7,0", seeds="1")
        self.assertIn("failed before: the grain has burst", process.communicate()[1])
        self.assertEqual(process.returncode, 3)
        (self.out / "runs/mended").touch()
        self.assertEqual(self.sweep("--retry-failed", frictions="7,0", seeds="1")[0], 0)
        self.assertEqual(self.calls("friction_7-seed_1"), 2)

    def test_more_failures_than_allowed_begin_no_other_run(self):
        code, _, err = self.sweep("--jobs=1", "--max-fails=1", frictions="7,0", seeds="1..4")
        self.assertEqual(code, 3)
        self.assertIn("gave up", err)
        self.assertEqual([self.calls(f"friction_7-seed_{seed}") for seed in (1, 2, 3, 4)], [1, 1, 0, 0])
        self.assertEqual(self.calls("friction_0-seed_1"), 0)
        process = self.start("--max-fails=1", "--index=5", frictions="7,0", seeds="1..4")
        self.assertIn("gave up, 2 runs have failed", process.communicate()[1])
        self.assertEqual((process.returncode, self.calls("friction_0-seed_2")), (3, 0))

    def test_a_killed_run_is_not_done_and_is_made_again(self):
        code, _, err = self.sweep("--jobs=1", frictions="8,0", seeds="1")
        self.assertEqual(code, 3)  # its half row counts for nothing
        self.assertEqual([row["state"] for row in self.results()], ["killed", "done"])
        self.assertRegex(self.status(), r"(?m)^  killed +1 .*last snapshot")
        self.assertEqual(self.sweep("--jobs=1", frictions="8,0", seeds="1")[0], 0)
        self.assertEqual([row["state"] for row in self.results()], ["done", "done"])
        self.assertEqual((self.calls("friction_8-seed_1"), self.calls("friction_0-seed_1")), (2, 1))

    def test_what_is_half_written_is_made_again(self):
        self.sweep(frictions="0", seeds="1..3")
        (self.out / "runs/friction_0-seed_1/run.json").write_text('{"state": "do')
        (self.out / "runs/friction_0-seed_2/case.toml").unlink()
        damaged = self.out / "runs/friction_0-seed_3/case.toml"
        damaged.write_text("[contact\n")
        code, _, err = self.sweep(frictions="0", seeds="1..3")
        self.assertEqual((code, "case.toml is damaged" in err, "remove it" in err), (4, True, True))
        damaged.unlink()
        self.assertEqual(self.sweep(frictions="0", seeds="1..3")[0], 0)
        self.assertEqual([self.calls(f"friction_0-seed_{seed}") for seed in (1, 2, 3)], [2, 2, 2])

    def test_a_run_that_goes_on_elsewhere_is_left_to_it(self):
        path = self.out / "runs/friction_0-seed_1"
        path.mkdir(parents=True)
        (path / "run.json").write_text('{"state": "running"}')
        (path / "case.toml").touch()
        with (path / ".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            code, _, err = self.sweep(frictions="0", seeds="1..2")
            self.assertEqual((code, "1 of 2 runs go on elsewhere" in err), (75, True))
            self.assertRegex(self.status(), r"(?m)^  running +1$")
        self.assertEqual((self.calls("friction_0-seed_1"), self.calls("friction_0-seed_2")), (0, 1))
        self.assertEqual(self.sweep(frictions="0", seeds="1..2")[0], 0)  # it was killed
        self.assertEqual(self.calls("friction_0-seed_1"), 1)

    def test_the_time_left_follows_from_what_is_done_and_what_is_on_its_way(self):
        self.sweep(frictions="0", seeds="1..4")  # of 10 s each, as they say
        self.assertIn("4 runs, 100.0 %", self.status())
        plan = read_plan("softgrain", self.folder / "case.toml", [], ["contact.friction=0", "sample.seed=1..9"], self.out)
        half = self.out / "runs/friction_0-seed_5"
        half.mkdir()
        (half / "run.json").write_text('{"state": "running"}')
        (half / "case.toml").write_text("[output]\nsamples = 4\n")
        (half / "series.csv").write_text("step,wall_seconds[s]\n0,0\n1,2\n2,5\n3,")
        said = status_text(plan)  # 4.5 of 9 runs, 4.5 are left
        self.assertIn("9 runs, 50.0 %  [===============               ]", said)
        self.assertIn("nothing runs; 45 s of one run after another are left", said)
        with (half / ".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.assertIn("about 45 s left with 1 at a time", status_text(plan))
        self.assertEqual([duration(s) for s in (40, 700, 12000, 187200)], ["40 s", "12 min", "3 h 20 min", "2 d 4 h"])

    def test_the_state_of_many_runs_takes_less_than_a_millisecond_each(self):
        plan = read_plan("softgrain", self.folder / "case.toml", [], ["sample.seed=1..400"], self.out)
        for run in plan.runs:
            plan.directory(run).mkdir(parents=True)
            (plan.directory(run) / "run.json").write_text('{"state": "done", "wall_seconds": 3}')
            (plan.directory(run) / "case.toml").touch()
        begin = time.process_time()
        self.assertIn("400 runs, 100.0 %", status_text(plan))
        self.assertLess(time.process_time() - begin, 0.4)

    def test_status_asks_for_a_directory_with_a_plan(self):
        self.assertIn("of which sweep", self.call("status")[2])
        code, _, err = self.call("status", self.folder)
        self.assertEqual((code, f"{self.folder} is no sweep's folder: it has no plan.toml" in err), (2, True))


class Hands(Studies):
    """Others that carry out the tasks."""

    def stub(self, name, text):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("#!/bin/bash\n" + text)
        path.chmod(0o700)

    def bash(self, script, *words, **variables):
        environment = {"PATH": f"{self.folder}/bin:/usr/bin:/bin", **variables}
        return subprocess.run(["/bin/bash", script, *words], env=environment, capture_output=True, text=True)

    def test_more_tasks_than_an_array_may_have_become_several_that_make_each_run_once(self):
        plan = read_plan("softgrain", "case.toml", [], ["sample.seed=1..25"], self.out)
        self.out.mkdir()
        for pack, throttle in ((1, None), (2, 3)):
            files = scripts.slurm_scripts(plan, ["softgrain", "sweep", "P"], pack, throttle, 10)
            for name, text in files.items():
                (self.out / name).write_text(text)
            # an sbatch that starts each task of the array at once, and says what it was asked
            self.stub("sbatch", 'echo "$@" >&2; for w in "$@"; do [[ $w == --array=* ]] && a=${w#--array=}; done; a=${a%\\%*}\n'
                                'for ((i = ${a%-*}; i <= ${a#*-}; i++)); do SLURM_ARRAY_TASK_ID=$i bash "${@: -2:1}" "${@: -1}" >&2; done; echo 41\n')
            self.stub("srun", 'echo "$@" >> ' + str(self.out / "asked"))
            done = self.bash(self.out / "submit.sh")
            self.assertEqual(done.returncode, 0, done.stderr)
            asked = (self.out / "asked").read_text().splitlines()
            (self.out / "asked").unlink()
            tasks = -(-25 // pack)
            self.assertEqual([int(line.split()[-1]) for line in asked], list(range(tasks)))
            submitted = [line for line in done.stderr.splitlines() if "--parsable" in line]
            self.assertEqual(len(submitted), -(-tasks // 10))
            self.assertEqual("%3 --dependency=afterany:41 " in submitted[1], throttle == 3)
            self.assertEqual("--dependency" in submitted[0], False)

    def test_the_scheduler_says_how_large_an_array_may_be(self):
        before = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", before)
        os.environ["PATH"] = f"{self.folder}/bin"
        self.assertEqual(scripts.max_array_size(), 1001)  # no scontrol here
        os.environ["PATH"] += os.pathsep + before
        self.stub("scontrol", "echo 'MailProg = /bin/mail'; echo 'MaxArraySize            = 7'")
        self.assertEqual(scripts.max_array_size(), 7)
        self.assertEqual(self.sweep("--slurm", "--throttle=4", "--pack=2", "--retry-failed", "--max-fails=3", seeds="1..8")[0], 0)
        text = (self.out / "array.sh").read_text()
        self.assertIn("#SBATCH --array=0-6%4\n", text)
        self.assertIn("plan.toml --retry-failed --max-fails 3 --pack 2 --jobs \"$cpus\" --index \"$task\"\n", text)
        self.assertTrue((self.out / "submit.sh").exists())

    def test_a_pack_makes_its_runs_and_no_other(self):
        process = self.start("--index=1", "--pack=4", seeds="1..3")
        out, err = process.communicate()
        self.assertEqual((process.returncode, out), (0, ""), err)
        self.assertEqual(sorted(path.name for path in (self.out / "runs").iterdir()), ["friction_0.5-seed_2", "friction_0.5-seed_3"])
        self.assertIn("numbered from 0 to 1", self.sweep("--index=2", "--pack=4", seeds="1..3")[2])

    @unittest.skipUnless(shutil.which("parallel"), "needs GNU parallel: tools/install_dependencies.sh --with cluster")
    def test_gnu_parallel_carries_out_the_tasks(self):
        self.sweep("--slurm", frictions="0", seeds="1..2")
        words = f"seq 0 1 | parallel -j 2 {sys.executable} {PROGRAM} sweep {self.out} --index {{}}"
        done = subprocess.run(["/bin/bash", "-c", words], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 of 2 runs: done before", self.call(self.out)[2])

    @unittest.skipUnless(shutil.which("snakemake"), "needs Snakemake: tools/install_dependencies.sh --with cluster")
    def test_snakemake_carries_out_the_snakefile(self):
        self.program.write_text(self.program.read_text().replace(
            "verb, words", f"if sys.argv[1] == 'sweep':\n    os.execv('{sys.executable}', ['python3', '{PROGRAM}', *sys.argv[1:]])\nverb, words", 1))
        self.sweep("--snakemake", frictions="0", seeds="1..2")
        done = subprocess.run(["snakemake", "-q", "-s", self.out / "Snakefile", "--cores", "1"], capture_output=True, text=True,
                              cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([row["state"] for row in self.results()], ["done", "done"])
        self.assertEqual(self.calls("friction_0-seed_2"), 1)


if __name__ == "__main__":
    unittest.main()
