"""A periodic cell in shear: stress ratio, packing fraction and coordination number over shear strain."""

from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from .. import NotRecorded
from .style import DOUBLE_COLUMN, MM, RUN_COLOURS

HEIGHT = 58  # [mm]
STEADY = 0.5  # share of the shear strain, from its end, over which means are taken
PANELS = (("stress_ratio", r"$-\sigma_{xy}/\sigma_{yy}$"), ("phi", r"packing fraction $\Phi$"),
          ("z", "coordination number $Z$"))


def draw_shear(runs, labels=None):
    """Each over gamma while it grows; the legend has the mean stress ratio of the second half and its deviation."""
    labels = labels or [run.name for run in runs]
    known = [(run, label) for run, label in zip(runs, labels) if np.ptp(run.series.get("shear_strain", np.zeros(1))) > 0]
    if not known:
        raise NotRecorded("no series.csv has a shear_strain that grows: that is of periodic cells")
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, HEIGHT * MM), layout="constrained")
    panels = figure.subplots(1, len(PANELS))
    for (run, label), colour in zip(known, cycle(RUN_COLOURS)):
        gamma = run.series["shear_strain"]
        rows = np.flatnonzero(gamma > 0)
        steady = gamma >= (1 - STEADY) * gamma.max()
        ratio = run.series["stress_ratio"][steady]
        words = rf"{ratio.mean():.3f} $\pm$ {ratio.std():.3f}"
        for axes, (column, name) in zip(panels, PANELS):
            axes.plot(gamma[rows], run.series[column][rows], color=colour, lw=0.8,
                      label=(words if len(known) == 1 else f"{label}: {words}") if axes is panels[0] else None)
            axes.set(xlabel=r"shear strain $\gamma$", ylabel=name)
    panels[0].axhline(0, color="0.7", lw=0.5, zorder=0)
    panels[0].legend(loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.3)
    return figure
