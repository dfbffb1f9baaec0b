"""Cases and their runs, with a stand-in for the program that writes down its words."""

import os
import stat
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import synthetic

import softgrain

STAND_IN = f"""#!{sys.executable}
import json, os, pathlib, sys
words = sys.argv[1:]
if "--set=contact.friction=-1" in words:
    sys.exit((print("error: contact.friction = -1 is out of range", file=sys.stderr), 2)[1])
if "--set=time.step=1" in words:
    sys.exit((print("error: NaN in grain 3", file=sys.stderr), 3)[1])
if words[0] == "check":
    print(json.dumps({{"case": {{"words": words}}}}))
else:
    folder = pathlib.Path(words[words.index("-o") + 1])
    folder.mkdir()
    (folder / "case.toml").write_text("words = " + json.dumps(words))
    if "--set=solver.max_sweeps=1" in words:
        (folder / "run.json").write_text(json.dumps({{"state": "done", "doubts": ["an overlap of 0.1"]}}))
        sys.exit((print("converged 0.0 %; DO NOT TRUST IT: an overlap of 0.1", file=sys.stderr), 5)[1])
"""


class Cases(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        program = self.folder / "softgrain"
        program.write_text(STAND_IN)
        program.chmod(stat.S_IRWXU)
        patch = mock.patch.dict(os.environ, SOFTGRAIN_PROGRAM=str(program))
        patch.start()
        self.addCleanup(patch.stop)

    def test_the_last_value_of_a_key_counts_and_the_first_case_stays_as_it_was(self):
        case = softgrain.Case("case.toml")
        changed = case.set("contact.friction", 0.3).set("output.vtk", False).set("contact.friction", 0.5)
        self.assertEqual(changed.resolve()["words"],
                         ["check", "case.toml", "--set=output.vtk=false", "--set=contact.friction=0.5", "--json"])
        self.assertEqual(case.resolve()["words"], ["check", "case.toml", "--json"])

    def test_values_are_written_as_in_a_case_file(self):
        case = softgrain.Case("c").set("loading.unload_at", [0.1, 0.2]).set("time.step", "0.05 us")
        self.assertEqual(case.resolve()["words"][2:4],
                         ["--set=loading.unload_at=[0.1, 0.2]", "--set=time.step=0.05 us"])

    def test_a_run_that_is_not_to_be_trusted_is_opened_with_a_warning_that_says_why(self):
        case = softgrain.Case("c").set("solver.max_sweeps", 1)
        with self.assertWarnsRegex(softgrain.DoubtfulRun, "DO NOT TRUST IT: an overlap"):
            run = softgrain.run_case(case, self.folder / "out")
        self.assertEqual(run.doubts, ["an overlap of 0.1"])

    def test_a_case_is_run_into_its_directory_and_opened(self):
        run = softgrain.run_case(softgrain.Case("c").set("sample.seed", 7), self.folder / "out", threads=2)
        self.assertEqual(run.name, "out")
        self.assertEqual(run.case["words"], ["run", "c", "--set=sample.seed=7", "-o", str(self.folder / "out"),
                                             "--quiet", "--threads=2"])

    def test_what_the_program_refuses_and_what_breaks_down_are_exceptions_with_its_words(self):
        with self.assertRaisesRegex(softgrain.CaseError, "out of range"):
            softgrain.Case("c").set("contact.friction", -1).resolve()
        with self.assertRaisesRegex(softgrain.RunFailed, "NaN in grain 3") as raised:
            softgrain.run_case(softgrain.Case("c").set("time.step", 1), self.folder / "out")
        self.assertEqual(raised.exception.code, 3)

    def test_a_notebook_shows_state_and_last_row_and_text_stays_text(self):
        run = softgrain.open(synthetic.write_run(self.folder / "a<b", snapshots=1))
        html = run._repr_html_()
        self.assertIn("<caption>a&lt;b</caption>", html)
        self.assertIn("<th>strain</th><td>0.2 </td>", html)
        self.assertIn("<th>snapshots</th><td>1</td>", html)

    def test_a_case_of_values_alone_sets_them_in_their_order(self):
        case = softgrain.Case({"bpm": {"primaries": 60}, "loading.unload_at": [0.1]}).set("bpm.primaries", 80)
        self.assertEqual(case.resolve()["words"],
                         ["check", "/dev/null", "--set=loading.unload_at=[0.1]", "--set=bpm.primaries=80", "--json"])

    def test_a_notebook_shows_what_a_case_sets_over_its_file_and_text_stays_text(self):
        (self.folder / "a&b.toml").write_text('[contact]\nfriction = 0.5\n[grain]\nradius = "5 mm"\n')
        html = softgrain.Case(self.folder / "a&b.toml").set("contact.friction", "<0.3>")._repr_html_()
        self.assertIn("a&amp;b.toml</caption>", html)
        self.assertIn("<th>contact.friction</th><td>&lt;0.3&gt;</td>", html)
        self.assertIn("<th>grain.radius</th><td>5 mm</td>", html)
        self.assertEqual(html.count("<tr>"), 2)

    def test_a_run_draws_its_own_figures(self):
        run = softgrain.open(synthetic.write_run(self.folder / "squeeze", snapshots=3))
        for figure in (run.plot.curve(), run.plot.grain(), run.plot.diagnostics()):
            self.assertGreater(len(figure.axes), 0)


if __name__ == "__main__":
    unittest.main()
