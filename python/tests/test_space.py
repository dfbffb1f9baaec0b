"""Runs in three dimensions: their figure, and what the other verbs say of them."""

import io
import tempfile
import unittest
from contextlib import redirect_stderr
from pathlib import Path

import h5py
import numpy as np

import softgrain
from softgrain import plot
from softgrain.movie.__main__ import main as movie

COLUMNS = "time[s],strain,stress_bottom[Pa],stress_top[Pa]\n"


def write_run_in_space(folder):
    """A cube in a box of six walls, which is pressed flat from one snapshot to the next."""
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
            file["scene/particles/position"] = position.mean(0)[None]
            file["scene/outlines/position"] = position
            file["scene/surface/quad"] = quad
            file["scene/surface/pressure"] = np.full((6, 1), 1e5 * step)
            file["scene/surface/walls"] = position[quad].reshape(6, 12)
    return folder


class Space(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.run_in_space = softgrain.open(write_run_in_space(folder.name))

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

    def test_verbs_that_know_the_plane_alone_say_so(self):
        words = io.StringIO()
        with redirect_stderr(words):
            self.assertEqual(movie([str(self.run_in_space.path), "-o", str(self.run_in_space.path / "film.gif")]), 2)
        self.assertIn("not yet", words.getvalue())


if __name__ == "__main__":
    unittest.main()
