"""Whether a run can be trusted: energies, forces on walls, sweeps, residual and overlap over strain."""

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator
from matplotlib.transforms import blended_transform_factory

from .. import NotRecorded
from .style import BLUE, INK, MM, ORANGE, SINGLE_COLUMN, VERMILLION, millimetres


class Panel(NamedTuple):
    label: str
    logarithmic: bool
    lines: dict  # column of series.csv -> (label, colour)


PANELS = (
    Panel("energy [J/m]", False, {"wall_work": ("walls' work", INK), "dissipation": ("dissipated", ORANGE),
                                  "attraction_energy": ("attraction (change)", BLUE),
                                  "elastic_energy": ("elastic", BLUE)}),
    Panel("kinetic\nenergy [J/m]", True, {"kinetic_energy": ("", VERMILLION)}),
    Panel("force on\nwall [N/m]", False, {"force_top": ("top", VERMILLION),
                                           "force_bottom": ("bottom", BLUE)}),
    Panel("sweeps\nper step", False, {"sweeps": ("", BLUE)}),
    Panel("residual", True, {"residual_max": ("worst", VERMILLION),
                             "residual_mean": ("mean", BLUE)}),
    Panel("overlap\n/ mean radius", True, {"overlap_max": ("worst", VERMILLION),
                                            "overlap_mean": ("mean", BLUE)}),
)
FROM_START = {"attraction_energy"}  # energies known up to a constant
PANEL_HEIGHT, AXIS_HEIGHT = 23, 9  # [mm]
LEFT, RIGHT, TOP, LABEL = 17, 2.5, 1, 6.5  # margins, and where the words beside the axes stand [mm]
MOST_DECADES = 4  # of a logarithmic axis


def draw_diagnostics(run):
    """One panel above the other, for each of PANELS that series.csv has a column for."""
    series = run.series
    panels = [panel for panel in PANELS if any(name in series for name in panel.lines)]
    if not panels or "strain" not in series:
        raise NotRecorded(f"{run.path}: series.csv has nothing to draw over strain")
    size = (SINGLE_COLUMN * MM, (PANEL_HEIGHT * len(panels) + AXIS_HEIGHT) * MM)
    figure = Figure(figsize=size)
    millimetres(figure, LEFT, RIGHT, AXIS_HEIGHT, TOP, hspace=0.12)
    grid = figure.subplots(len(panels), sharex=True, squeeze=False)
    for axes, letter, panel in zip(grid[:, 0], "abcdef", panels):
        _draw_panel(axes, series, panel, run.in_space)
        axes.annotate(f"({letter})", (0, 1), xytext=(3, -3), xycoords="axes fraction",
                      textcoords="offset points", va="top")
    grid[-1, 0].set_xlabel(r"cumulative axial strain $\varepsilon$")
    grid[-1, 0].set_xlim(0, series["strain"].max() * 1.02 or 0.01)
    return figure


def _draw_panel(axes, series, panel, in_space):
    """In space energies and forces are not per metre of depth."""
    shown = 0
    for column, (label, colour) in panel.lines.items():
        if column not in series:
            continue
        values = series[column] - (series[column][0] if column in FROM_START else 0)
        # A logarithmic axis has no place for 0: leave a gap there.
        values = np.where(values > 0, values, np.nan) if panel.logarithmic else values
        if np.isfinite(values).any():
            axes.plot(series["strain"], values, color=colour, lw=0.5, label=label)
            shown += bool(label)
    axes.set_ylabel(panel.label.replace("/m]", "]") if in_space else panel.label, va="center")
    axes.yaxis.set_label_coords(LABEL * MM, 0.5,
                                transform=blended_transform_factory(axes.figure.dpi_scale_trans, axes.transAxes))
    if panel.logarithmic:
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(numticks=5))
        axes.yaxis.set_minor_locator(NullLocator())
        low, high = axes.get_ylim()
        axes.set_ylim(bottom=max(low, high / 10**MOST_DECADES))  # below, rounding errors
    else:
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
    _leave_headroom(axes, share=0.3)
    if shown:
        axes.legend(loc="upper right", ncols=shown, columnspacing=1, borderaxespad=0.2)


def _leave_headroom(axes, share):
    """Stretches the y axis upwards so that letter and key lie above the curves."""
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    axes.set_ylim(top=scale.inverted().transform(high + share * (high - low)))
