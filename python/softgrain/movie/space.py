"""The frames of a film in space: surfaces as `softgrain plot` draws them, beside the curve."""

from matplotlib.transforms import Bbox

from .. import view
from ..plot.layout import panel_at
from ..plot.space import add_key, draw_surfaces, range_of_pressures
from ..plot.style import DOUBLE_COLUMN
from .frames import HEIGHT, PICTURE, Film

BAR = Bbox.from_bounds(PICTURE.x1 + 3, HEIGHT / 2 - 20, 2.5, 40)  # the key of the colours [mm]


class FilmInSpace(Film):
    """`film[k]` as of Film; no chains, which lie behind surfaces."""

    @property
    def range(self):
        return self._range

    def _measure(self, sampled):
        self._range = range_of_pressures(sampled)

    def _place_picture(self):
        x0, x1, y0, y1 = view.extent([self.run[k] for k in range(len(self.run))])
        scale = min(PICTURE.width / (x1 - x0), PICTURE.height / (y1 - y0))
        corner = PICTURE.x1 - scale * (x1 - x0), (PICTURE.y0 + PICTURE.y1 - scale * (y1 - y0)) / 2
        self.panel = panel_at(self.axes, (x0, x1, y0, y1), corner, scale)
        add_key(self.figure, self._range, (BAR.x0 / DOUBLE_COLUMN, BAR.y0 / HEIGHT, BAR.width / DOUBLE_COLUMN, BAR.height / HEIGHT))

    def _draw_picture(self, snapshot):
        draw_surfaces(self.axes, snapshot, self._range, transform=self.panel.transform)
