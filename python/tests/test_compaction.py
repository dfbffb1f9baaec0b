"""The equations of compaction, recovery and holds, against data of which the constants are known."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import numpy as np
import synthetic

import softgrain
from softgrain import compaction, measure, plot
from softgrain.plot.__main__ import main

MPA = 1e6
PRESSURE = np.linspace(0.01, 1, 200) * MPA
K, A = 3 / MPA, 0.9  # Heckel's
LARGEST_C, B = 0.45, 8 / MPA  # Kawakita's a and b


def density(pressure):
    return 1 - np.exp(-(K * pressure + A))


def reduction(pressure):
    return LARGEST_C * B * pressure / (1 + B * pressure)


class Fits(unittest.TestCase):
    def test_exact_data_give_their_constants(self):
        fit = compaction.heckel(PRESSURE, density(PRESSURE))
        self.assertAlmostEqual(fit.constants["K"].value / K, 1, 9)
        self.assertAlmostEqual(fit.constants["A"].value / A, 1, 9)
        self.assertAlmostEqual(fit.constants["1/K"].value * K, 1, 9)
        self.assertLess(fit.constants["K"].half_width, 1e-6 * K)
        self.assertEqual(fit.window, (0.2 * MPA, 0.8 * MPA))
        fit = compaction.kawakita(PRESSURE, reduction(PRESSURE))
        self.assertAlmostEqual(fit.constants["a"].value / LARGEST_C, 1, 9)
        self.assertAlmostEqual(fit.constants["b"].value / B, 1, 9)
        self.assertAlmostEqual(fit.constants["1/b"].value * B, 1, 9)
        root = 1 - np.exp(-(2e-3 * np.sqrt(PRESSURE) - 0.1))
        fit = compaction.panelli_ambrozio(PRESSURE, root)
        self.assertAlmostEqual(fit.constants["A"].value / 2e-3, 1, 9)
        self.assertAlmostEqual(fit.constants["B"].value / -0.1, 1, 9)
        self.assertAlmostEqual(fit.line.r_squared, 1, 9)

    def test_a_line_is_fitted_over_its_window_alone(self):
        bent = density(PRESSURE)
        bent[PRESSURE > 0.5 * MPA] = 0.999
        fit = compaction.heckel(PRESSURE, bent, (0.1 * MPA, 0.5 * MPA))
        self.assertAlmostEqual(fit.constants["K"].value / K, 1, 9)
        self.assertLess(compaction.heckel(PRESSURE, bent).line.r_squared, 0.99)
        with self.assertRaises(softgrain.NotRecorded):
            compaction.heckel(PRESSURE, bent, (0.1 * MPA, 0.1001 * MPA))

    def test_intervals_hold_the_constants_95_times_in_100(self):
        random = np.random.default_rng(5)
        runs, inside = 1000, dict.fromkeys(("K", "A", "1/K", "a", "b", "1/b"), 0)
        true = {"K": K, "A": A, "1/K": 1 / K, "a": LARGEST_C, "b": B, "1/b": 1 / B}
        pressure = PRESSURE[::12]
        for _ in range(runs):
            y = K * pressure + A + 0.02 * random.standard_normal(pressure.size)
            z = pressure / LARGEST_C + 1 / (LARGEST_C * B) + 2e3 * random.standard_normal(pressure.size)
            for fit in (compaction.heckel(pressure, 1 - np.exp(-y)), compaction.kawakita(pressure, pressure / z)):
                for name, constant in fit.constants.items():
                    inside[name] += abs(constant.value - true[name]) <= constant.half_width
        for name, count in inside.items():
            self.assertTrue(0.93 < count / runs < 0.97, (name, count))  # 3 deviations of a count of 1000

    def test_r_squared_is_the_square_of_the_correlation(self):
        random = np.random.default_rng(2)
        x, y = random.standard_normal((2, 30))
        self.assertAlmostEqual(compaction.fit_line(x, y).r_squared, np.corrcoef(x, y)[0, 1] ** 2, 12)

    def test_students_quantiles_are_those_of_the_tables(self):
        for freedom, quantile in ((1, 12.7062), (2, 4.3027), (10, 2.2281), (100, 1.9840), (10000, 1.9602)):
            self.assertAlmostEqual(compaction.students_t(freedom), quantile, 3)

    def test_a_constant_shows_two_digits_of_its_interval(self):
        self.assertEqual(compaction.Constant(14.1234, 0.1523).text(), "14.12 ± 0.15")
        self.assertEqual(compaction.Constant(1234.6, 42.0).text(), "1235 ± 42")
        self.assertEqual(compaction.Constant(0.25, 0.0).text(), "0.25")


def die_series():
    """Pressed by Heckel's equation to 1 MPa, held with a wobble, let go, the sides opened, lifted; four rows of rest."""
    start = 0.6
    press = PRESSURE
    height = start / density(press)  # of a box of width 1 that holds an area of start
    lowest = height[-1]
    hold = lowest * (1 + 1e-6 * np.sin(np.arange(10)))
    unload, rest = lowest * np.linspace(1.001, 1.04, 20), np.full(4, lowest * 1.05)
    eject, lift = np.full(10, lowest * 1.04), lowest * np.linspace(1.042, 1.05, 5)
    wide = np.r_[np.ones(press.size + 30), np.linspace(1.001, 1.01, 10), np.full(9, 1.01)]
    high = np.r_[height, hold, unload, eject, lift, rest]
    load = np.r_[press, np.full(10, MPA), np.linspace(0.95, 0, 20) * MPA, np.zeros(19)]
    work = np.r_[np.linspace(0, 8, press.size), np.full(10, 8.0), np.linspace(8, 6, 39)]
    leg = np.repeat(np.arange(6), (press.size, 10, 20, 10, 5, 4))
    return {"step": np.arange(high.size), "time[s]": np.arange(high.size) * 1e-3, "strain": np.log(high[0] / high), "leg": leg,
            "wall_height[m]": high, "width[m]": wide, "stress_top[Pa]": 1.1 * load, "stress_bottom[Pa]": 0.9 * load,
            "stress_side[Pa]": 0.5 * load, "transmission_ratio": np.full(high.size, 0.9 / 1.1), "radial_ratio": np.full(high.size, 0.5),
            "phi": start / (high * wide), "z": np.full(high.size, 4.0), "wall_work[J/m]": work,
            "dissipation_plastic[J/m]": np.minimum(work, 6)}


class Runs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path = synthetic.write_run(Path(temporary.name) / "tablet")
        (self.path / "case.toml").write_text('[experiment]\nmodel = "mpm"\nloading = "die"\n')
        columns = die_series()
        rows = np.column_stack(list(columns.values()))
        lines = [",".join(columns), *(",".join(f"{value:.17g}" for value in row) for row in rows)]
        (self.path / "series.csv").write_text("\n".join(lines) + "\n")
        self.run_of_die = softgrain.open(self.path)

    def test_the_way_in_gives_heckels_constants(self):
        data = compaction.loading(self.run_of_die)
        self.assertEqual(data.pressure.size, PRESSURE.size)
        self.assertAlmostEqual(compaction.heckel(data.pressure, data.density).constants["K"].value / K, 1, 6)
        height = 0.6 / density(PRESSURE)
        np.testing.assert_allclose(data.reduction, 1 - height / height[0], atol=1e-12)

    def test_recovery_is_counted_from_the_largest_compression(self):
        found = compaction.recovery(self.run_of_die.series)
        self.assertAlmostEqual(found.axial_unloaded, 0.04, 5)
        self.assertAlmostEqual(found.axial, 0.05, 5)
        self.assertAlmostEqual(found.radial, 0.01, 9)
        series = self.run_of_die.series
        until = {name: values[: PRESSURE.size + 30] for name, values in series.items()}
        kept = compaction.recovery(until)
        self.assertAlmostEqual(kept.axial_unloaded, 0.04, 5)
        self.assertIsNone(kept.radial)
        in_load = compaction.recovery({name: values[: PRESSURE.size] for name, values in series.items()})
        self.assertEqual(in_load, (None, None, None))

    def test_the_plasticity_index_is_plastic_over_total_work_under_load(self):
        self.assertAlmostEqual(compaction.plasticity_index(self.run_of_die.series), 0.75, 9)
        self.assertIsNone(compaction.plasticity_index({"wall_work": np.ones(2)}))

    def test_a_hold_is_no_unloading(self):
        series = self.run_of_die.series
        kinds = [branch.kind for branch in measure.branches(series["strain"], measure.directions(series))]
        self.assertEqual(kinds[:3], [measure.LOADING, measure.HOLD, measure.UNLOADING])
        slopes = [u.slope for u in measure.unloadings(series["strain"], measure.vertical_stress(series), measure.directions(series))]
        self.assertEqual(len(slopes), 1)
        self.assertLess(abs(slopes[0] / (0.95 * MPA / 0.0382) - 1), 0.05)
        with plot.style():
            words = [text.get_text() for text in plot.draw_curve([self.run_of_die]).axes[0].get_legend().get_texts()]
        self.assertIn("hold", words)
        self.assertEqual(sum("slope" in word for word in words), 1)

    def test_the_plot_prints_the_constants_their_intervals_the_window_and_r_squared(self):
        with plot.style():
            figure = plot.draw_heckel(self.run_of_die)
            words = " ".join(text.get_text() for text in figure.axes[0].get_legend().get_texts())
            self.assertIn("$K$ = 3", words)
            self.assertIn("$R^2$ = 1.0000", words)
            self.assertIn("fitted from 0.2 to 0.8 MPa; ±: 95 % intervals", words)
            figure = plot.draw_kawakita(self.run_of_die, (0.4e6, 0.9e6))
            words = " ".join(text.get_text() for text in figure.axes[0].get_legend().get_texts())
            self.assertIn("from 0.4 to 0.9 MPa", words)
            title = plot.draw_die(self.run_of_die).axes[0].get_legend().get_title().get_text()
        self.assertIn("axial, unloaded: +4.00 %", title)
        self.assertIn("radial, ejected: +1.00 %", title)
        self.assertIn("plastic over total work: 0.750", title)

    def plot(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(["--dpi=40", str(self.path), *words])
        return code, [Path(line).name for line in out.getvalue().split()], err.getvalue()

    def test_all_figures_of_a_die_come_with_those_of_its_packing(self):
        code, files, _ = self.plot()
        self.assertEqual(code, 0)
        self.assertLessEqual({"curve.png", "die.png", "heckel.png", "kawakita.png"}, set(files))
        self.assertEqual(self.plot("--kind", "heckel")[1], ["heckel.png"])

    def test_a_wrong_window_is_refused(self):
        for window in ("0.5", "0.5:0.1", "a:b", "-1:2"):
            code, _, err = self.plot("--kind=heckel", f"--window={window}")
            self.assertEqual(code, 2)
            self.assertIn("--window takes two pressures in MPa", err)
        code, _, err = self.plot("--kind=heckel", "--window=0.1:0.1001")
        self.assertEqual(code, 2)
        self.assertIn("too few", err)


if __name__ == "__main__":
    unittest.main()
