"""Set-Voronoi cells at chosen moments: how local packing fractions and numbers of neighbours are distributed."""

from itertools import cycle

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from .. import NotRecorded
from ..voronoi import cells_of
from .stages import choose_stages
from .style import DOUBLE_COLUMN, MM, RUN_COLOURS

HEIGHT = 62  # [mm]
MOST_STAGES, MOST_BINS = 4, 40


def draw_voronoi(run):
    """Histograms of both. Raises NotRecorded where cells would not end, or no outlines are."""
    stages = choose_stages(run, run.times) if len(run) else []
    if not stages:
        raise NotRecorded("no snapshots")
    if len(stages) > MOST_STAGES:
        stages = [stages[k] for k in np.linspace(0, len(stages) - 1, MOST_STAGES).round().astype(int)]
    found = [cells_of(run[stage.snapshot]) for stage in stages]
    every = np.concatenate([cells.phi for cells in found])
    bins = np.linspace(every.min(), every.max() + 1e-9, int(np.clip(2 * np.sqrt(len(every)), 8, MOST_BINS)) + 1)
    least, most = (int(end(end(cells.neighbours) for cells in found)) for end in (min, max))
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, HEIGHT * MM), layout="constrained")
    left, right = figure.subplots(1, 2)
    for cells, stage, colour in zip(found, stages, cycle(RUN_COLOURS)):
        mean = cells.grain_volume.sum() / cells.volume.sum()
        heights = np.histogram(cells.phi, bins, density=True)[0]
        left.stairs(heights, bins, color=colour, label=rf"$\Phi$ = {mean:.3f}")
        left.axvline(mean, color=colour, lw=0.5, ls=":")
        counts = np.bincount(cells.neighbours, minlength=most + 1)[least:] / len(cells.neighbours)
        right.plot(np.arange(least, most + 1), counts, color=colour, marker="o", ms=2.5, lw=0.7)
    left.set(xlabel="local packing fraction", ylabel="probability density", ylim=(0, None))
    right.set(xlabel="neighbours of a grain", ylabel="share of the grains", ylim=(0, None))
    right.xaxis.set_major_locator(MaxNLocator(integer=True))
    left.legend(loc="best")
    return figure
