"""The page that `softgrain report` writes, in a headless Chromium. Usage: test_page.py PROGRAM [PICTURE_FOLDER]

Exit code 77, for CTest's "skipped", where there is no Chromium or no Python package to read pictures and snapshots."""

import base64
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
SMALL = {
    "compaction-mpm": ["sample.grains=16", "sample.packing_fraction=0.6", "mpm.cells=4", "output.snapshots=10"],
    "diametral-bpm": ["bpm.primaries=100", "loading.max_strain=0.1", "loading.unload_at=[]", "output.snapshots=6"],
}
STAGE = "document.querySelector('.stage').getBoundingClientRect()"
DOT = "document.querySelectorAll('.dot')[{}].getBoundingClientRect()"


def make_runs(folder):
    """One small run of each kind, and the pages of each and of both."""
    for template, settings in SMALL.items():
        case = subprocess.run([PROGRAM, "new", folder / template, "--template", template], check=True, text=True,
                              capture_output=True).stdout.strip()
        sets = [word for setting in [*settings, "output.vtk=false"] for word in ("--set", setting)]
        subprocess.run([PROGRAM, "run", case, "-o", folder / template / "run", "--quiet", *sets], check=True)
    shutil.copytree(folder / "compaction-mpm" / "run", folder / "soft")
    shutil.copytree(folder / "diametral-bpm" / "run", folder / "bonded")
    subprocess.run([PROGRAM, "report", folder / "soft", folder / "bonded", "-o", folder / "both.html"], check=True,
                   capture_output=True)


class Page(BrowserTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        make_runs(cls.folder)

    def open(self, page="compaction-mpm/run/report.html"):
        self.browser.open(self.folder / page)

    def frame(self):
        return int(self.browser.run("document.body.dataset.frame"))

    def settle(self):
        """Until the picture is that of the frame."""
        self.browser.wait("document.body.dataset.drawn === document.body.dataset.frame")
        self.browser.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def pixels(self, name="page", of=None):
        """Red, green, blue (0 to 255) of the window, or of an element's rectangle in it."""
        self.settle()
        path = self.folder / f"{name}.png"
        self.browser.screenshot(path)
        if PICTURES:
            PICTURES.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, PICTURES)
        picture = 255 * imread(path)[:, :, :3]
        if of is None:
            return picture
        x, y, width, height = (round(self.browser.run(f"{of}.{side}")) for side in ("x", "y", "width", "height"))
        return picture[y:y + height, x:x + width]

    def snapshot(self, index, run="compaction-mpm/run"):
        return h5py.File(sorted((self.folder / run / "snap").glob("*.h5"))[index])

    def test_says_nothing_and_asks_for_nothing(self):
        for page in ("compaction-mpm/run/report.html", "diametral-bpm/run/report.html", "both.html"):
            self.open(page)
            self.browser.press("End", 35)
            self.settle()
        self.assertEqual(self.browser.errors, [])
        self.assertEqual([url for url in self.browser.requests if not url.startswith("file://")], [])
        self.assertEqual(len(self.browser.requests), 3)  # the pages themselves

    def test_slider_moves_the_picture_and_the_dots(self):
        self.open()
        self.browser.press("Home", 36)
        before, dot = self.pixels("first", STAGE), self.browser.run(DOT.format(0) + ".x")
        slider = {side: self.browser.run(f"document.querySelector('.slider').getBoundingClientRect().{side}")
                  for side in ("x", "y", "width", "height")}
        middle = slider["y"] + slider["height"] / 2
        self.browser.mouse("mousePressed", slider["x"] + slider["width"] - 3, middle, "left")
        self.browser.mouse("mouseReleased", slider["x"] + slider["width"] - 3, middle, "left")
        self.assertEqual(self.frame(), 10)
        after = self.pixels("last", STAGE)
        changed = np.abs(after - before).max(axis=2) > 40
        self.assertGreater(changed.mean(), 0.1)
        self.assertGreater(self.browser.run(DOT.format(0) + ".x"), dot + 300)

    def test_lid_is_drawn_where_it_is(self):
        """The rows of the lid in the picture are as far apart, over the box's width, as in the snapshots."""
        rows, heights = [], []
        for key, code, index in (("Home", 36, 0), ("End", 35, -1)):
            self.open()
            self.browser.press(key, code)
            dark = self.pixels("lid", STAGE).max(axis=2) < 90
            width = dark.any(axis=0).nonzero()[0]
            rows.append((dark.mean(axis=1) > 0.5).nonzero()[0].min())
            walls = self.snapshot(index)["scene/walls"][()]
            heights.append(walls[:, [1, 3]].max())
            metre = (width.max() - width.min()) / np.ptp(walls[:, [0, 2]])
        self.assertAlmostEqual(rows[1] - rows[0], (heights[0] - heights[1]) * metre, delta=4)

    def test_keyboard_steps_and_plays(self):
        self.open()
        self.browser.press("Home", 36)
        for key, code, frame in (("ArrowRight", 39, 1), ("ArrowRight", 39, 2), ("ArrowLeft", 37, 1), ("End", 35, 10),
                                 ("ArrowRight", 39, 10), ("Home", 36, 0)):
            self.browser.press(key, code)
            self.assertEqual(self.frame(), frame, key)
        self.browser.press(" ", 32, " ")
        self.browser.wait("document.body.dataset.frame === '10'", 20)

    def test_click_on_a_curve_goes_to_that_time(self):
        self.open()
        for share, frame in ((0.995, 10), (0.5, 5), (0.02, 0)):
            over = "document.querySelector('.u-over').getBoundingClientRect()"
            x, y = (self.browser.run(f"{over}.{a} + {s} * {over}.{side}")
                    for a, side, s in (("x", "width", share), ("y", "height", 0.9)))
            self.browser.mouse("mousePressed", x, y, "left")
            self.browser.mouse("mouseReleased", x, y, "left")
            self.assertAlmostEqual(self.frame(), frame, delta=2)

    def test_dot_lies_at_the_numbers_of_the_series(self):
        self.open()
        self.browser.press("End", 35)
        header, *_, last = (self.folder / "compaction-mpm/run/series.csv").read_text().splitlines()
        row = dict(zip([name.split("[")[0] for name in header.split(",")], map(float, last.split(","))))
        reading = self.browser.run("document.querySelector('figcaption output').textContent")
        stress, strain = reading.split(" at ")
        value, unit = stress.split()
        self.assertAlmostEqual(float(value) * {"kPa": 1e3, "MPa": 1e6, "Pa": 1}[unit] / row["stress_top"], 1, delta=0.01)
        self.assertAlmostEqual(float(strain), row["strain"], delta=0.001)

    def test_pointer_over_a_grain_shows_its_area(self):
        self.open()
        self.browser.press("End", 35)
        self.settle()
        scene = self.snapshot(-1)["scene"]
        outline, owner = scene["outlines/position"][()], scene["outlines/grain"][()]
        x, y = self.browser.run(f"(r => [r.x + r.width / 2, r.y + 0.7 * r.height])({STAGE})")
        self.browser.mouse("mouseMoved", x, y)
        lines = self.browser.run("[...document.querySelectorAll('.tip div')].map(d => d.textContent)")
        grain = int(lines[0].split()[-1])
        a = outline[owner == grain]
        b = np.roll(a, -1, axis=0)
        area = 1e6 * abs(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])) / 2
        shown = float(next(line for line in lines if line.startswith("area")).removeprefix("area").split()[0])
        self.assertAlmostEqual(shown / area, 1, delta=0.006)

    def test_dark_and_light(self):
        self.browser.prefer("dark")
        self.open()
        self.assertLess(self.pixels("dark")[5, 5].max(), 60)
        self.browser.run("document.querySelector('.theme').click()")
        self.assertGreater(self.pixels("light")[5, 5].min(), 200)

    def test_colours_and_chains_can_be_chosen(self):
        self.open()
        self.browser.press("End", 35)
        pictures = []
        for key in ("pressure", "area", "contacts", "grain"):
            self.browser.run(f"(s => {{ s.value = '{key}'; s.dispatchEvent(new Event('change')); }})"
                             "(document.querySelector('.colouring'))")
            pictures.append(self.pixels(key, STAGE))
        for one, other in zip(pictures, pictures[1:]):
            self.assertGreater((np.abs(one - other).max(axis=2) > 20).mean(), 0.1)
        self.browser.run("document.querySelector('.chains input').click()")
        red = lambda p: ((p[:, :, 0] > 180) & (p[:, :, 1] < 90) & (p[:, :, 2] < 110)).sum()  # noqa: E731
        self.assertGreater(red(pictures[-1]), red(self.pixels("plain", STAGE)) + 500)

    def test_opens_where_the_packing_is_most_compressed(self):
        self.open()
        self.assertEqual(self.frame(), 10)
        self.assertIn("snapshot 11 of 11", self.browser.run("document.querySelector('.now').textContent"))

    def test_range_of_the_colours_is_that_of_softgrain_plot_and_can_be_typed(self):
        """Two programs, one rule: the page's legend against `softgrain.colours` over the snapshots."""
        sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
        import softgrain
        from softgrain import colours, picture

        self.open()
        self.browser.run("(s => { s.value = 'pressure'; s.dispatchEvent(new Event('change')); })"
                         "(document.querySelector('.colouring'))")
        self.settle()
        ends = "[...document.querySelectorAll('.ticks input')].map(i => i.value.replace('−', '-'))"
        unit = self.browser.run("document.querySelector('.legend span').textContent").split("[")[1].rstrip("]")
        low, high = (float(end) * {"Pa": 1, "kPa": 1e3, "MPa": 1e6}[unit] for end in self.browser.run(ends))
        run = softgrain.open(self.folder / "compaction-mpm/run")
        snapshots = [run[i] for i in colours.sampled(len(run)) if picture.has_forces(run[i])]
        found = colours.range_of(np.concatenate([picture.surface(s, s.particles["pressure"]).values for s in snapshots]))
        reach = max(-found.low, found.high)
        self.assertAlmostEqual(low / reach, found.low / reach, delta=0.01)
        self.assertAlmostEqual(high / reach, found.high / reach, delta=0.01)
        before = self.pixels("untyped", STAGE)
        self.browser.run("(i => { i.value = '1'; i.dispatchEvent(new Event('change')); })"
                         "(document.querySelector('.ticks input:last-child'))")
        self.assertEqual(self.browser.run(ends)[1], "1")
        self.assertGreater((np.abs(self.pixels("typed", STAGE) - before).max(axis=2) > 20).mean(), 0.05)

    def test_every_field_of_the_points_is_offered(self):
        self.open()
        names = "[...document.querySelector('.colouring').options].map(o => o.value)"
        self.assertLessEqual({"pressure", "J", "stress", "area", "contacts", "grain"}, set(self.browser.run(names)))
        self.open("diametral-bpm/run/report.html")
        self.assertLessEqual({"pressure", "coordination", "velocity"}, set(self.browser.run(names)))

    def test_the_picture_is_saved_with_its_caption_and_scale(self):
        self.open()
        self.settle()
        self.browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(self.folder / "saved"))
        self.browser.run("document.querySelector('.save').click()")
        saved = self.folder / "saved"
        self.browser.until(lambda: list(saved.glob("*.png")))
        picture = 255 * imread(next(saved.glob("*.png")))[:, :, :3]
        if PICTURES:
            shutil.copy(next(saved.glob("*.png")), PICTURES / "saved.png")
        self.assertEqual(picture.shape[1], 2000)
        middle = picture[picture.shape[0] // 3:picture.shape[0] // 2, 500:1500]
        self.assertGreater(middle.std(axis=(0, 1)).max(), 20)  # the packing, not an empty canvas
        self.assertGreater((np.ptp(picture[-100:, 1400:], axis=2) > 60).mean(), 0.05)  # the scale at the right

    def choose(self, selector, value):
        self.browser.run(f"(s => {{ s.value = '{value}'; s.dispatchEvent(new Event('change')); }})"
                         f"(document.querySelector('{selector}'))")

    def address(self):
        """What stands in the address a moment after the last change."""
        time.sleep(0.5)
        return dict(part.split("=") for part in self.browser.run("location.hash.slice(1)").split("&") if part)

    def test_the_address_keeps_what_is_shown(self):
        """What one reader has chosen, another sees who gets the address; nothing stands there for the opening view."""
        self.open("both.html")
        self.assertEqual(self.address(), {})
        self.browser.press("Home", 36)
        self.browser.press("ArrowRight", 39)
        self.choose(".colouring", "J")
        self.choose(".over", "ends")
        self.browser.run("document.querySelector('.chains input').click()")
        self.browser.run("document.querySelector('.choices .log input').click()")
        self.browser.run("document.querySelector('figcaption .log input').click()")
        self.browser.wait("location.hash.includes('plots')")
        address = self.address()
        self.assertEqual({name: address[name] for name in ("frame", "colour", "over", "log", "chains")},
                         {"frame": "1", "colour": "J", "over": "ends", "log": "1", "chains": "0"})
        self.assertEqual(address["plots"].split(";")[0], "strain,stress_top,log")
        before, link = self.pixels("linked", None), self.browser.run("location.href")
        self.browser.call("Page.navigate", url="about:blank")
        self.browser.call("Page.navigate", url=link)
        self.browser.wait("document.body && document.body.dataset.drawn === '1'")
        self.assertEqual(self.address(), address)
        self.assertLess((np.abs(self.pixels("linked again", None) - before).max(axis=2) > 20).mean(), 1e-3)

    def test_what_cannot_be_in_an_address_is_left_at_the_opening(self):
        self.browser.call("Page.navigate", url="about:blank")
        page = f"file://{self.folder.resolve()}/compaction-mpm/run/report.html"
        self.browser.call("Page.navigate", url=f"{page}#frame=99&run=7&colour=nothing&low=x&plots=strain,nothing;%00")
        self.browser.wait("document.body && document.body.dataset.drawn !== undefined")
        self.settle()
        self.assertEqual((self.frame(), self.browser.errors), (10, []))
        self.browser.run("location.hash = '#frame=3'")
        self.browser.wait("document.body.dataset.frame === '3'")

    def test_colours_over_powers_of_ten_part_small_values(self):
        """On a logarithmic scale a value a tenth of the largest is a third of the way down: the colours say so."""
        self.open()
        self.browser.press("End", 35)
        self.choose(".colouring", "pressure")
        self.browser.run("document.querySelector('.choices .log input').click()")
        self.pixels("log colours")
        number = {"Pa": 1, "kPa": 1e3, "MPa": 1e6}
        unit = number[self.browser.run("document.querySelector('.legend span').textContent").split("[")[1].rstrip("]")]
        middle = float(self.browser.run("document.querySelector('.ticks span').textContent")) * unit
        low, high = (float(end) * unit for end in self.browser.run(
            "[...document.querySelectorAll('.ticks input')].map(i => i.value.replace('−', '-'))"))
        self.assertAlmostEqual(middle / (low * high) ** 0.5, 1, delta=0.01)
        self.assertGreater(high / low, 2)

    def test_a_logarithmic_curve_rises_by_equal_steps_for_equal_factors(self):
        self.open()
        plot = "document.querySelectorAll('figure')[0]"
        self.browser.run(f"{plot}.querySelector('.log input').click()")
        self.pixels("log curve")
        places = {}
        for key, code in (("End", 35), ("ArrowLeft", 37), ("ArrowLeft", 37)):
            self.browser.press(key, code)
            value, unit = self.browser.run(f"{plot}.querySelector('output').textContent").split(" at ")[0].split()
            places[float(value) * {"Pa": 1, "kPa": 1e3, "MPa": 1e6}[unit]] = self.browser.run(DOT.format(0) + ".y")
        (a, b, c) = sorted(places)
        ratio = np.log(c / b) / np.log(b / a)
        self.assertAlmostEqual((places[b] - places[c]) / (places[a] - places[b]) / ratio, 1, delta=0.15)

    def look_at_film(self, film):
        """Width, height, length [s], and which share of the picture is another at the end: by Chromium's own player."""
        data = base64.b64encode(film.read_bytes()).decode()
        kind = {".mp4": "video/mp4", ".webm": "video/webm"}[film.suffix]
        self.browser.call("Page.navigate", url="about:blank")  # a page from the disk may not play what it has made
        return self.browser.run(f"""(async () => {{
          const video = document.createElement('video');
          video.muted = true;
          const bytes = Uint8Array.from(atob('{data}'), letter => letter.charCodeAt(0));
          video.src = URL.createObjectURL(new Blob([bytes], {{type: '{kind}'}}));
          await new Promise((done, failed) => {{ video.onloadeddata = done; video.onerror = () => failed(video.error); }});
          const pen = Object.assign(document.createElement('canvas'), {{width: 128, height: 128}})
            .getContext('2d', {{willReadFrequently: true}});
          const look = () => {{ pen.drawImage(video, 0, 0, 128, 128); return [...pen.getImageData(0, 0, 128, 128).data]; }};
          const until = async (seen) => {{ for (let k = 0; k < 100 && !seen(look()); ++k) await new Promise(d => setTimeout(d, 100)); }};
          await until(now => now[3] > 0);  // a player says that it has a picture before it shows it
          const first = look();
          await new Promise(done => {{ video.onseeked = done; video.currentTime = video.duration - 0.5; }});
          await until(now => now.some((v, k) => Math.abs(v - first[k]) > 40));
          const last = look();
          return [video.videoWidth, video.videoHeight, video.duration,
                  first.filter((v, k) => Math.abs(v - last[k]) > 40).length / first.length];
        }})()""")

    def test_a_film_of_all_frames_is_saved_in_what_the_browser_encodes(self):
        for codec, suffix in (("any", None), ("vp8", ".webm")):
            with self.subTest(codec):
                self.open()
                if not self.browser.run("typeof VideoEncoder !== 'undefined'"):
                    self.skipTest("no VideoEncoder")
                if suffix:
                    self.browser.run(f"void (VideoEncoder.isConfigSupported = async c => ({{supported: c.codec === '{codec}'}}))")
                films = self.folder / f"films-{codec}"
                self.browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(films))
                self.browser.run("document.querySelector('.film').click()")
                self.browser.until(lambda: any(film.stat().st_size > 5000 for film in films.glob("run.*[4m]")), 240)
                self.browser.wait("document.querySelector('.film').textContent === 'save film'")
                self.assertEqual((self.frame(), self.browser.errors), (10, []))  # where it was, without a complaint
                (film,) = films.glob("run.*")
                self.assertIn(film.suffix, (suffix,) if suffix else (".mp4", ".webm"))
                if PICTURES:
                    shutil.copy(film, PICTURES)
                width, height, seconds, changed = self.look_at_film(film)
                self.browser.errors.clear()
                self.assertEqual((width, height % 2), (1280, 0))
                self.assertAlmostEqual(seconds, 11 / 5 + 1, delta=0.02)  # 11 frames, 5 a second, the last a second longer
                self.assertGreater(changed, 0.03)

    def test_summary_is_that_of_the_case(self):
        self.open()
        self.assertEqual(self.browser.run("document.querySelector('.summary').textContent"),
                         "compaction · mpm · 16 grains · friction 0")

    def test_phone(self):
        self.browser.resize(390, 844, phone=True)
        self.open()
        self.browser.press("End", 35)
        self.pixels("phone")
        self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 390)
        self.assertGreater(self.browser.run(f"{STAGE}.width"), 340)
        self.assertGreater(self.browser.run("document.querySelector('.play').getBoundingClientRect().height"), 32)

    def test_two_fingers_magnify_what_lies_between_them(self):
        self.browser.resize(390, 844, phone=True)
        self.open()
        self.browser.press("End", 35)
        x, y = self.browser.run(f"(r => [r.x + r.width / 2, r.y + r.height / 2])({STAGE})")
        unlike = lambda p, q: (np.abs(p - q).max(axis=2) > 20).mean()  # noqa: E731
        pictures = [self.pixels("whole", STAGE)]
        for name, reaches in (("magnified", (20, 40, 60, 80)), ("whole again", (80, 60, 40, 10))):
            self.browser.fingers("touchStart", (x - reaches[0], y), (x + reaches[0], y))
            for reach in reaches:
                self.browser.fingers("touchMove", (x - reach, y), (x + reach, y))
            self.browser.fingers("touchEnd")
            pictures.append(self.pixels(name, STAGE))
        self.assertGreater(unlike(pictures[0], pictures[1]), 0.1)
        self.assertLess(unlike(pictures[0], pictures[2]), 0.001)
        self.assertEqual(self.browser.run("window.visualViewport.scale"), 1)  # the page itself was not magnified

    def test_several_runs_share_the_plots_and_take_turns_in_the_picture(self):
        self.open("both.html")
        names = "[...document.querySelectorAll('.runs button')].map(b => b.textContent)"
        self.assertEqual(self.browser.run(names), ["soft", "bonded"])
        before = self.pixels("soft", STAGE)
        self.assertEqual(self.browser.run("document.title"), "soft, bonded")
        self.browser.run("document.querySelectorAll('.runs button')[1].click()")
        self.assertIn("100 primaries", self.browser.run("document.querySelector('.summary').textContent"))
        self.assertGreater((np.abs(self.pixels("bonded")[:before.shape[0], :before.shape[1]] - before) > 40).mean(), 0.01)
        self.assertEqual(self.browser.errors, [])

    def test_series_can_be_taken_away_as_it_was(self):
        self.open()
        self.browser.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(self.folder / "taken"))
        self.browser.run("document.querySelector('.downloads a').click()")
        taken = self.folder / "taken" / "run-series.csv"
        self.browser.until(taken.exists)
        self.assertEqual(taken.read_text(), (self.folder / "compaction-mpm/run/series.csv").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
