"""Rows and columns of panels that share one scale, placed in millimetres."""

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .style import DOUBLE_COLUMN, MM

LEFT, RIGHT, TOP, BOTTOM = 4.5, 17, 8.5, 0.5  # margins [mm]: row names, keys, column headings
COLUMN_GAP, ROW_GAP = 2.0, 2.5  # [mm]
TALLEST_ROW = 55  # [mm]


class PanelGrid(NamedTuple):
    figure: Figure
    axes: np.ndarray  # (rows, columns)
    scale: float  # millimetres of paper per metre of the model

    def add_key_axes(self, row, width, height):
        """Axes of `width` [mm] and `height` (share of the row's) in the right margin, half-way up the row."""
        box = self.axes[row, -1].get_position()
        page_width = self.figure.get_size_inches()[0] / MM
        tall = height * box.height
        return self.figure.add_axes((box.x1 + 2 / page_width, box.y0 + (box.height - tall) / 2,
                                     width / page_width, tall))

    def add_row_name(self, row, name):
        box = self.axes[row, 0].get_position()
        self.figure.text(0.004, (box.y0 + box.y1) / 2, name, rotation=90, va="center", ha="left")

    def add_heading(self, column, text):
        box = self.axes[0, column].get_position()
        self.figure.text((box.x0 + box.x1) / 2, 0.995, text, va="top", ha="center", linespacing=1.3)


def panel_grid(extents, rows):
    """Panels for the given extents (x0, x1, y0, y1) [m], one to a column, repeated over `rows` rows."""
    widths = np.array([x1 - x0 for x0, x1, _, _ in extents])
    bottom, top = min(e[2] for e in extents), max(e[3] for e in extents)
    gaps = COLUMN_GAP * (len(extents) - 1)
    scale = min((DOUBLE_COLUMN - LEFT - RIGHT - gaps) / widths.sum(), TALLEST_ROW / (top - bottom))
    height = scale * (top - bottom)
    page_width = LEFT + scale * widths.sum() + gaps + RIGHT
    page_height = TOP + rows * height + (rows - 1) * ROW_GAP + BOTTOM
    figure = Figure(figsize=(page_width * MM, page_height * MM))
    axes = np.empty((rows, len(extents)), object)
    lefts = LEFT + np.append(0, np.cumsum(scale * widths + COLUMN_GAP))
    for row, column in np.ndindex(axes.shape):
        y = page_height - TOP - (row + 1) * height - row * ROW_GAP
        width = scale * widths[column]
        box = (lefts[column] / page_width, y / page_height, width / page_width, height / page_height)
        axes[row, column] = figure.add_axes(box, xlim=extents[column][:2], ylim=(bottom, top))
        axes[row, column].set_axis_off()
    return PanelGrid(figure, axes, scale)
