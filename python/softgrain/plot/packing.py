"""A packing under compaction: coordination number over packing fraction, packing fraction over strain."""

from itertools import cycle

from matplotlib.figure import Figure

from .. import NotRecorded, measure
from .style import DOUBLE_COLUMN, GREY, INK, MM, RUN_COLOURS

HEIGHT = 62  # [mm]
PHI, PHI_0 = r"packing fraction $\Phi$", r"$\Phi_0$, areas at the start"
COORDINATION = (("z", "pairs of grains", "-"), ("z_no_rattlers", "without rattlers", "--"), ("z_with_walls", "walls counted too", ":"))


def draw_packing(runs, labels=None):
    """Z(Phi) and Phi(eps), of loading alone: a strain that was reached before is left out."""
    labels = labels or [run.name for run in runs]
    known = [(run, label) for run, label in zip(runs, labels) if {"phi", "z", "strain"} <= run.series.keys()]
    if not known:
        raise NotRecorded("no series.csv has phi and z: that is of packings")
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, HEIGHT * MM), layout="constrained")
    left, right = figure.subplots(1, 2)
    alone = len(known) == 1
    for (run, label), colour in zip(known, cycle(RUN_COLOURS)):
        series = run.series
        strain, phi = measure.envelope(series["strain"], series["phi"])
        for column, words, dash in COORDINATION if alone else COORDINATION[:1]:
            if column in series:
                z = measure.envelope(series["strain"], series[column])[1]
                left.plot(phi, z, color=colour, ls=dash, label=words if alone else label)
        right.plot(strain, phi, color=colour, label=PHI.removeprefix("packing fraction ") if alone else label)
        if "phi_0" in series:
            phi_0 = measure.envelope(series["strain"], series["phi_0"])[1]
            right.plot(strain, phi_0, color=GREY if alone else colour, lw=0.7, ls=":", label=(PHI_0.replace("areas", "volumes") if run.in_space else PHI_0) if alone else None)
    _mark_isostaticity(left, 6 if all(run.in_space for run, _ in known) else 4)
    left.set(xlabel=PHI, ylabel="coordination number $Z$", ylim=(0, None))
    right.set(xlabel=r"strain $\varepsilon$", ylabel=PHI, xlim=(0, None))
    left.legend(loc="lower right")
    right.legend(loc="upper left")
    return figure


def _mark_isostaticity(axes, isostatic):
    """The line Z = 4 of frictionless disks, 6 of spheres, walls counted."""
    if max((line.get_ydata().max(initial=0) for line in axes.lines), default=0) > isostatic - 1:
        axes.axhline(isostatic, color=INK, lw=0.5, zorder=1)
