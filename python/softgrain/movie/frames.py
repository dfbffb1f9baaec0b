"""The frames of a film: the snapshot with its pressures and force chains, a clock, and the stress-strain curve with the present point."""

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.transforms import Bbox

from .. import NotRecorded, colours, measure, picture
from ..plot.layout import PanelGrid, page, panel_at
from ..plot.rows import Forces, Pressure
from ..plot.scene import draw_chains, draw_walls, extent
from ..plot.stages import stage_at, words_of
from ..plot.style import BLUE, DOUBLE_COLUMN, GREY, INK, MM, VERMILLION
from ..stress_unit import unit_for

HEIGHT = DOUBLE_COLUMN * 9 / 16  # of the page, as wide as screens are [mm]
PICTURE = Bbox.from_extents(4, 4, 106, HEIGHT - 12)  # where the picture may lie [mm]
CURVE = Bbox.from_extents(138, 14, DOUBLE_COLUMN - 4, HEIGHT - 12)
KEYS = 0.65  # share of the picture's height beside which the colours are explained; the chains have the rest
RAMP_COLOURS, GREYS = 96, 32  # of a palette
WALL = 0.03  # thickness of a wall over the picture's height


class Film:
    """`film[k]` is the picture of snapshot k as bytes (height, width, 3); all share place, scale and colours.

    The range of colours is that of `softgrain export --to svg` and of the page: of frames evenly over the run."""

    def __init__(self, run, width):
        """width: of the picture [px]. Raises NotRecorded if the run has no snapshot or no pressure."""
        if len(run) == 0:
            raise NotRecorded(f"{run.path} has no snapshots")
        self.run = run
        self._measure([run[i] for i in colours.sampled(len(run))])
        self.stages = [stage_at(run.series, k, time) for k, time in enumerate(run.times)]
        self.unit = unit_for([stage.stress or 0 for stage in self.stages])
        self.figure, self.axes = page(DOUBLE_COLUMN, HEIGHT)
        self.canvas = FigureCanvasAgg(self.figure)
        self.figure.set_dpi(width / (DOUBLE_COLUMN * MM))
        self._place_picture()
        self.clock = self.figure.text(PICTURE.x0 / DOUBLE_COLUMN, 1 - 4 / HEIGHT, "", va="top", fontsize=9)
        self.past = self.point = None
        if all(stage.strain is not None and stage.stress is not None for stage in self.stages):
            self._draw_curve()

    def __len__(self):
        return len(self.run)

    def __getitem__(self, index):
        if not 0 <= index < len(self):
            raise IndexError(index)
        for artist in list(self.axes.collections):  # the picture before
            artist.remove()
        snapshot, stage = self.run[index], self.stages[index]
        self._draw_picture(snapshot)
        self.clock.set_text(self._words(snapshot, stage))
        if self.point is not None:
            self.point.set_data([stage.strain], [stage.stress / self.unit.pascal])
            self.past.set_data(*self._curve_until(snapshot.time))
        self.canvas.draw()
        pixels = np.asarray(self.canvas.buffer_rgba())[..., :3]
        return pixels[: len(pixels) // 2 * 2, : pixels.shape[1] // 2 * 2].copy()  # H.264 halves the colours' resolution

    @property
    def key_colours(self):
        """(n, 3) bytes: those of the pressures, the greys from the paper to the ink, the curve, the point and the chains."""
        scale = self.range
        ramp = scale.rgb(np.linspace(scale.low, scale.high, RAMP_COLOURS))
        greys = np.linspace(to_rgb(INK), (1, 1, 1), GREYS)
        return np.rint(255 * np.concatenate([ramp, greys, [to_rgb(c) for c in (BLUE, VERMILLION, scale.chains)]])).astype(np.uint8)

    @property
    def range(self):
        """Of the colours [Pa]."""
        return self.pressure.range

    def _measure(self, sampled):
        """What the colours and widths of all frames mean, from some of them."""
        self.pressure = Pressure(sampled)
        try:
            self.forces = Forces(sampled)
        except NotRecorded:
            self.forces = None

    def _draw_picture(self, snapshot):
        self.pressure.draw_snapshot(self.panel, snapshot)
        if self.forces is not None:
            draw_chains(self.panel, picture.chains(snapshot, self.forces.scale), self.pressure.range.chains)
        draw_walls(self.panel, snapshot, self.wall)

    def _place_picture(self):
        """One panel around all snapshots, and its keys beside it."""
        extents = np.array([extent(snapshot, 0) for snapshot in map(self.run.__getitem__, range(len(self.run)))])
        (x0, _, y0, _), (_, x1, _, y1) = extents.min(axis=0), extents.max(axis=0)
        self.wall = WALL * (y1 - y0)
        around = (x0 - self.wall, x1 + self.wall, y0 - self.wall, y1 + self.wall)
        width, height = around[1] - around[0], around[3] - around[2]
        scale = min(PICTURE.width / width, PICTURE.height / height)
        corner = (PICTURE.x1 - scale * width, (PICTURE.y0 + PICTURE.y1 - scale * height) / 2)
        self.panel = panel = panel_at(self.axes, around, corner, scale)
        middle = panel.frame.y0 + (1 - KEYS) * panel.frame.height
        upper, lower = (panel._replace(frame=Bbox.from_extents(PICTURE.x0, a, PICTURE.x1, b))
                        for a, b in ((middle, panel.frame.y1), (panel.frame.y0, middle)))
        keys = PanelGrid(self.figure, np.array([[upper, None], [lower, None]], object)[:, :1], scale)
        self.pressure.draw_key(keys, 0)
        if self.forces is not None:
            self.forces.draw_key(keys, 1, self.pressure.range.chains)

    def _draw_curve(self):
        """The whole curve, pale; what has been of it; the present point."""
        series = self.run.series
        self.stress = measure.vertical_stress(series) / self.unit.pascal
        page_size = np.array([DOUBLE_COLUMN, HEIGHT])
        axes = self.figure.add_axes((*(CURVE.min / page_size), *(CURVE.size / page_size)))
        axes.plot(series["strain"], self.stress, color=GREY, lw=0.5, alpha=0.6)
        self.past, = axes.plot([], [], color=BLUE, lw=1)
        self.point, = axes.plot([], [], "o", color=VERMILLION, ms=5, mec=INK, mew=0.4, zorder=3, clip_on=False)
        axes.set(xlabel=r"strain $\varepsilon$", ylabel=rf"vertical stress $\sigma$ [{self.unit.name}]", ylim=(min(0, self.stress.min()), None))

    def _curve_until(self, time):
        rows = np.searchsorted(self.run.series["time"], time, side="right")
        return self.run.series["strain"][:rows], self.stress[:rows]

    def _words(self, snapshot, stage):
        unit, factor = next(((u, f) for u, f in (("s", 1), ("ms", 1e3)) if self.run.times[-1] * f >= 1), ("µs", 1e6))
        words = [f"$t$ = {snapshot.time * factor:.2f} {unit}"]
        return "      ".join(words + words_of(stage, self.unit))
