"""A run against a curve that was made from it by a known change."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import numpy as np
import synthetic
from PIL import Image
from small_runs import CASES, small_run

import softgrain
from softgrain import compare, measure
from softgrain.compare.__main__ import main


class Temporary(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def write(self, text, name="measured.csv"):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def curve(self, strain, values, header="strain,stress[Pa]"):
        return self.write("\n".join([header, *(f"{a:.17g},{b:.17g}" for a, b in zip(strain, values))]) + "\n")

    def call(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main([*map(str, words)])
        return code, out.getvalue(), err.getvalue()


class Reading(Temporary):
    def test_units_separators_comments_and_more_columns_are_understood(self):
        same = [
            "strain,stress[MPa]\n0,0\n0.01,0.5\n0.02,1\n",
            "# from the press\nstrain;stress[kPa];force\n0;0;1\n0.01;500;2\n\n0.02;1000;3\n",
            "strain[%]\tstress[Pa]\n0\t0\n1\t5e5\n2\t1e6\n",
            "\ufeffstrain [%], stress [MPa]\n0, 0\n1, 0.5\n2, 1\n",
        ]
        for text in same:
            curve = compare.read_measured(self.write(text))
            self.assertEqual(curve.name, "stress")
            np.testing.assert_allclose(curve.strain, [0, 0.01, 0.02])
            np.testing.assert_allclose(curve.values, [0, 5e5, 1e6])
        self.assertEqual(compare.read_measured(self.write("strain,force_top[kN/m]\n0,1\n1,2\n2,3\n")).values[2], 3000)

    def test_the_way_back_is_left_out(self):
        curve = compare.read_measured(self.curve([0, 0.1, 0.2, 0.15, 0.2, 0.3], [0, 1, 2, 0, 2, 3]))
        self.assertEqual(curve.strain.tolist(), [0, 0.1, 0.2, 0.3])
        self.assertEqual(curve.values.tolist(), [0, 1, 2, 3])

    def test_mistakes_name_line_and_remedy(self):
        for text, words in (("", "is empty"), ("stress[MPa],strain\n0,0\n", "it must begin with"), ("strain\n0\n", "it must begin with"),
                            ("strain,stress[psi]\n0,0\n", "'psi'"), ("strain,stress[Pa]\n0,0\n0.1,abc\n", ":3: '0.1,abc'"),
                            ("strain,stress[Pa]\n0,0\n0.1,nan\n0.2,1\n", ":3:"), ("strain,stress[Pa]\n0,0\n0.1,1\n", "2 points"),
                            ("strain;stress[MPa]\n0;0\n0,01;0,5\n", "decimal point")):
            with self.assertRaisesRegex(ValueError, words):
                compare.read_measured(self.write(text))


class Numbers(Temporary):
    def test_a_run_agrees_with_itself_and_differs_by_what_was_added(self):
        """With a wave of amplitude a on it the rms is a/sqrt(2) and the largest difference -a."""
        for name in CASES:
            run = small_run(name)
            strain, values = compare.run_curve(run)
            same = compare.compare(run, compare.MeasuredCurve("stress", strain, values))
            self.assertEqual((same.rms, same.largest[1]), (0, 0))
            at = np.linspace(strain[0], strain[-1], 401)[:-1]
            wave = 2e4 * np.sin(2 * np.pi * 5 * np.arange(400) / 400)
            other = compare.compare(run, compare.MeasuredCurve("stress", at, np.interp(at, strain, values) + wave))
            self.assertAlmostEqual(other.rms, 2e4 / np.sqrt(2), delta=1)
            self.assertAlmostEqual(abs(other.largest[1]), 2e4, delta=1)
            at_largest = (other.largest[0] - strain[0]) / (strain[-1] - strain[0]) * 10 % 1  # half a wave is one
            self.assertAlmostEqual(at_largest, 0.5, delta=0.05)

    def test_only_strains_that_both_have_count(self):
        run = small_run("elastic")
        strain, _ = compare.run_curve(run)
        at = np.linspace(-0.1, 2 * strain[-1], 100)
        found = compare.compare(run, compare.MeasuredCurve("stress", at, np.zeros(100)))
        np.testing.assert_array_equal(found.strain, at[(at >= 0) & (at <= strain[-1])])
        with self.assertRaisesRegex(ValueError, "common"):
            compare.compare(run, compare.MeasuredCurve("stress", at + 5, np.zeros(100)))

    def test_serrated_curves_are_averaged_over_strain_and_those_of_one_elastic_grain_are_not(self):
        for name in CASES:
            run = small_run(name)
            raw = measure.envelope(run.series["strain"], measure.vertical_stress(run.series))[1]
            self.assertEqual(np.array_equal(compare.run_curve(run)[1], raw), name == "elastic")

    def test_any_column_can_be_compared(self):
        run = small_run("elastic")
        strain, force = compare.run_curve(run, "force_top")
        np.testing.assert_array_equal(force, measure.envelope(run.series["strain"], run.series["force_top"])[1])
        with self.assertRaisesRegex(softgrain.NotRecorded, "no pressure"):
            compare.run_curve(run, "pressure")


class Program(Temporary):
    def test_it_prints_the_differences_and_draws_them(self):
        run = small_run("elastic")
        strain, values = compare.run_curve(run)
        code, out, _ = self.call(run.path, self.curve(strain, 1.1 * values), "-o", self.folder / "new" / "figure.png")
        self.assertEqual(code, 0)
        self.assertIn("largest difference", out)
        self.assertIn(f"{-100 * 0.1 / 1.1:+.2f} % of the largest measured, at strain {strain[-1]:.4g}", out)
        with Image.open(self.folder / "new" / "figure.png") as image:
            self.assertGreater(len(set(image.convert("RGB").resize((80, 80)).getdata())), 20)

    def test_mistakes_end_with_2(self):
        run = synthetic.write_run(self.folder / "run")
        good = self.curve([0, 0.1, 0.2], [0, 1, 2])
        for words in ((self.folder / "none", good), (run, self.write("a,b\n1,2\n", "bad.csv")), (run, good, "-o", "figure.bmp")):
            code, _, err = self.call(*words)
            self.assertEqual(code, 2)
            self.assertIn("error: ", err)
        missing = self.folder / "missing.csv"
        self.assertEqual(self.call(run, missing), (4, "", f"error: {missing}: No such file or directory\n"))
        self.assertEqual(self.call(run, good)[0], 0)
        self.assertTrue((run / "figures" / "compare.png").exists())


if __name__ == "__main__":
    unittest.main()
