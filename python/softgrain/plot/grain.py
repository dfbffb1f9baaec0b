"""The grain at chosen moments: a column for each moment, a row for each way to look, one scale."""

from .. import NotRecorded
from .layout import panel_grid
from .rows import ROWS
from .scene import draw_plates, extent
from .stages import choose_stages

PLATE = 0.05  # thickness of a plate over the grain's height at the start


def draw_grain(run, rows=ROWS):
    """Draws the rows that the snapshots have the data for. Raises NotRecorded if the run has no snapshot."""
    snapshots = [run[i] for i in range(len(run))]
    if not snapshots:
        raise NotRecorded("no snapshots to draw")
    stages = choose_stages(run, [s.time for s in snapshots])
    bottom, top = extent(snapshots[0], 0)[2:]
    plate = PLATE * (top - bottom)
    views = [view for view in (_view(row, snapshots) for row in rows) if view]
    grid = panel_grid([extent(snapshots[stage.snapshot], plate) for stage in stages], len(views))
    for row, view in enumerate(views):
        for axes, stage in zip(grid.axes[row], stages):
            view.draw(axes, stage.snapshot, grid.scale)
            draw_plates(axes, snapshots[stage.snapshot], plate)
        view.draw_key(grid, row)
        grid.add_row_name(row, view.name)
    for column, stage in enumerate(stages):
        grid.add_heading(column, _heading("abcdef"[column], stage))
    return grid.figure


def _view(row, snapshots):
    try:
        return row(snapshots)
    except NotRecorded:
        return None


def _heading(letter, stage):
    lines = [] if stage.strain is None else [rf"$\varepsilon$ = {stage.strain + 0:.3f}"]
    lines += [] if stage.stress is None else [rf"$\sigma$ = {stage.stress / 1e6:.3f} MPa"]
    return f"({letter})  " + "\n".join(lines)
