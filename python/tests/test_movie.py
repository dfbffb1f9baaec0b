"""Films of both models: a frame for each snapshot, one scale for all, the clock and the point where the run then was."""

import contextlib
import io
import json
import shutil
import subprocess
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy as np
import synthetic
from PIL import Image
from small_runs import CASES, small_run

import softgrain
from softgrain import colours, measure, plot
from softgrain.movie import Film, encode
from softgrain.movie.__main__ import main


def movie(*arguments):
    """(exit code, path that was printed, stderr)."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main([*map(str, arguments)])
    return code, Path(out.getvalue().strip()), err.getvalue()


def film_of(run, width=480):
    with plot.style():
        return Film(run, width)


class Frames(unittest.TestCase):
    def test_each_snapshot_is_a_frame_of_one_size_and_no_two_are_the_same(self):
        for name in CASES:
            with self.subTest(name):
                film = film_of(small_run(name))
                frames = list(film)
                self.assertEqual(len(frames), len(small_run(name)))
                self.assertEqual({frame.shape for frame in frames}, {(270, 480, 3)})
                self.assertEqual(len({frame.tobytes() for frame in frames}), len(frames))

    def test_the_point_is_where_the_series_is_at_the_time_of_the_snapshot(self):
        for name in CASES:
            run = small_run(name)
            film, series = film_of(run), run.series
            stress = np.interp(run.times, series["time"], measure.vertical_stress(series))
            strain = np.interp(run.times, series["time"], series["strain"])
            for k in (len(run) - 1, 1):  # also backwards
                film[k]
                (x,), (y,) = film.point.get_data()
                self.assertAlmostEqual(x, strain[k], places=9)
                self.assertAlmostEqual(y, stress[k] / 1e6, places=9)
                self.assertEqual(len(film.past.get_xdata()), np.count_nonzero(series["time"] <= run.times[k]))
                self.assertIn(f"{strain[k]:.3f}", film.clock.get_text())

    def test_a_colour_means_the_same_pressure_in_every_frame(self):
        """What the frames are painted with is the range of all of them: a frame's pressures, told from its colours."""
        run = small_run("elastic")
        film = film_of(run)
        pressures = np.concatenate([run[k].particles["pressure"].reshape(-1, 4).mean(axis=1)
                                    for k in range(1, len(run))])  # the first is before the first contact
        map, *ends = colours.range_of(pressures)
        self.assertEqual(film.pressure.range.map, map)
        np.testing.assert_allclose(film.pressure.range[1:], ends)
        for k in (1, 4):
            film[k]
            painted = film.axes.collections[0].get_facecolor()[:, :3]
            expected = run[k].particles["pressure"].reshape(-1, 4).mean(axis=1)
            np.testing.assert_allclose(painted, film.pressure.range.rgb(expected), atol=1e-12)

    def test_the_picture_holds_every_snapshot_at_one_scale(self):
        """The wall that moves is a dark bar; from frame to frame it moves by the strain's share of the pixels."""
        run = small_run("elastic")
        film = film_of(run, 1280)
        column = round((film.panel.frame.x0 + film.panel.frame.x1) / 2 / 180 * 1280)
        tops = [np.flatnonzero((frame[40:, column] < 60).all(axis=1))[0] for frame in film]
        heights = [np.ptp(run[k].walls[:, 1]) for k in range(len(run))]
        pixels = film.panel.scale * 1280 / 180  # of a metre
        np.testing.assert_allclose(np.diff(tops), -np.diff(heights) * pixels, atol=2)
        self.assertGreater(tops[-1] - tops[0], 40)

    def test_chains_are_drawn_over_pressures_where_there_are_any(self):
        for name, kinds in (("bonded", 4), ("packing", 5), ("elastic", 4)):  # surface, rims of cells, chains, edges, walls
            film = film_of(small_run(name))
            film[len(film) - 1]
            self.assertEqual(len(film.axes.collections), kinds, name)
            self.assertEqual(film.forces is None, name == "elastic")

    def test_a_run_without_a_curve_has_its_picture_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            run = softgrain.open(synthetic.write_run(Path(folder) / "run", columns=("time[s]", "something_new[K]")))
            film = film_of(run)
            self.assertIsNone(film.point)
            self.assertEqual(len(list(film)), len(run))


class Files(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_a_webp_has_every_frame_rests_at_the_last_and_says_where_it_comes_from(self):
        run = small_run("bonded")
        code, path, _ = movie(run.path, "-o", self.folder / "squeeze.webp", "--fps=10", "--width=200")
        self.assertEqual(code, 0)
        film = film_of(run, 600)  # which then is made smaller
        with Image.open(path) as image:
            self.assertEqual((image.n_frames, image.size), (len(run), (200, 112)))
            self.assertIn("softgrain ", image.getexif()[encode.IMAGE_DESCRIPTION])
            for k in (0, len(run) - 1):
                image.seek(k)
                image.load()
                self.assertEqual(image.info["duration"], 100 if k == 0 else encode.LAST)
                expected = np.asarray(Image.fromarray(film[k]).resize(image.size, Image.BOX), int)
                off = abs(np.asarray(image.convert("RGB")) - expected)
                self.assertLess(off.mean(), 5)  # of 255

    def test_a_gif_has_every_frame_in_the_colours_of_the_key_and_says_where_it_comes_from(self):
        run = small_run("bonded")
        code, path, _ = movie(run.path, "-o", self.folder / "squeeze.gif", "--fps=10", "--width=400")
        film = film_of(run, 400)
        self.assertEqual(code, 0)
        with Image.open(path) as image:
            self.assertEqual((image.n_frames, image.size, image.info["duration"]), (len(run), (400, 224), 100))
            self.assertIn(b"softgrain ", image.info["comment"])
            self.assertIn(b"case sha256", image.info["comment"])
            for k in (0, len(run) - 1):
                image.seek(k)
                off = abs(np.asarray(image.convert("RGB")).astype(int) - film[k])
                self.assertLess(off.mean(), 1.5)  # of 255
                self.assertEqual(off[1, 1].max(), 0)  # the paper is white
        self.assertEqual([file.name for file in self.folder.iterdir()], ["squeeze.gif"])

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not here, so no MP4 was tried: tools/install_dependencies.sh --with movie")
    def test_an_mp4_of_each_model_is_decoded_to_its_frames(self):
        for name in CASES:
            run = small_run(name)
            code, path, err = movie(run.path, "-o", self.folder / "new" / f"{name}.mp4", "--width=640")
            self.assertEqual(code, 0, err)
            words = ["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-show_format", "-of", "json", path]
            told = json.loads(subprocess.run(words, capture_output=True, check=True).stdout)
            stream = told["streams"][0]
            self.assertEqual([stream[key] for key in ("codec_name", "pix_fmt", "width", "height", "nb_read_frames")],
                             ["h264", "yuv420p", 640, 360, str(len(run))])
            self.assertIn("case sha256", told["format"]["tags"]["comment"])
            raw = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                                 capture_output=True, check=True).stdout
            decoded = np.frombuffer(raw, np.uint8).reshape(-1, 360, 640, 3)
            for shown, drawn in zip(decoded, film_of(run, 640)):
                self.assertLess(abs(shown.astype(int) - drawn).mean(), 3)

    def test_without_ffmpeg_the_frames_are_png_files_and_the_command_is_told(self):
        run = small_run("elastic")
        with unittest.mock.patch.object(encode, "FFMPEG", "no-such-ffmpeg"):
            code, folder, err = movie(run.path, "-o", self.folder / "talk.mp4", "--width=320")
        self.assertEqual((code, folder), (0, self.folder / "talk"))
        self.assertIn("apt install ffmpeg", err)
        self.assertIn(f"{folder}/frame_%05d.png", err)
        self.assertEqual(sorted(file.name for file in folder.iterdir()), [f"frame_{k:05}.png" for k in range(len(run))])
        with Image.open(folder / "frame_00002.png") as image:
            self.assertEqual(image.size, (320, 180))

    def test_an_ffmpeg_that_fails_is_quoted_and_leaves_nothing_behind(self):
        false = self.folder / "false"
        false.write_text("#!/bin/sh\necho no room >&2\nexit 1\n")
        false.chmod(0o755)
        with unittest.mock.patch.object(encode, "FFMPEG", str(false)):
            code, _, err = movie(small_run("elastic").path, "-o", self.folder / "talk.mp4", "--width=320")
        self.assertEqual(code, 4)
        self.assertIn("no room", err)
        self.assertEqual([file.name for file in self.folder.iterdir()], ["false"])

    def test_mistakes_end_with_2_and_the_remedy(self):
        code, _, err = movie(small_run("elastic").path, "-o", self.folder / "talk.avi")
        self.assertEqual(code, 2)
        self.assertIn(".mp4, .gif or .webp", err)
        code, _, err = movie(synthetic.write_run(self.folder / "empty", snapshots=0), "-o", self.folder / "talk.gif")
        self.assertEqual(code, 2)
        self.assertIn("no snapshots", err)
        self.assertEqual(movie(self.folder / "nothing", "-o", self.folder / "talk.gif")[0], 2)


if __name__ == "__main__":
    unittest.main()
