"""The figures: what they show, how large they are, and that they depend on nothing but the run."""

import contextlib
import dataclasses
import io
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings
from itertools import combinations
from pathlib import Path

import h5py
import matplotlib.axis
import matplotlib.text
import numpy as np
import synthetic
from PIL import Image

import softgrain
from softgrain import picture, plot
from softgrain.plot.__main__ import main
from softgrain.plot.layout import panel_grid
from softgrain.plot.rows import Forces, Layers, Pressure
from softgrain.plot.stages import choose_stages

PROGRAM = Path(__file__).resolve().parents[1] / "softgrain"


def drawn_texts(figure):
    """Every text but the labels of ticks beyond the limits of their axis, which exist and are not drawn."""
    ticks = figure.findobj(matplotlib.axis.Tick)
    labels = {label for tick in ticks for label in (tick.label1, tick.label2)}
    texts = [text for text in figure.findobj(matplotlib.text.Text) if text not in labels]
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            texts += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    return [text for text in texts if text.get_visible() and text.get_text()]


class Temporary(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def write(self, name="squeeze", **options):
        return synthetic.write_run(self.folder / name, **options)

    def plot(self, *arguments):
        """(exit code, names of the files written, stderr)."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(["--dpi=50", *map(str, arguments)])
        return code, [Path(line).name for line in out.getvalue().split()], err.getvalue()


class Program(Temporary):
    def test_one_run_gives_three_figures_beside_its_results(self):
        run = self.write()
        code, files, _ = self.plot(run)
        self.assertEqual((code, files), (0, ["curve.png", "grain.png", "diagnostics.png"]))
        self.assertTrue((run / "figures" / "grain.png").exists())

    def test_two_runs_share_one_curve_and_keep_their_own_grains(self):
        code, files, _ = self.plot(self.write("slow"), self.write("fast"), "-o", self.folder / "both")
        self.assertEqual(code, 0)
        self.assertEqual(sorted(files), ["curve.png", "diagnostics-fast.png", "diagnostics-slow.png",
                                         "grain-fast.png", "grain-slow.png"])

    def test_a_run_of_one_row_is_drawn_without_a_warning(self):
        run = self.write(columns=(*synthetic.COLUMNS, "phi", "z"))
        table = run / "series.csv"
        table.write_text("\n".join(table.read_text().splitlines()[:2]) + "\n")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            code, files, err = self.plot(run)
        self.assertEqual((code, len(files), err), (0, 4, ""))

    def test_a_figure_that_the_data_do_not_allow_is_named_and_the_others_are_drawn(self):
        code, files, err = self.plot(self.write(snapshots=0))
        self.assertEqual((code, files), (0, ["curve.png", "diagnostics.png"]))
        self.assertIn("no grain: ", err)
        code, files, err = self.plot(self.folder / "squeeze", "--kind", "grain")
        self.assertEqual((code, files), (2, []))

    def test_what_is_missing_from_a_run_is_not_missed(self):
        for number, lacking in enumerate((
            dict(columns=("strain", "stress_bottom[Pa]")),
            dict(columns=("time[s]", "strain", "stress_top[Pa]", "something_new[K]")),
            dict(fields=()),
            dict(fields=(), contacts=False),
            dict(snapshots=1),
            dict(force=0.0),
        )):
            with self.subTest(lacking):
                code, files, _ = self.plot(self.write(str(number), **lacking), "--kind", "grain")
                self.assertEqual((code, files), (0, ["grain.png"]))
                self.assertEqual(self.plot(self.folder / str(number), "--kind", "curve")[0], 0)

    def test_mistakes_end_with_2_and_damaged_files_with_4(self):
        code, _, err = self.plot(self.folder / "nothing")
        self.assertEqual(code, 2)
        self.assertIn("case.toml", err)
        run = self.write()
        softgrain.open(run).snapshots[0].write_bytes(b"not HDF5")
        self.assertEqual(self.plot(run)[0], 4)

    def test_a_python_without_its_packages_names_the_packages_to_install(self):
        for package in ("matplotlib", "h5py", "numpy"):
            stub = self.folder / package / f"{package}.py"
            stub.parent.mkdir()
            stub.write_text(f"raise ImportError('No module named {package}')")
            environment = {**os.environ, "PYTHONPATH": str(stub.parent)}
            result = subprocess.run([sys.executable, PROGRAM, "plot", "RUN"], env=environment,
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"No module named {package}", result.stderr)
            self.assertIn("apt install python3-matplotlib python3-h5py", result.stderr)
            self.assertNotIn("Traceback", result.stderr)


class Mixtures(Temporary):
    def test_the_key_of_a_mixture_names_its_kinds_as_the_case_does(self):
        run = self.write()
        for path in softgrain.open(run).snapshots:
            with h5py.File(path, "r+") as file:
                count = len(file["scene/particles/position"])
                file["scene/particles/grain"] = np.arange(count) // (count // 2 + 1)
                file["scene/particles/kind"] = file["scene/particles/grain"][()]
                square = np.array([(0, 0), (1e-3, 0), (1e-3, 1e-3), (0, 1e-3)])
                file["scene/outlines/position"] = np.concatenate([square, square + 1e-3])
                file["scene/outlines/grain"] = [0] * 4 + [1] * 4
        for case, names in (('\n[[kind]]\nname = "rubber"\n[[kind]]\nname = "sand"\n', ["rubber", "sand"]),
                            ("", ["kind 1", "kind 2"])):
            (run / "case.toml").write_text("[bpm]\nattraction = 100\n" + case)
            figure = plot.draw_grain(softgrain.open(run))
            keys = [text.get_text() for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()]
            self.assertEqual([key for key in keys if not key.endswith(" N/m")], names)


class Files(Temporary):
    def test_the_same_run_gives_the_same_bytes(self):
        run = self.write()
        for suffix in ("png", "svg", "pdf"):
            for folder in ("first", "second"):
                self.plot(run, "-o", self.folder / folder, "--format", suffix, "--kind", "grain")
            first, second = (self.folder / folder / f"grain.{suffix}" for folder in ("first", "second"))
            self.assertEqual(first.read_bytes(), second.read_bytes(), suffix)

    def test_a_png_is_as_wide_as_a_column_and_says_where_it_comes_from(self):
        self.plot(self.write(), "-o", self.folder, "--dpi=300")
        for name, column in (("curve", 85), ("diagnostics", 85), ("grain", 180)):
            with Image.open(self.folder / f"{name}.png") as image:
                width = image.width / image.info["dpi"][0] * 25.4  # [mm]
                self.assertLess(abs(width - column), 0.2)
                self.assertIn("softgrain 9.8.7 (abc123)", image.info["Software"])
                self.assertRegex(image.info["Source"], "squeeze: case sha256 [0-9a-f]{16}")


class Pictures(Temporary):
    def open(self, *arguments, **options):
        return softgrain.open(self.write(*arguments, **options))

    def assert_texts_apart(self, figure):
        """No two words of the figure overlap, and all lie on the page."""
        figure.draw_without_rendering()
        boxes = [(text.get_text(), text.get_window_extent()) for text in drawn_texts(figure)]
        self.assert_boxes_apart(boxes)
        for text, box in boxes:
            inside = (box.min >= -1).all() and (box.max <= np.array(figure.bbox.max) + 1).all()
            self.assertTrue(inside, f"{text!r} leaves the page")

    def assert_boxes_apart(self, boxes):
        for (a, box_a), (b, box_b) in combinations(boxes, 2):
            overlap = np.minimum(box_a.max, box_b.max) - np.maximum(box_a.min, box_b.min)
            self.assertFalse((overlap > 1).all(), f"{a!r} overlaps {b!r}")

    def test_no_word_covers_another(self):
        run, other = self.open(), self.open("a run with quite a long name")
        with plot.style():
            for figure in (
                plot.draw_curve([run]),
                plot.draw_curve([run], normalise=True),
                plot.draw_curve([run, other]),
                plot.draw_grain(run),
                plot.draw_diagnostics(run),
            ):
                self.assert_texts_apart(figure)

    def test_the_panels_keep_clear_of_one_another_and_of_their_headings(self):
        run = self.open()
        with plot.style():
            figure = plot.draw_grain(run)
            figure.draw_without_rendering()
        page, *keys = figure.axes
        frames = {tuple(artist.get_clip_box().extents): artist.get_clip_box() for artist in page.collections}
        self.assertEqual(len(frames), 3 * len(choose_stages(run, run.times)))  # pressure, forces, layers
        things = [*enumerate(keys), *((text.get_text(), text) for text in figure.texts)]
        self.assert_boxes_apart([*frames.items(), *((name, thing.get_window_extent()) for name, thing in things)])

    def test_the_curve_says_its_plateau_and_the_characteristic_stress(self):
        with plot.style():
            figure = plot.draw_curve([self.open()])
        words = " ".join(text.get_text() for text in figure.findobj(matplotlib.text.Text))
        self.assertIn("plateau 0.080 MPa = 0.16", words)
        self.assertIn("0.50 MPa", words)
        self.assertIn("slope 10 MPa", words)

    def test_weak_stresses_have_a_smaller_unit(self):
        for largest, unit in ((1e6, "MPa"), (1.1e4, "MPa"), (900, "kPa"), (9, "Pa")):
            path = self.write(f"{largest:g}")
            rows = np.column_stack([np.linspace(0, 0.1, 50), np.linspace(0, largest, 50)])
            np.savetxt(path / "series.csv", rows, delimiter=",", header="strain,stress_top[Pa]", comments="")
            with plot.style():
                figure = plot.draw_curve([softgrain.open(path)])
            self.assertIn(f"[{unit}]", " ".join(axes.get_ylabel() for axes in figure.axes))
            drawn = max(line.get_ydata().max() for axes in figure.axes for line in axes.lines if len(line.get_xdata()) > 2)
            self.assertAlmostEqual(drawn * {"MPa": 1e6, "kPa": 1e3, "Pa": 1}[unit] / largest, 1, delta=0.1)

    def test_many_unloadings_have_their_range_of_slopes_on_the_page(self):
        path = self.write()
        strain = np.concatenate([[0], *(np.concatenate([np.linspace(k, k + 2, 20), np.linspace(k + 2, k + 1, 10)]) for k in range(12))]) / 100
        rows = np.column_stack([strain, synthetic.stress_path(strain)])
        np.savetxt(path / "series.csv", rows, delimiter=",", header="strain,stress_top[Pa]", comments="")
        with plot.style():
            figure = plot.draw_curve([softgrain.open(path)])
            self.assert_texts_apart(figure)
        words = " ".join(text.get_text() for text in figure.findobj(matplotlib.text.Text))
        self.assertIn("12 slopes 10", words)

    def test_grains_that_pull_are_drawn_below_zero(self):
        path = self.write()
        rows = np.column_stack([np.linspace(0, 0.1, 50), 1e6 * np.sin(np.linspace(0, 6, 50))])
        np.savetxt(path / "series.csv", rows, delimiter=",", header="strain,stress_top[Pa]", comments="")
        with plot.style():
            figure = plot.draw_curve([softgrain.open(path)])
        self.assertLess(min(axes.get_ylim()[0] for axes in figure.axes), -1)

    def test_the_curve_of_a_packing_has_no_plateau(self):
        packing = self.open("packing", columns=("strain", "stress_top[Pa]", "phi"))
        grain = self.open("grain", columns=("strain", "stress_top[Pa]", "something_new"))
        for runs, plateaus in (([packing], 0), ([grain], 1), ([packing, grain], 1)):
            with plot.style():
                figure = plot.draw_curve(runs)
            words = " ".join(text.get_text() for text in figure.findobj(matplotlib.text.Text))
            self.assertEqual(words.count("plateau"), plateaus)

    def test_a_packing_shows_z_over_phi_and_phi_over_strain_without_the_way_back(self):
        run = self.open(columns=("strain", "phi", "phi_0", "z", "z_no_rattlers", "z_with_walls"))
        strain = run.series["strain"]
        run.series["phi"][:], run.series["z"][:] = 0.7 + strain, 10 * strain
        with plot.style():
            left, right = plot.draw_packing([run]).axes
        z, phi = left.lines[0], right.lines[0]
        np.testing.assert_allclose(z.get_ydata(), 10 * (z.get_xdata() - 0.7), atol=1e-12)
        np.testing.assert_allclose(phi.get_ydata(), 0.7 + phi.get_xdata())
        self.assertTrue((np.diff(phi.get_xdata()) > 0).all())
        self.assertEqual(len(left.lines), 3)
        with self.assertRaises(softgrain.NotRecorded):
            plot.draw_packing([self.open("grain")])

    def test_a_cell_in_shear_shows_its_ratio_over_gamma_with_the_mean_of_the_second_half(self):
        run = self.open(columns=("strain", "phi", "z", "shear_strain", "stress_ratio"))
        gamma = run.series["shear_strain"]
        gamma[:] = np.maximum(0, np.linspace(-0.5, 1, gamma.size))
        run.series["stress_ratio"][:] = np.where(gamma >= 0.5, 0.25, 0.1)
        with plot.style():
            panels = plot.draw_shear([run]).axes
        self.assertEqual(len(panels), 3)
        self.assertTrue((panels[0].lines[0].get_xdata() > 0).all())
        self.assertEqual(panels[0].get_legend().get_texts()[0].get_text(), r"0.250 $\pm$ 0.000")
        with self.assertRaises(softgrain.NotRecorded):
            plot.draw_shear([self.open("grain")])

    def test_grains_that_reach_across_a_periodic_cell_are_shown_at_both_ends(self):
        square = 0.2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        centres = np.array([(0.5, 0.5), (1.3, 0.5), (0.1, 0.95)])
        snapshot = softgrain.Snapshot(
            step=0, time=0.0, cell=np.array([(1.2, 0.0), (0.3, 1.0)]),
            walls=np.array([(0, 0, 1.2, 0), (0.3, 1, 1.5, 1), (0, 0, 0.3, 1), (1.2, 0, 1.5, 1)], float),
            particles={"position": centres, "radius": np.full(3, 0.1), "grain": np.arange(3)},
            contacts={"pair": np.array([(0, 1), (1, 2)]), "force": np.array([1.0, 2.0])},
            outlines={"position": np.concatenate([square + x for x in centres]), "grain": np.repeat(np.arange(3), 4)})
        shapes = picture.grains(snapshot, np.arange(3))
        shown = sorted((float(value), *np.round(polygon.mean(axis=0), 9)) for value, polygon in zip(shapes.values, shapes.polygons))
        self.assertEqual([place for place in shown if place[0] == 0], [(0, 0.5, 0.5)])
        self.assertIn((1.0, 0.1, 0.5), shown)  # across the right edge, which leans: one lattice vector to the left
        self.assertIn((2.0, -0.2, -0.05), shown)
        self.assertEqual(len(picture.cell_edges(snapshot)), 4)
        self.assertEqual(len(picture.walls(snapshot)), 0)
        chains = picture.chains(snapshot, picture.ForceScale(1.0, 0.1))
        ways = np.hypot(*(chains.segments[:, 1] - chains.segments[:, 0]).T)
        np.testing.assert_allclose(sorted(ways), [0.4, 0.4, 0.45, 0.45])  # from each end to the image of the other

    def test_one_colour_range_serves_the_whole_run(self):
        run = self.open()
        snapshots = [run[i] for i in range(len(run))]
        quiet, loud = snapshots[0], snapshots[1]
        quiet.particles["pressure"] = np.full(50, 1e3)
        loud.particles["pressure"] = np.linspace(0, 2e6, 50)
        scale = Pressure([quiet, loud]).range
        self.assertEqual(scale.low, 0)
        self.assertAlmostEqual(scale.high, 1.9e6, delta=0.1e6)

    def test_tension_and_pressure_are_coloured_symmetrically_about_zero(self):
        scale = Pressure([self.open()[0]]).range
        self.assertEqual(scale.low, -scale.high)

    def test_a_snapshot_before_the_first_step_does_not_set_the_scale(self):
        run = self.open()
        first, second = run[0], run[1]
        first.particles["pressure"] = np.full(len(first.particles["radius"]), -9e6)
        first.contacts.update(pair=np.empty((0, 2), int), force=np.empty(0))
        self.assertLess(Pressure([first, second]).range.high, 2e6)

    def test_layers_go_with_their_particles(self):
        run = self.open()
        layers = Layers([run[0], run[1]])
        height = run[0].particles["position"][:, 1]
        self.assertTrue((np.diff(layers.layer[np.argsort(height)]) >= 0).all())
        self.assertEqual(set(layers.layer), set(range(Layers.count)))

    def test_forces_need_contacts(self):
        run = self.open(contacts=False)
        with self.assertRaises(softgrain.NotRecorded):
            Forces([run[0]])

    def test_the_moments_shown_are_start_reversal_unloaded_and_end(self):
        run = self.open(snapshots=0)
        # Samples 0, 90 (loaded, 0.090), 100 (the reversal), 108, 112 (unloaded, 0.088), 200, and the last.
        times = 1e-3 * np.array([0, 90, 100, 108, 112, 200, 224])
        stages = choose_stages(run, times)
        self.assertEqual([s.snapshot for s in stages], [0, 2, 4, 6])
        np.testing.assert_allclose([s.strain for s in stages], [0, 0.1, 0.088, 0.2], atol=1e-9)
        np.testing.assert_allclose([s.stress for s in stages], [0, 0.08e6, 0, 0.08e6], atol=1)


class Elastic(Temporary):
    """Elastic grains have no attraction, no plateau, and unload as they were loaded."""

    def open(self, **options):
        folder = self.write(**options)
        (folder / "case.toml").write_text('[experiment]\nmodel = "mpm"\n[bpm]\nattraction = 100.0\n')  # the default
        return softgrain.open(folder)

    def words(self, draw, *arguments):
        with plot.style():
            return " ".join(text.get_text() for text in draw(*arguments).findobj(matplotlib.text.Text))

    def test_the_curve_speaks_of_nothing_that_only_bonded_grains_have(self):
        run = self.open()
        words = self.words(plot.draw_curve, [run])
        for word in ("sigma_I", "characteristic", "plateau", "slope", "mean over"):
            self.assertNotIn(word, words)
        self.assertIn("loading", words)
        self.assertNotIn("unloading the same", words)  # this one is plastic
        run.series["stress_top"][:] = run.series["stress_bottom"][:] = 1e6 * run.series["strain"]
        self.assertIn("loading, unloading the same", self.words(plot.draw_curve, [run]))
        with self.assertRaisesRegex(softgrain.NotRecorded, "elastic grains have no sigma_I"):
            plot.draw_curve([run], normalise=True)

    def test_the_diagnostics_show_the_stored_energy_and_no_key_without_its_curve(self):
        run = self.open(columns=("strain", "wall_work[J/m]", "elastic_energy[J/m]", "overlap_mean", "overlap_max"))
        run.series["overlap_mean"][:] = 0  # not measured; a logarithmic axis has no place for it
        words = self.words(plot.draw_diagnostics, run)
        self.assertIn("elastic", words)
        self.assertIn("worst", words)
        self.assertNotIn("mean ", words.replace("mean radius", ""))

    def test_grains_of_a_packing_are_drawn_as_grains_not_as_points(self):
        square = np.array([(0, 0), (1, 0), (1, 1), (0, 1.0)])
        points = np.concatenate([square * 0.5 + 0.25, square * 0.5 + (0.25, 1.25)])
        snapshot = softgrain.Snapshot(
            step=0, time=0.0,
            particles={"position": points, "radius": np.full(8, 0.28), "grain": np.repeat([0, 1], 4),
                       "pressure": np.arange(8.0), "J": np.ones(8)},
            walls=np.array([[0, 0, 1, 0.0]]),
            contacts={"pair": np.array([[0, 1], [0, 2]]), "force": np.array([3.0, 1]), "position": np.array([[0.5, 1], [0.5, 0]])},
            outlines={"position": np.concatenate([square, square + (0, 1)]), "grain": np.repeat([0, 1], 4)})
        self.assertEqual(Layers([snapshot]).layer.tolist(), [0, 1])
        for way in (Forces, Layers, Pressure):
            panel = panel_grid([(0, 1, 0, 2)], 1).panels[0, 0]
            way([snapshot]).draw(panel, 0)
            self.assertEqual(len(panel.axes.collections[0].get_paths()), 2)  # two polygons, not eight disks
        panel = panel_grid([(0, 1, 0, 2)], 1).panels[0, 0]
        Forces([snapshot]).draw(panel, 0)
        lines = np.concatenate([np.asarray(c.get_segments()).reshape(-1, 2, 2) for c in panel.axes.collections[1:]])
        np.testing.assert_allclose(lines[1], [[0.5, 0.5], [0.5, 1.5]])  # between the centres, the stronger above
        np.testing.assert_allclose(lines[0][:, 0], [0.5, 0.5])  # to the foot of the wall
        self.assertLess(lines[0][1, 1], 0.1)


class Cells(unittest.TestCase):
    """The four Gauss points of each cell of two squares, cut in four."""

    def snapshot(self, **changes):
        gauss = np.array([(x, y) for y in (-1, 1) for x in (-1, 1)]) / np.sqrt(3)
        middles = np.array([(x, y) for x in (0.25, 0.75) for y in (0.25, 0.75)])
        points = np.concatenate([middle + 0.25 * gauss for middle in middles])
        corner = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        particles = {"position": np.concatenate([points, points + [2, 0]]), "radius": np.full(32, np.sqrt(1 / 16 / np.pi)),
                     "grain": np.repeat([0, 1], 16), "J": np.ones(32), **changes}
        return softgrain.Snapshot(step=0, time=0.0, particles=particles,
                                  outlines={"position": np.concatenate([corner, corner + [2, 0]]), "grain": np.repeat([0, 1], 4)})

    def test_cells_are_the_quadrangles_whose_gauss_points_the_points_are(self):
        quads = picture.cells(self.snapshot())
        self.assertEqual(quads.shape, (8, 4, 2))
        np.testing.assert_allclose(quads[0].min(axis=0), [0, 0], atol=1e-12)
        np.testing.assert_allclose(quads[0].max(axis=0), [0.5, 0.5], atol=1e-12)
        x, y = np.moveaxis(quads, 2, 0)
        areas = (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1) / 2
        np.testing.assert_allclose(areas, 0.25)  # in order around the middle, and together the squares

    def test_a_field_is_the_mean_of_each_cell(self):
        surface = picture.surface(self.snapshot(), np.tile([-1.0, 1.0, 3.0, 5.0], 8))  # a checkerboard in each cell
        self.assertEqual(surface.values.tolist(), [2.0] * 8)
        self.assertEqual((len(surface.polygons), len(surface.rims)), (8, 2))

    def test_primaries_among_cells_are_round_polygons_with_values_of_their_own(self):
        snapshot = self.snapshot()
        points = len(snapshot.particles["radius"])
        more = {"position": [[9.0, 1.0], [9.0, 3.0]], "radius": [0.5, 0.25], "grain": [7, 7], "J": [1, 1]}
        particles = {name: np.concatenate([values, np.asarray(more[name], values.dtype)]) for name, values in snapshot.particles.items()
                     if name in more}
        particles["primary"] = np.repeat([0, 1], [points, 2])
        mixed = dataclasses.replace(snapshot, particles=particles)
        surface = picture.surface(mixed, np.arange(points + 2.0))
        self.assertEqual(len(surface.polygons), points // 4 + 2)
        np.testing.assert_allclose(surface.values[-2:], [points, points + 1])
        np.testing.assert_allclose(np.hypot(*(np.asarray(surface.polygons[-1]) - [9, 3]).T), 0.25)
        np.testing.assert_allclose(surface.values[:2], [1.5, 5.5])

    def test_points_that_are_not_four_by_four_in_cells_are_disks_within_outlines(self):
        mixed = self.snapshot(grain=np.tile([0, 1], 16))
        self.assertIsNone(picture.cells(mixed))
        surface = picture.surface(mixed, np.zeros(32))
        self.assertEqual((len(surface.polygons), len(surface.centres), len(surface.rims)), (0, 32, 2))

    def test_many_grains_have_their_mean_weighted_by_area(self):
        snapshot = self.snapshot()
        snapshot.particles["radius"][:16] = np.sqrt(np.arange(16))
        with unittest.mock.patch.object(picture, "MOST_GRAINS_WITH_FIELDS", 1):
            surface = picture.surface(snapshot, np.arange(32.0))
        self.assertEqual(len(surface.polygons), 2)
        np.testing.assert_allclose(surface.values, [(np.arange(16) ** 2).sum() / np.arange(16).sum(), 23.5])


if __name__ == "__main__":
    unittest.main()
