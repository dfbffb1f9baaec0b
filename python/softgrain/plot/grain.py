"""The grain at chosen moments: a column for each moment, a row for each way to look, one scale."""

from .. import NotRecorded, colours
from .layout import panel_grid
from .rows import rows_of
from .scene import draw_walls, extent
from .stages import choose_stages, headings

WALL = 0.05  # thickness of a wall over the grain's height at the start


def draw_grain(run, rows=None):
    """Draws the rows (all, if none are named) that the snapshots have the data for. Raises NotRecorded if the run has no snapshot."""
    if len(run) == 0:
        raise NotRecorded("no snapshots to draw")
    stages = choose_stages(run, run.times)
    # scales are those of the run: frames evenly over it, and those that are shown
    frames = sorted({*colours.sampled(len(run)), *(stage.snapshot for stage in stages)})
    snapshots = [run[i] for i in frames]
    places = [frames.index(stage.snapshot) for stage in stages]
    bottom, top = extent(snapshots[0], 0)[2:]
    wall = WALL * (top - bottom)
    views = [view for view in (_view(row, snapshots) for row in rows or rows_of(run.case)) if view]
    grid = panel_grid([extent(snapshots[place], wall) for place in places], len(views))
    for row, view in enumerate(views):
        for panel, place in zip(grid.panels[row], places):
            view.draw(panel, place)
            draw_walls(panel, snapshots[place], wall)
        view.draw_key(grid, row)
        grid.add_row_name(row, view.name)
    for column, words in enumerate(headings(stages)):
        grid.add_heading(column, words)
    return grid.figure


def _view(row, snapshots):
    try:
        return row(snapshots)
    except NotRecorded:
        return None
