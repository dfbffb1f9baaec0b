"""Rows and columns of panels that share one scale, placed in millimetres."""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Affine2D, Bbox, Transform, TransformedBbox

from .style import DOUBLE_COLUMN, MM

LEFT, RIGHT, TOP, BOTTOM = 4.5, 17, 8.5, 0.5  # margins [mm]: row names, keys, column headings
COLUMN_GAP, ROW_GAP = 2.0, 2.5  # [mm]
TALLEST_ROW = 55  # [mm]


class Panel(NamedTuple):
    """One picture on the page. All panels share one pair of axes: axes of its own cost 15 ms each."""

    axes: Axes  # of the whole page, in millimetres
    frame: Bbox  # on the page [mm]
    transform: Transform  # metres -> page
    scale: float  # millimetres of paper per metre of the model

    def add(self, artist):
        """Draws an artist that has this panel's transform; what sticks out of the frame is cut off."""
        self.axes.add_artist(artist)
        artist.set_clip_box(TransformedBbox(self.frame, self.axes.transData))


class PanelGrid(NamedTuple):
    figure: Figure
    panels: np.ndarray  # (rows, columns)
    scale: float  # millimetres of paper per metre of the model

    def add_key_axes(self, row, width, height):
        """Axes of `width` [mm] and `height` (share of the row's) in the right margin, half-way up the row."""
        frame = self.panels[row, -1].frame
        page_width, page_height = self._page
        tall = height * frame.height
        return self.figure.add_axes(((frame.x1 + 2) / page_width, (frame.y0 + (frame.height - tall) / 2) / page_height,
                                     width / page_width, tall / page_height))

    def add_row_name(self, row, name):
        frame = self.panels[row, 0].frame
        self.figure.text(0.004, (frame.y0 + frame.y1) / 2 / self._page[1], name, rotation=90, va="center", ha="left")

    def add_heading(self, column, text):
        frame = self.panels[0, column].frame
        self.figure.text((frame.x0 + frame.x1) / 2 / self._page[0], 0.995, text, va="top", ha="center", linespacing=1.3)

    @property
    def _page(self):
        return self.figure.get_size_inches() / MM


def panel_grid(extents, rows):
    """Panels for the given extents (x0, x1, y0, y1) [m], one to a column, repeated over `rows` rows."""
    widths = np.array([x1 - x0 for x0, x1, _, _ in extents])
    bottom, top = min(e[2] for e in extents), max(e[3] for e in extents)
    gaps = COLUMN_GAP * (len(extents) - 1)
    scale = min((DOUBLE_COLUMN - LEFT - RIGHT - gaps) / widths.sum(), TALLEST_ROW / (top - bottom))
    height = scale * (top - bottom)
    page_width = LEFT + scale * widths.sum() + gaps + RIGHT
    page_height = TOP + rows * height + (rows - 1) * ROW_GAP + BOTTOM
    figure, axes = page(page_width, page_height)
    panels = np.empty((rows, len(extents)), object)
    lefts = LEFT + np.append(0, np.cumsum(scale * widths + COLUMN_GAP))
    for row, column in np.ndindex(panels.shape):
        x, y = lefts[column], page_height - TOP - (row + 1) * height - row * ROW_GAP
        panels[row, column] = panel_at(axes, (*extents[column][:2], bottom, top), (x, y), scale)
    return PanelGrid(figure, panels, scale)


def page(width, height):
    """(figure, axes over all of it in millimetres)."""
    figure = Figure(figsize=(width * MM, height * MM))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(0, height))
    axes.set_axis_off()
    return figure, axes


def panel_at(axes, extent, corner, scale):
    """The panel of an extent (x0, x1, y0, y1) [m] whose lower left corner lies at `corner` [mm] of a page."""
    x0, x1, y0, y1 = extent
    frame = Bbox.from_bounds(*corner, scale * (x1 - x0), scale * (y1 - y0))
    to_page = Affine2D().translate(-x0, -y0).scale(scale).translate(*corner)
    return Panel(axes, frame, to_page + axes.transData, scale)
