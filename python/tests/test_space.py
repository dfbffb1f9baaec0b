"""Runs in three dimensions: their figure, their film, and what other programs get of them."""

import contextlib
import io
import itertools
import re
import sys
import tempfile
import types
import unittest
import unittest.mock
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np

import softgrain
from softgrain import plot, solids, view
from softgrain.export.__main__ import main as export
from softgrain.export.contacts import contact_table
from softgrain.export.particles import write_xyz
from softgrain.movie import film_of
from softgrain.movie.__main__ import main as movie

from small_runs import small_run

COLUMNS = "time[s],strain,stress_bottom[Pa],stress_top[Pa]\n"


def write_run_in_space(folder):
    """A cube in a box of six walls, which is pressed flat from one snapshot to the next; it pushes on the floor."""
    folder = Path(folder)
    (folder / "case.toml").write_text('[experiment]\nmodel = "mpm"\nloading = "isotropic"\ndimension = 3\n')
    (folder / "series.csv").write_text(COLUMNS + "0,0,0,0\n1,0.1,1e5,1e5\n2,0.2,2e5,2e5\n")
    (folder / "snap").mkdir()
    corner = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
    quad = np.array([[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    for step in range(3):
        position = corner * (1, 1, 1 - 0.1 * step)
        with h5py.File(folder / "snap" / f"s{step:06d}.h5", "w") as file:
            file.attrs["step"], file.attrs["time"] = step, float(step)
            scene = {"particles/position": position.mean(0)[None], "particles/radius": [0.5], "particles/grain": [0],
                     "outlines/position": position, "outlines/grain": np.zeros(8, int),
                     "surface/quad": quad, "surface/grain": np.zeros((6, 1), int),
                     "surface/pressure": np.full((6, 1), 1e5 * step), "surface/walls": position[quad].reshape(6, 12),
                     "contacts/pair": [[0, 1]], "contacts/force": [[2.0]], "contacts/total_force": [[0.6, 0.8, -2.0]],
                     "contacts/normal": [[0.0, 0, -1]], "contacts/position": [[0.5, 0.5, 0]]}
            for name, values in scene.items():
                file[f"scene/{name}"] = values
    return folder


class InSpace(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.run_in_space = softgrain.open(write_run_in_space(folder.name))


class BondedSpheres(unittest.TestCase):
    """Grains whose particles are their primaries."""

    def test_surfaces_are_drawn_and_hold_the_primaries(self):
        run = small_run("bonded_spheres")
        last = run[-1]
        self.assertEqual(len(run.plot.grain().axes), len(run) + 1 if len(run) < 4 else 5)
        corners, grain = solids.triangles(last)
        volume = np.bincount(grain, np.einsum("ti,ti->t", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)
        filled = np.bincount(last.particles["grain"], 4 / 3 * np.pi * last.particles["radius"] ** 3)
        share = filled / volume  # a dense packing, whose pores the surface closes
        self.assertTrue(((share > 0.5) & (share < 0.95)).all(), share)
        self.assertFalse(solids.of_grains(last))

    def test_other_programs_get_primaries_as_spheres_and_contacts_of_grains(self):
        run = small_run("bonded_spheres")
        text = io.StringIO()
        write_xyz([run[-1]], text)
        lines = text.getvalue().splitlines()
        self.assertEqual(len(lines), 2 + 80)
        self.assertNotIn("aspherical_shape", lines[1])
        table = contact_table(run[-1])
        self.assertTrue((table["grain_a"] < 4).all() and len(table["a"]) > 4)
        self.assertTrue((table["normal_force"] > 0).all())


class Pictures(InSpace):
    def test_a_panel_shows_the_faces_that_look_at_us_the_farthest_first(self):
        with plot.style():
            figure = plot.draw_space(self.run_in_space)
        panels = figure.axes[:3]
        for axes in panels:
            faces = axes.collections[-1].get_paths()
            self.assertEqual(len(faces), 3)  # a cube shows three faces
        texts = [text.get_text() for text in figure.texts]
        self.assertTrue(any("0.100" in text for text in texts), texts)

    def test_a_run_in_space_draws_surfaces_by_its_own_name(self):
        self.assertTrue(self.run_in_space.in_space)
        self.assertEqual(len(self.run_in_space.plot.grain().axes), 4)  # three panels and the key

    def test_a_film_has_a_frame_for_each_snapshot_at_one_scale_and_marks_the_curve(self):
        with plot.style():
            film = film_of(self.run_in_space, 480)
            frames = list(film)
        self.assertEqual({frame.shape for frame in frames}, {(270, 480, 3)})
        heights = []
        for frame in frames:  # the cube is seen from slightly above: its top edge sinks by the strain
            coloured = np.ptp(frame[:, 20:280].astype(int), axis=2).max(axis=1) > 15
            heights.append(np.flatnonzero(coloured)[0])
        sunk = 0.1 * np.cos(view.ELEVATION) * film.panel.scale * 480 / 180  # pixels
        np.testing.assert_allclose(np.diff(heights), sunk, atol=1.1)
        (x,), (y,) = film.point.get_data()
        self.assertEqual((x, y), (0.2, 0.2))

    def test_the_verb_writes_a_film(self):
        path = self.run_in_space.path / "film.gif"
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(movie([str(self.run_in_space.path), "-o", str(path), "--width=160"]), 0)
        self.assertEqual(path.read_bytes()[:3], b"GIF")


class Files(InSpace):
    def export(self, form, *words):
        path = self.run_in_space.path / f"out.{form}"
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(export([str(self.run_in_space.path), f"--to={form}", "-o", str(path), *words]), 0)
        return path.read_text().splitlines()

    def test_extended_xyz_has_a_particle_a_grain_in_the_box_of_the_walls(self):
        lines = self.export("xyz")
        self.assertEqual(len(lines), 9)
        for step in range(3):
            comment, row = lines[3 * step + 1], lines[3 * step + 2].split()
            self.assertIn("species:S:1:pos:R:3:radius:R:1:grain:I:1:pressure:R:1:aspherical_shape:R:3:orientation:R:4 ", comment)
            height = 1 - 0.1 * step
            lattice = np.array(re.search('Lattice="([^"]*)"', comment)[1].split(), float).reshape(3, 3)
            np.testing.assert_allclose(lattice, np.diag([1, 1, height]))
            np.testing.assert_allclose(np.array(row[1:4], float), (0.5, 0.5, height / 2))
            self.assertAlmostEqual(float(row[6]), 1e5 * step)
            axes = np.array(row[7:10], float)  # a block's semi-axes are in the ratio of its edges
            np.testing.assert_allclose(axes / axes[0], [1, 1, height], rtol=1e-6)

    def test_a_drawing_has_the_faces_that_look_at_us_at_one_scale_over_the_run(self):
        tops, colours = [], []
        for frame in range(3):
            root = ElementTree.fromstring("\n".join(self.export("svg", f"--frame={frame}")))
            shapes = root.findall("{*}polygon")
            edges = [shape for shape in shapes if shape.get("fill") == "none"]
            faces = [shape for shape in shapes if shape.get("fill") != "none"]
            self.assertEqual((len(edges), len(faces)), (6, 3))
            points = np.array([[point.split(",") for point in face.get("points").split()] for face in faces], float)
            tops.append(points[:, :, 1].min())
            colours.append({face.get("fill") for face in faces})
            self.assertIn("pressure [kPa]", [text.text for text in root.findall("{*}text")])
        width = np.ptp(points[:, :, 0])  # of a cube of edge 1, seen from the side: |sin a| + |cos a|
        pixels = width / (abs(np.sin(view.AZIMUTH)) + abs(np.cos(view.AZIMUTH)))
        np.testing.assert_allclose(np.diff(tops), 0.1 * np.cos(view.ELEVATION) * pixels, atol=0.02)
        self.assertEqual(len(set.union(*colours)), 9)  # three pressures, each in the light of three faces

    def test_paraview_gets_a_scene_of_the_surfaces(self):
        """With a stand-in for ParaView that takes every call and writes down the readers and what is set."""
        folder = self.run_in_space.path / "vtk"
        folder.mkdir()
        for kind, step in itertools.product(("surfaces", "contacts", "walls"), range(3)):
            (folder / f"{kind}_{step:06d}.vtp").touch()
        with contextlib.redirect_stdout(io.StringIO()) as words:
            self.assertEqual(export([str(self.run_in_space.path), "--to=paraview"]) or 0, 0)
        scene, shown, eye = Path(words.getvalue().strip()), [], []

        class Thing:
            def __getattr__(self, name):
                return lambda *a, **k: Thing()

            def __setattr__(self, name, value):
                if name == "CameraPosition":
                    eye.append(value)

        class Module(types.ModuleType):
            def __getattr__(self, name):
                return lambda *a, **k: (shown.append(Path(k["FileName"])) if name == "PVDReader" else None, Thing())[1]

        with unittest.mock.patch.dict(sys.modules, {"paraview": types.ModuleType("paraview"), "paraview.simple": Module("simple")}):
            exec(compile(scene.read_text(), str(scene), "exec"), {})
        self.assertEqual([path.name for path in shown], ["surfaces.pvd", "contacts.pvd", "walls.pvd"])
        np.testing.assert_allclose(eye[0], view.directions()[2], atol=1e-5)
        for path in shown:
            entries = ElementTree.parse(path).findall(".//DataSet")
            self.assertEqual([float(entry.get("timestep")) for entry in entries], [0, 1, 2])
            self.assertTrue(all((path.parent / entry.get("file")).exists() for entry in entries))

    def test_a_dump_and_tables_have_three_coordinates(self):
        dump = self.export("lammps", "--frame=-1")
        self.assertEqual(dump[4], "ITEM: BOX BOUNDS ff ff ff")
        np.testing.assert_allclose([line.split() for line in dump[5:8]] and float(dump[7].split()[1]), 0.8)
        self.assertEqual(self.export("csv")[0], "x[m],y[m],z[m],grain,radius[m]")
        header, row = self.export("contacts")
        table = dict(zip(header.split(","), map(float, row.split(","))))
        self.assertEqual([table[name] for name in ("a", "b", "wall", "normal_z", "z[m]")], [0, -1, 0, -1, 0])
        self.assertEqual([table[f"force_{axis}[N]"] for axis in "xyz"], [0.6, 0.8, -2])
        self.assertAlmostEqual(table["tangential_force[N]"], 1)
        self.assertEqual(table["normal_force[N]"], 2)

    def test_a_cell_that_repeats_is_said_to(self):
        for path in self.run_in_space.snapshots:
            with h5py.File(path, "r+") as file:
                file["scene/cell"] = np.diag([1.0, 1.0, 0.0])
        self.assertIn('pbc="T T F"', self.export("xyz")[1])
        self.assertEqual(self.export("lammps")[4], "ITEM: BOX BOUNDS pp pp ff")
        self.assertEqual(self.run_in_space[0].images().shape, (9, 3))


class Ellipsoids(unittest.TestCase):
    def test_a_turned_block_has_its_axes_and_its_turn(self):
        """Against the closed form: moments of a block a x b x c are a^2/12; a quaternion turns its axes back."""
        with tempfile.TemporaryDirectory() as folder:
            snapshot = softgrain.open(write_run_in_space(folder))[0]
        axis, angle = np.array([1, 2, 2]) / 3, 0.7
        K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        turn = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
        edges = np.array([3.0, 2.0, 1.0])
        snapshot.outlines["position"][:] = (snapshot.outlines["position"] * edges + (5, -4, 3)) @ turn.T
        volume, centre, tensor = solids.moments(snapshot)
        self.assertAlmostEqual(volume[0], 6)
        np.testing.assert_allclose(centre[0], turn @ (edges / 2 + (5, -4, 3)))
        np.testing.assert_allclose(tensor[0], turn @ np.diag(edges**2 / 12) @ turn.T, atol=1e-12)
        axes, quaternion = solids.ellipsoids(snapshot)
        np.testing.assert_allclose(axes[0] / axes[0, 2], edges)
        x, y, z, w = quaternion[0]
        u = np.array([x, y, z])
        turned = np.array([(w * w - u @ u) * e + 2 * (u @ e) * u + 2 * w * np.cross(u, e) for e in np.eye(3)])
        np.testing.assert_allclose(abs(np.sum(turned * turn.T, axis=1)), 1, atol=1e-12)


    def test_a_sphere_of_few_quads_has_its_own_radius(self):
        with tempfile.TemporaryDirectory() as folder:
            snapshot = softgrain.open(write_run_in_space(folder))[0]
        snapshot.outlines["position"][:] -= 0.5  # the corners of a cube lie on a sphere of radius sqrt(3)/2
        snapshot.particles["position"][:] = 0.1
        axes, _ = solids.ellipsoids(snapshot)
        np.testing.assert_allclose(axes[0], np.sqrt(3) / 2)


if __name__ == "__main__":
    unittest.main()
