"""What was exported is read back by readers of its format that are written here."""

import contextlib
import dataclasses
import importlib.util
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock
from pathlib import Path
from xml.etree import ElementTree

import h5py
import matplotlib.image
import numpy as np
import synthetic
from small_runs import CASES, small_run

import softgrain
from softgrain import colours, picture
from softgrain.export import __main__
from softgrain.export.contacts import contact_table
from softgrain.export.paraview import pressure_range
from softgrain.export.particles import box
from softgrain.picture import outlines

SQUARE = np.array([(0, 0), (2e-3, 0), (2e-3, 2e-3), (0, 2e-3)])


def read_xyz(path):
    """[(words of the comment line, rows)] of each frame."""
    lines, frames = iter(path.read_text().splitlines()), []
    for count in lines:
        comment = next(lines)
        frames.append((comment, [next(lines).split() for _ in range(int(count))]))
    return frames


def read_dump(path):
    """[{step, bounds, columns, rows}] of each frame of LAMMPS' text dump."""
    frames = []
    for text in path.read_text().split("ITEM: TIMESTEP\n")[1:]:
        step, _, count, bounds, *low_high = text.splitlines()[:7]
        columns, *rows = text.splitlines()[7:]
        frames.append(dict(step=int(step), count=int(count), bounds=bounds, box=np.loadtxt(low_high),
                           columns=columns.split()[2:], rows=np.array([row.split() for row in rows], float)))
    return frames


class Temporary(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = synthetic.write_run(Path(temporary.name) / "squeeze", snapshots=3)
        self.run_of_bonds = softgrain.open(self.folder)

    def add_grains(self):
        """Material points of two grains, each a square, into every snapshot."""
        for path in self.run_of_bonds.snapshots:
            with h5py.File(path, "r+") as file:
                particles = file["scene/particles"]
                count = len(particles["position"])
                particles["grain"] = (np.arange(count) >= 10).astype(int)
                particles["J"] = np.ones(count)
                file["scene/outlines/position"] = np.concatenate([SQUARE, SQUARE + 3e-3])
                file["scene/outlines/grain"] = [0] * 4 + [1] * 4

    def export(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = __main__.main([str(self.folder), *map(str, arguments)])
        return code, Path(out.getvalue().strip()), err.getvalue()


class Particles(Temporary):
    def test_extended_xyz_has_every_frame_with_radius_and_pressure(self):
        code, path, _ = self.export("--to=xyz")
        frames = read_xyz(path)
        self.assertEqual((code, len(frames)), (0, 3))
        for (comment, rows), snapshot in zip(frames, self.run_of_bonds):
            self.assertIn("Properties=species:S:1:pos:R:3:radius:R:1:pressure:R:1 ", comment)
            self.assertIn(f" Step={snapshot.step}", comment)
            self.assertEqual({row[0] for row in rows}, {"X"})  # ASE reads a name of its elements or X, nothing else
            numbers = np.array([row[1:] for row in rows], float)
            np.testing.assert_allclose(numbers[:, :2], snapshot.particles["position"], rtol=1e-8)
            np.testing.assert_allclose(numbers[:, 4], snapshot.particles["pressure"], rtol=1e-8)
        lattice = np.array(re.search('Lattice="([^"]*)"', frames[0][0])[1].split(), float).reshape(3, 3)
        self.assertAlmostEqual(lattice[0, 0], 6e-3)  # the walls are 6 mm long

    def test_a_lammps_dump_counts_grains_from_one_and_holds_all_particles_in_its_box(self):
        self.add_grains()
        _, path, _ = self.export("--to=lammps")
        frames = read_dump(path)
        self.assertEqual([frame["step"] for frame in frames], [s.step for s in self.run_of_bonds])
        for frame, snapshot in zip(frames, self.run_of_bonds):
            self.assertEqual(frame["bounds"], "ITEM: BOX BOUNDS ff ff ff")
            self.assertEqual(frame["columns"], "id type x y z radius pressure mol".split())
            np.testing.assert_array_equal(frame["rows"][:, 7], snapshot.particles["grain"] + 1)
            np.testing.assert_allclose(frame["rows"][:, 2:4], snapshot.particles["position"], rtol=1e-8)
            self.assertTrue((frame["rows"][:, 2:5] >= frame["box"][:, 0]).all())
            self.assertTrue((frame["rows"][:, 2:5] <= frame["box"][:, 1]).all())

    def test_a_table_has_one_frame_and_says_its_units(self):
        _, path, _ = self.export("--to=csv", "--frame=1")
        header, *rows = path.read_text().splitlines()
        self.assertEqual(header, "x[m],y[m],pressure[Pa],radius[m]")
        np.testing.assert_allclose(np.array([row.split(",") for row in rows], float)[:, :2],
                                   self.run_of_bonds[1].particles["position"], rtol=1e-8)

    def test_the_box_holds_whole_particles_also_without_walls(self):
        alone = dataclasses.replace(self.run_of_bonds[0], walls=np.empty((0, 4)))
        x = alone.particles["position"][:, 0]
        np.testing.assert_allclose(box(alone)[0], (x.min() - synthetic.RADIUS, x.max() + synthetic.RADIUS))

    def test_a_frame_that_is_not_there_is_refused(self):
        code, _, err = self.export("--to=csv", "--frame=3")
        self.assertEqual(code, 2)
        self.assertIn("3 snapshots", err)


    @unittest.skipUnless(importlib.util.find_spec("ase"), "ASE is not here, so it did not read our file: apt install python3-ase")
    def test_ase_reads_every_frame_of_runs_of_both_models(self):
        import ase.io

        for name in CASES:
            run, path = small_run(name), self.folder / f"{name}.xyz"
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(__main__.main([str(run.path), "--to=xyz", "-o", str(path)]), 0)
            frames = ase.io.read(path, index=":")
            self.assertEqual([frame.info["Step"] for frame in frames], [snapshot.step for snapshot in run])
            for frame, snapshot in zip(frames, run):
                np.testing.assert_allclose(frame.positions[:, :2], snapshot.particles["position"], rtol=1e-8, atol=1e-14)
                np.testing.assert_allclose(frame.arrays["radius"], snapshot.particles["radius"], rtol=1e-8)
                np.testing.assert_allclose(frame.arrays["pressure"], snapshot.particles["pressure"], rtol=1e-8)
                self.assertFalse(frame.pbc.any())


class Pictures(Temporary):
    def svg(self, *arguments):
        _, path, _ = self.export("--to=svg", *arguments)
        return ElementTree.parse(path).getroot()

    def test_bonded_grains_are_disks_with_their_radius_to_scale(self):
        root = self.svg("--frame=0")
        disks = root.findall("{*}circle")
        position = self.run_of_bonds[0].particles["position"]
        self.assertEqual(len(disks), len(position))
        pixels = np.array([(float(d.get("cx")), -float(d.get("cy"))) for d in disks])
        scale = (pixels[-1] - pixels[0]) / (position[-1] - position[0])
        np.testing.assert_allclose(scale, scale[0], rtol=1e-3)
        self.assertAlmostEqual(float(disks[0].get("r")), scale[0] * synthetic.RADIUS, places=1)
        self.assertEqual(len(root.findall("{*}line")), 3)  # two walls, and the key of the chains

    def test_each_of_many_grains_is_its_outline_the_more_pressed_the_brighter(self):
        self.add_grains()
        with unittest.mock.patch.object(picture, "MOST_GRAINS_WITH_FIELDS", 1):
            polygons = self.svg().findall("{*}polygon")
        self.assertEqual([len(p.get("points").split()) for p in polygons], [4, 4])
        red = [int(p.get("fill")[1:3], 16) for p in polygons]
        self.assertGreater(red[1], red[0])  # pressure rises with the particle's number, from violet to orange

    def test_all_frames_have_one_place_one_scale_and_one_range_of_colours(self):
        with h5py.File(self.run_of_bonds.snapshots[0], "r+") as file:  # the first hardly pressed
            file["scene/particles/pressure"][...] *= 1e-6
        first, last = self.svg("--frame=0"), self.svg("--frame=-1")
        self.assertEqual(first.get("viewBox"), last.get("viewBox"))
        words = [[text.text for text in root.findall("{*}text")] for root in (first, last)]
        self.assertEqual(words[0], words[1])
        self.assertIn("pressure [kPa]", words[0])
        self.assertEqual(len({disk.get("fill") for disk in first.findall("{*}circle")}), 1)
        self.assertGreater(len({disk.get("fill") for disk in last.findall("{*}circle")}), 20)

    def test_chains_are_as_wide_as_their_forces_are_large(self):
        lines = self.svg().findall("{*}g/{*}line")
        widths = np.array([float(line.get("stroke-width")) for line in lines])
        force = np.sort(self.run_of_bonds[-1].contacts["force"])
        np.testing.assert_allclose(widths / widths[-1], force / force[-1], atol=2e-3)

    def test_the_key_of_the_chains_has_the_width_of_its_force(self):
        root = self.svg()
        (key,) = [line for line in root.findall("{*}line") if line.get("class") == "chain-key"]
        words = [text.text for text in root.findall("{*}text")]
        (force,) = [float(word.removesuffix(" N/m")) for word in words if word.endswith(" N/m")]
        widest = max(float(line.get("stroke-width")) for line in root.findall("{*}g/{*}line"))
        largest = self.run_of_bonds[-1].contacts["force"].max()
        self.assertAlmostEqual(float(key.get("stroke-width")) / widest, force / largest, delta=0.02)

    def test_frames_of_real_runs_share_their_keys_and_their_place(self):
        for name in CASES:
            run, heads = small_run(name), []
            for frame in range(len(run)):
                path = self.folder / f"{name}_{frame}.svg"
                with contextlib.redirect_stdout(io.StringIO()):
                    self.assertEqual(__main__.main([str(run.path), "--to=svg", f"--frame={frame}", "-o", str(path)]), 0)
                root = ElementTree.parse(path).getroot()
                heads.append((root.get("viewBox"), *(text.text for text in root.findall("{*}text"))))
            self.assertEqual(len(set(heads)), 1)
            self.assertTrue(any("pressure [" in word for word in heads[0]))
            self.assertEqual(any(word.endswith(" N/m") for word in heads[0]), name != "elastic")


class Colours(unittest.TestCase):
    def test_maps_are_those_of_the_page(self):
        source = (Path(__file__).resolve().parents[2] / "viewer/src/colours.ts").read_text()
        maps = dict(re.findall(r'(\w+):\s+"([0-9a-f]{102})"', source))
        self.assertEqual(maps, colours.MAPS)

    def test_a_range_begins_at_zero_or_is_symmetric_and_leaves_out_the_outermost(self):
        rising = np.linspace(0, 100, 101)
        self.assertEqual(colours.range_of(rising), ("cividis", 0, 99))
        self.assertEqual(colours.range_of(-rising), ("cividis", -99, 0))
        self.assertEqual(colours.range_of(rising - 30), ("PuOr", -69, 69))
        self.assertEqual(colours.range_of([np.nan]), ("cividis", 0, 1))
        self.assertEqual(colours.range_of([0.99, 1.0, 1.0, 1.01]).map, "viridis")  # close together, far from zero

    def test_the_ends_have_the_ends_of_the_map(self):
        scale = colours.range_of([0, 1, 1])
        self.assertEqual(scale.hexadecimal([-5, 0, 1, 9]), ["#00224e", "#00224e", "#fee838", "#fee838"])


class Contacts(Temporary):
    def table(self, *arguments):
        code, path, err = self.export("--to=contacts", *arguments)
        self.assertEqual(code, 0, err)
        header, *rows = path.read_text().splitlines()
        return dict(zip(header.split(","), np.array([row.split(",") for row in rows], float).T))

    def test_bonded_normals_go_from_centre_to_centre_and_places_lie_between(self):
        table, snapshot = self.table(), self.run_of_bonds[-1]
        self.assertEqual(list(table), ["a", "b", "wall", "grain_a", "grain_b", "normal_x", "normal_y", "x[m]", "y[m]",
                                       "normal_force[N/m]"])
        a, b = snapshot.contacts["pair"].T
        d = snapshot.particles["position"][b] - snapshot.particles["position"][a]
        np.testing.assert_allclose(table["normal_x"], d[:, 0] / np.hypot(*d.T), rtol=1e-6, atol=1e-8)
        np.testing.assert_allclose(table["normal_force[N/m]"], snapshot.contacts["force"])
        self.assertTrue((table["wall"] == -1).all())

    def test_a_wall_is_met_along_its_normal_and_the_shear_is_that_of_the_checkpoint(self):
        position = self.run_of_bonds[-1].particles["position"]
        top, count = int(position[:, 1].argmax()), len(position)
        with h5py.File(self.run_of_bonds.snapshots[-1], "r+") as file:
            contacts = file["scene/contacts"]
            del contacts["pair"], contacts["force"]
            contacts["pair"], contacts["force"] = [[0, 1], [top, count + 1]], [10.0, 30.0]
            file["checkpoint/contact_impulse"] = [[2.0, -1.0], [0.0, 0.0], [6.0, 3.0]]  # the second does not push
        table = self.table()
        self.assertEqual([table[name][1] for name in ("b", "wall", "grain_b", "normal_x", "normal_y")], [-1, 1, -1, 0, 1])
        self.assertAlmostEqual(table["y[m]"][1], position[top, 1] + synthetic.RADIUS)
        np.testing.assert_allclose(table["tangential_force[N/m]"], [-5, 15])

    def test_elastic_grains_have_their_own_normals_places_and_forces(self):
        self.add_grains()
        with h5py.File(self.run_of_bonds.snapshots[-1], "r+") as file:
            contacts = file["scene/contacts"]
            del contacts["pair"], contacts["force"]
            contacts["pair"], contacts["force"] = [[0, 1], [1, 3]], [4.0, 5.0]
            contacts["normal"], contacts["position"] = [[0.6, 0.8], [0.0, 1.0]], [[1e-3, 2e-3], [3e-3, 4e-3]]
            contacts["total_force"] = 4 * np.array([[0.6, 0.8], [0, 1.25]]) + [[-1.6, 1.2], [-7, 0]]
        table = self.table()
        np.testing.assert_allclose(table["tangential_force[N/m]"], [2, 7])  # along (-0.8, 0.6) and (-1, 0)
        self.assertEqual(table["b"].tolist(), [1, -1])
        self.assertEqual(table["wall"].tolist(), [-1, 1])
        self.assertEqual(table["grain_a"].tolist(), [0, 1])
        np.testing.assert_allclose(table["y[m]"], [2e-3, 4e-3])
        self.assertNotIn("kind_a", table)
        with h5py.File(self.run_of_bonds.snapshots[-1], "r+") as file:
            particles = file["scene/particles"]
            particles["kind"] = (np.array(particles["grain"]).ravel() == 1).astype(int)[:, None]
        table = self.table()
        self.assertEqual(table["kind_a"].tolist(), [0, 1])
        self.assertEqual(table["kind_b"].tolist(), [1, -1])

    def test_a_snapshot_without_contacts_is_named(self):
        with h5py.File(self.run_of_bonds.snapshots[-1], "r+") as file:
            del file["scene/contacts"]
        code, _, err = self.export("--to=contacts")
        self.assertEqual(code, 2)
        self.assertIn("no contacts", err)
        with self.assertRaises(softgrain.NotRecorded):
            contact_table(self.run_of_bonds[-1])


class Paraview(Temporary):
    def setUp(self):
        super().setUp()
        (self.folder / "vtk").mkdir()
        for snapshot in self.run_of_bonds:
            for kind in ("particles", "contacts", "walls"):
                (self.folder / f"vtk/{kind}_{snapshot.step:06d}.vtp").touch()

    def test_the_polygons_of_the_grains_are_read_back_from_their_files(self):
        self.add_grains()
        code, scene, _ = self.export("--to=paraview")
        self.assertEqual(code, 0)
        collection = ElementTree.parse(scene.with_name("grains.pvd")).findall(".//DataSet")
        times = [float(entry.get("timestep")) for entry in collection]
        np.testing.assert_allclose(times, [s.time for s in self.run_of_bonds])
        piece = ElementTree.parse(scene.with_name(collection[-1].get("file"))).find(".//Piece")
        arrays = {a.get("Name"): np.array(a.text.split(), float) for a in piece.iter("DataArray")}
        np.testing.assert_allclose(arrays["position"].reshape(-1, 3)[:4, :2], SQUARE)
        self.assertEqual(arrays["offsets"].tolist(), [4, 8])
        self.assertEqual(arrays["connectivity"].tolist(), list(range(8)))
        last = self.run_of_bonds[-1].particles
        self.assertAlmostEqual(arrays["pressure"][0], last["pressure"][:10].mean(), places=1)
        self.assertEqual(piece.get("NumberOfPolys"), "2")

    def test_every_file_of_every_series_is_there(self):
        _, scene, _ = self.export("--to=paraview")
        for kind in ("particles", "contacts", "walls"):
            entries = ElementTree.parse(scene.with_name(f"{kind}.pvd")).findall(".//DataSet")
            self.assertEqual(len(entries), 3)
            for entry in entries:
                self.assertTrue((scene.parent / entry.get("file")).exists())

    def test_frames_are_found_however_many_digits_their_steps_have(self):
        for folder, kind in (("snap", "s"), *(("vtk", f"{kind}_") for kind in ("particles", "contacts", "walls"))):
            last = max((self.folder / folder).glob(f"{kind}*"))  # as a run of 10^7 steps names it
            last.rename(last.with_name(last.name.replace(kind, f"{kind}00")))
        self.run_of_bonds = softgrain.open(self.folder)
        self.assertEqual([snapshot.step for snapshot in self.run_of_bonds], [0, 11200, 22400])
        _, scene, _ = self.export("--to=paraview")
        for kind in ("particles", "contacts", "walls"):
            entries = ElementTree.parse(scene.with_name(f"{kind}.pvd")).findall(".//DataSet")
            self.assertEqual(len(entries), 3)
            self.assertTrue(all((scene.parent / entry.get("file")).exists() for entry in entries))

    def test_the_script_runs_and_shows_each_series_with_one_range_of_pressures(self):
        """With a stand-in for ParaView that takes every call and writes down the readers and the range."""
        self.add_grains()
        _, scene, _ = self.export("--to=paraview")
        shown, ranges = [], []

        class Thing:
            def __getattr__(self, name):
                return lambda *a, **k: ranges.append(a) if name == "RescaleTransferFunction" else Thing()

        class Module(types.ModuleType):
            def __getattr__(self, name):
                def call(*arguments, **words):
                    if name == "PVDReader":
                        shown.append(words["FileName"])
                    return Thing()
                return call

        sys.modules.update({"paraview": types.ModuleType("paraview"), "paraview.simple": Module("simple")})
        self.addCleanup(lambda: [sys.modules.pop(name) for name in ("paraview", "paraview.simple")])
        exec(compile(scene.read_text(), str(scene), "exec"), {})
        self.assertEqual([Path(path).name for path in shown],
                         ["grains.pvd", "particles.pvd", "contacts.pvd", "walls.pvd"])
        self.assertTrue(all(Path(path).exists() for path in shown))
        np.testing.assert_allclose(ranges[0], pressure_range(list(self.run_of_bonds)), rtol=1e-5)

    @unittest.skipUnless(shutil.which("pvbatch") and shutil.which("xvfb-run"),
                         "ParaView is not here, so this was not tried: tools/install_dependencies.sh --with paraview")
    def test_paraview_draws_the_scene(self):
        folder, program = self.folder.parent, os.environ["SOFTGRAIN_PROGRAM"]
        (folder / "case.toml").write_text("[bpm]\nprimaries = 60\n[loading]\nwall_velocity = '2 m/s'\nmax_strain = 0.05\n"
                                          "unload_at = []\n[output]\nsnapshots = 2\nreport = false\n")
        subprocess.run([program, "run", "case.toml", "-q", "-o", "run"], cwd=folder, check=True)
        self.folder = folder / "run"
        _, scene, _ = self.export("--to=paraview")
        picture, script = folder / "scene.png", folder / "draw.py"
        script.write_text(f"exec(open({str(scene)!r}).read())\nfrom paraview.simple import SaveScreenshot\n"
                          f"view.ViewSize = [600, 400]\nSaveScreenshot({str(picture)!r}, view)\n")
        for _ in range(5):  # on a busy machine xvfb-run may start a program before its server answers
            drawn = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", "pvbatch", script],
                                   capture_output=True, text=True, timeout=300)
            if "bad X server connection" not in drawn.stdout + drawn.stderr:
                break
        else:
            self.skipTest("no X server answers, so ParaView was not tried")
        self.assertEqual(drawn.returncode, 0, drawn.stdout + drawn.stderr)
        pixels = matplotlib.image.imread(picture)[..., :3]
        self.assertTrue((pixels[0, 0] == 1).all())  # white
        red, green, blue = np.moveaxis(pixels, -1, 0)
        self.assertTrue(((red > 2 * green) & (red > 2 * blue)).any())  # tubes
        self.assertTrue(((green > 1.2 * red) & (green > 1.1 * blue)).any())  # the middle of the pressures' range
        self.assertTrue((pixels.max(axis=-1) < 0.2).any())  # walls

    def test_a_run_without_files_for_paraview_is_refused(self):
        for path in (self.folder / "vtk").iterdir():
            path.unlink()
        code, _, err = self.export("--to=paraview")
        self.assertEqual(code, 2)
        self.assertIn("output.vtk", err)


class Outlines(Temporary):
    def test_each_grain_is_a_polygon(self):
        self.add_grains()
        polygons = outlines(self.run_of_bonds[0])
        self.assertEqual([grain for grain, _ in polygons], [0, 1])
        np.testing.assert_array_equal(polygons[0][1], SQUARE)


if __name__ == "__main__":
    unittest.main()
