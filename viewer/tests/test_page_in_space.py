"""The page of a run in three dimensions, in a headless Chromium. Usage: test_page_in_space.py PROGRAM [PICTURE_FOLDER]

Exit code 77, for CTest's "skipped", where there is no Chromium or no Python package to read pictures and snapshots."""

import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

from browser import BrowserTest, require_browser

try:
    import h5py
    import numpy as np
    from matplotlib.image import imread
except ImportError as error:
    print(f"skipped: {error}; tools/install_dependencies.sh installs it")
    sys.exit(77)
require_browser()

PROGRAM = sys.argv[1]
PICTURES = Path(sys.argv[2]) if len(sys.argv) > 2 else None
CASE = """
[experiment]
loading = "isotropic"
model = "mpm"
dimension = 3
[mpm]
cells = 2
[sample]
grains = 6
packing_fraction = 0.35
[loading]
wall_velocity = "4 m/s"
max_strain = 0.3
unload_at = []
[output]
snapshots = 6
samples = 30
vtk = false
"""
STAGE = "document.querySelector('.stage').getBoundingClientRect()"
AZIMUTH, ELEVATION = -62, 18  # of the first view


def directions(azimuth=AZIMUTH, elevation=ELEVATION):
    """Right, up and towards the reader, as `softgrain plot` has them."""
    a, e = np.radians([azimuth, elevation])
    right = np.array([-np.sin(a), np.cos(a), 0])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    return right, np.cross(towards, right), towards


class Page(BrowserTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "case.toml").write_text(CASE)
        subprocess.run([PROGRAM, "run", cls.folder / "case.toml", "-o", cls.folder / "run", "--quiet"], check=True)

    def open(self):
        self.browser.open(self.folder / "run/report.html")
        self.browser.press("End", 35)

    def pixels(self, name):
        """Red, green, blue (0 to 255) of the stage."""
        self.browser.wait("document.body.dataset.drawn === document.body.dataset.frame")
        self.browser.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        path = self.folder / f"{name}.png"
        self.browser.screenshot(path)
        if PICTURES:
            PICTURES.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, PICTURES / f"space-{path.name}")
        picture = 255 * imread(path)[:, :, :3]
        scale = picture.shape[1] / self.browser.run("innerWidth")  # a phone has two pixels for one of CSS
        x, y, width, height = (round(scale * self.browser.run(f"{STAGE}.{side}")) for side in ("x", "y", "width", "height"))
        return picture[y:y + height, x:x + width]

    def choose(self, selector, value):
        self.browser.run(f"(s => {{ s.value = '{value}'; s.dispatchEvent(new Event('change')); s.dispatchEvent(new Event('input')); }})"
                         f"(document.querySelector('{selector}'))")

    def drag(self, dx, dy):
        x, y = self.browser.run(f"(r => [r.x + r.width / 2, r.y + r.height / 2])({STAGE})")
        self.browser.mouse("mouseMoved", x, y)
        self.browser.mouse("mousePressed", x, y, "left")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + dx, y=y + dy, button="left", buttons=1)
        self.browser.mouse("mouseReleased", x + dx, y + dy, "left")

    def address(self):
        time.sleep(0.5)
        return dict(part.split("=") for part in self.browser.run("location.hash.slice(1)").split("&") if part)

    @staticmethod
    def unlike(one, other):
        return (np.abs(one - other).max(axis=2) > 30).mean()

    def test_grains_cover_what_their_vertices_cover_in_the_first_view(self):
        """Where the page paints, against a projection of the snapshot that is made here."""
        self.open()
        self.choose(".colouring", "grain")  # no greys
        picture = self.pixels("whole")
        self.assertEqual(self.browser.errors, [])
        painted = np.ptp(picture, axis=2) > 25
        scene = h5py.File(sorted((self.folder / "run/snap").glob("*.h5"))[-1])["scene"]
        right, up, _ = directions()
        x = scene["outlines/position"][()]
        seen = np.stack([x @ right, -(x @ up)], axis=1)
        rows, columns = np.nonzero(painted)
        width, height = np.ptp(seen, axis=0)
        self.assertAlmostEqual(np.ptp(columns) / np.ptp(rows) / (width / height), 1, delta=0.03)
        # the share of the rectangle that is painted
        grain = scene["outlines/grain"][()].ravel()
        share = np.zeros((200, 200), bool)
        low = seen.min(axis=0)
        place = np.stack(np.meshgrid(np.linspace(0, width, 200), np.linspace(0, height, 200)), axis=-1) + low
        for g in np.unique(grain):
            rim = seen[grain == g]
            angles = np.linspace(0, 2 * np.pi, 60)  # by its support function
            normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
            inside = np.all([place @ n <= (rim @ n).max() for n in normals], axis=0)
            share |= inside
        self.assertAlmostEqual(painted.sum() / (np.ptp(columns) * np.ptp(rows)), share.mean(), delta=0.05)

    def test_dragging_turns_the_packing_and_the_button_turns_it_back(self):
        self.open()
        before = self.pixels("first view")
        self.drag(200, 60)
        turned = self.pixels("turned")
        self.assertGreater(self.unlike(before, turned), 0.1)
        camera = [float(x) for x in self.address()["camera"].replace("%2C", ",").split(",")]
        np.testing.assert_allclose(camera, [AZIMUTH - 0.4 * 200, ELEVATION + 0.4 * 60, 1], atol=0.5)
        self.browser.run("document.querySelector('.space button').click()")
        self.assertLess(self.unlike(before, self.pixels("back")), 1e-3)

    def test_a_cut_leaves_out_what_lies_before_it(self):
        self.open()
        whole = self.pixels("uncut")
        self.choose(".cut", "z")
        cut = self.pixels("cut")
        painted = [(np.ptp(p, axis=2) > 25) for p in (whole, cut)]
        self.assertGreater(self.unlike(whole, cut), 0.05)
        tops = [np.nonzero(p)[0].min() for p in painted]
        self.assertGreater(tops[1] - tops[0], 0.2 * np.ptp(np.nonzero(painted[0])[0]))  # half of the height is gone
        self.assertEqual(self.address()["cut"], "z,0.5")

    def test_colours_can_be_chosen_and_chains_show_through_glass(self):
        self.open()
        pictures = []
        for key in ("pressure", "volume", "contacts", "grain", "J", "stress"):
            self.choose(".colouring", key)
            pictures.append(self.pixels(key))
        for one, other in zip(pictures, pictures[1:]):
            self.assertGreater(self.unlike(one, other), 0.03)
        red = lambda p: ((p[:, :, 0] > 150) & (p[:, :, 1] < 90) & (p[:, :, 2] < 110)).sum()  # noqa: E731
        before = red(pictures[-1])
        self.browser.run("document.querySelector('.chains input').click()")
        self.assertGreater(red(self.pixels("chains")), before + 500)
        self.assertIn(" N", self.browser.run("document.querySelector('.force').textContent"))
        self.assertEqual(self.browser.errors, [])

    def test_pointer_over_a_grain_shows_its_volume(self):
        self.open()
        x, y = self.browser.run(f"(r => [r.x + r.width / 2, r.y + r.height / 2])({STAGE})")
        self.browser.mouse("mouseMoved", x, y)
        lines = self.browser.run("[...document.querySelectorAll('.tip div')].map(d => d.textContent)")
        grain = int(lines[0].split()[-1])
        scene = h5py.File(sorted((self.folder / "run/snap").glob("*.h5"))[-1])["scene"]
        quads = scene["surface/quad"][()][scene["surface/grain"][()].ravel() == grain]
        a, b, c, d = (scene["outlines/position"][()][quads[:, k]] for k in range(4))
        volume = sum(np.einsum("qi,qi->", a, np.cross(u, v)) / 6 for u, v in ((b, c), (c, d)))
        (shown,) = [line for line in lines if line.startswith("volume")]
        self.assertAlmostEqual(float(shown.removeprefix("volume").split()[0]) / (1e9 * volume), 1, delta=0.01)

    def test_one_finger_turns_and_two_magnify_on_a_phone(self):
        self.browser.resize(390, 844, phone=True)
        self.open()
        x, y = self.browser.run(f"(r => [r.x + r.width / 2, r.y + r.height / 2])({STAGE})")
        pictures = [self.pixels("phone")]
        self.browser.fingers("touchStart", (x, y))
        for step in (10, 40, 80):
            self.browser.fingers("touchMove", (x + step, y))
        self.browser.fingers("touchEnd")
        pictures.append(self.pixels("phone turned"))
        self.browser.fingers("touchStart", (x - 20, y), (x + 20, y))
        for reach in (30, 60):
            self.browser.fingers("touchMove", (x - reach, y), (x + reach, y))
        self.browser.fingers("touchEnd")
        pictures.append(self.pixels("phone magnified"))
        for one, other in zip(pictures, pictures[1:]):
            self.assertGreater(self.unlike(one, other), 0.05)
        self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 390)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
