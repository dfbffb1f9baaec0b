"""The paper's four figures and the packings themselves; a band spans the samples."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure

from .. import measure
from ..plot.style import BLUE, DOUBLE_COLUMN, GREEN, GREY, INK, MM, ORANGE, PURPLE, SKY, VERMILLION
from .curves import REFERENCE_PACKING_FRACTION, band
from .plan import EARLY, FAST, FRICTIONS, MODELS, NODES, SLOW
from .single_grain import approach, johnson_force, paper_force, reduced_force

HEIGHT, LOW_HEIGHT = 62, 42  # [mm]
LOOKS = {("bpm", 0.0): (VERMILLION, "-"), ("bpm", 0.5): (VERMILLION, "--"),
         ("mpm", 0.0): (BLUE, "-"), ("mpm", 0.5): (BLUE, "--")}
ELASTIC = {"grain_mpm": ("neo-Hookean", BLUE), "grain_mpm_hooke": ("small-strain Hooke", GREEN),
           "grain_mpm_nodes": ("neo-Hookean on grid nodes", ORANGE)}
STAGES = (0.0, 0.2, 0.3, 9.9)  # strains of the pictures; the last one is the end


def _panels(count, width=DOUBLE_COLUMN, height=HEIGHT):
    figure = Figure(figsize=(width * MM, height * MM), layout="constrained")
    return figure, figure.subplots(1, count, squeeze=False)[0]


def draw_fig1(results):
    """sigma(eps) of one grain: bonded and elastic."""
    figure, (left, middle, right) = _panels(3)
    highest = 0.0
    for number, bonded in enumerate(results.grains["grain_bpm"]):
        stress = measure.vertical_stress(bonded.series) / 1e6
        if number == 0:
            left.plot(bonded.series["strain"], stress, color=VERMILLION, lw=0.4, alpha=0.5)
        strain, stress = measure.envelope(bonded.series["strain"], stress)
        highest = max(highest, stress.max())
        left.plot(strain, measure.moving_mean(strain, stress), color=VERMILLION, lw=1.2 if number == 0 else 0.6,
                  label="mean over 1 %" if number == 0 else None)
    sigma_i = measure.characteristic_stress(results.grains["grain_bpm"][0])
    left.axhline(0.2 * sigma_i / 1e6, color=GREY, lw=0.7, ls=":", label=r"$\sigma_I/5$")
    left.set(xlabel=r"axial strain $\varepsilon$", ylabel=r"$\sigma$ [MPa]", title="bonded particles",
             xlim=(0, None), ylim=(0, 1.5 * highest))
    for name, (label, colour) in ELASTIC.items():
        if name not in results.grains:
            continue
        run = results.grains[name][0]
        middle.plot(run.series["strain"], measure.vertical_stress(run.series) / 1e6, color=colour, label=label)
        strain, force = reduced_force(run)
        right.plot(strain, force, color=colour)
    strain = np.linspace(0, 0.4, 200)
    right.plot(strain, johnson_force(approach(strain)), color=INK, lw=0.7, ls="--", label="Johnson")
    right.plot(strain, paper_force(strain), color=PURPLE, lw=0.9, ls=":", label="the paper's Eq. (2)")
    middle.set(xlabel=r"axial strain $\varepsilon$", ylabel=r"$\sigma$ [MPa]", title="elastic material points")
    right.set(xlabel=r"axial strain $\varepsilon$", ylabel=r"$F/(E^* R)$", title="the same, as a force")
    for axes in (middle, right):
        axes.set(xlim=(0, 0.4), ylim=(0, None))
    for axes in (left, middle, right):
        axes.legend(loc="upper left")
    return figure


def _draw_bands(axes, results, of_x, of_y, way=FAST, label="{} $\\mu = {:g}$"):
    """The mean of the samples of each kind as a line, their span as a band."""
    for (model, friction), (colour, dash) in LOOKS.items():
        curves = results.curves(way, model, friction)
        if curves:
            _draw_band(axes, curves, of_x, of_y, colour, dash, label.format(model.upper(), friction))


def _draw_band(axes, curves, of_x, of_y, colour, dash, label):
    one = band(curves, of_x, of_y)
    axes.plot(one.x, one.mean, color=colour, ls=dash, label=label)
    if len(curves) > 1:
        axes.fill_between(one.x, one.low, one.high, color=colour, alpha=0.2, lw=0)


def draw_fig2(results):
    """sigma/sigma0 over eps' of the packings, of the paper's wall and of a slow one."""
    figure, panels = _panels(3)
    for axes, way, title in zip(panels, (FAST, FAST, SLOW), ("the paper's wall", "the same", "a slow wall")):
        _draw_bands(axes, results, lambda c: c.strain_from_reference, lambda c: c.stress / c.reference_stress, way)
        axes.set(xlabel=r"strain from the reference state $\varepsilon'$", ylabel=r"$\sigma/\sigma_0$", xlim=(0, 0.26), title=title)
    elastic = [c.stress.max() / c.reference_stress for mu in FRICTIONS for c in results.curves(FAST, "mpm", mu)]
    panels[0].set(ylim=(0, 1.2 * max(elastic)))
    for axes in panels[1:]:
        axes.set(ylim=(0.5, None), yscale="log")
    panels[0].legend()
    return figure


def draw_fig3(results):
    """Z and Phi over eps; the early half of Z by other rules of contact."""
    figure, (left, middle, right) = _panels(3)
    _draw_bands(left, results, lambda c: c.strain, lambda c: c.z)
    _draw_bands(right, results, lambda c: c.strain, lambda c: c.phi_deformed)
    for way, colour, label in ((FAST, BLUE, "on outlines"), (EARLY, SKY, "1.1 cells early"), (NODES, GREEN, "on grid nodes")):
        for friction, dash in ((0.0, "-"), (0.5, "--")):
            curves = results.curves(way, "mpm", friction)
            if curves:
                _draw_band(middle, curves, lambda c: c.strain, lambda c: c.z, colour, dash, label if friction == 0 else None)
    middle.plot(0.08, 3, "o", color=PURPLE, ms=4, label="the paper")
    strain = np.linspace(0, max(c.strain.max() for m in MODELS for c in results.curves(FAST, m)), 100)
    right.plot(strain, 0.7 * np.exp(strain), color=GREY, lw=0.7, ls=":", label=r"$0.7\,e^{\varepsilon}$")
    left.set(xlabel=r"strain $\varepsilon$", ylabel="coordination number $Z$", xlim=(0, None), ylim=(0, None))
    middle.set(xlabel=r"strain $\varepsilon$", ylabel="$Z$ of elastic grains", xlim=(0, 0.16), ylim=(0, 4), title="where contact acts")
    right.set(xlabel=r"strain $\varepsilon$", ylabel=r"packing fraction $\Phi$", xlim=(0, None))
    left.legend()
    middle.legend(loc="upper left")
    right.legend(handles=right.get_lines()[-1:])
    return figure


def draw_fig4(results):
    """(Z - Z0)/(Z1 - Z0) over Phi - Phi0, with the square root, of the paper's wall and of a slow one."""
    figure, panels = _panels(2)
    for axes, way, title in zip(panels, (FAST, SLOW), ("the paper's wall", "a slow wall")):
        _draw_bands(axes, results, lambda c: c.phi - REFERENCE_PACKING_FRACTION, _scaled_coordination, way)
        distance = np.geomspace(0.004, 0.25, 50)
        axes.plot(distance, (distance / 0.2) ** 0.5, color=GREY, lw=0.7, ls=":", label=r"$(\Phi-\Phi_0)^{1/2}$")
        axes.set(xlabel=r"$\Phi - \Phi_0$", ylabel="$(Z - Z_0)/(Z_1 - Z_0)$", xscale="log", yscale="log", xlim=(0.004, 0.3),
                 ylim=(0.02, 1.3), title=title)
    panels[0].legend(loc="lower right")
    return figure


def _scaled_coordination(curve):
    """(Z - Z0)/(Z1 - Z0), Z0 at Phi = 0.8 and Z1 at Phi = 1, as the paper scales it."""
    start, end = np.interp((REFERENCE_PACKING_FRACTION, 1.0), curve.phi, curve.z)
    return np.maximum((curve.z - start) / (end - start), 1e-3)


def draw_packing(run):
    """The outlines of all grains at four strains, coloured by the mean pressure in each."""
    strains = np.interp([run[i].time for i in range(len(run))], run.series["time"], run.series["strain"])
    chosen = [run[int(np.argmin(abs(strains - stage)))] for stage in STAGES]
    figure, panels = _panels(len(chosen), height=LOW_HEIGHT)
    pressures = [_grain_pressure(snapshot) / 1e6 for snapshot in chosen]
    scale = ScalarMappable(PowerNorm(0.5, 0, max(p.max() for p in pressures)), colormaps["cividis"])
    for axes, snapshot, pressure in zip(panels, chosen, pressures):
        grain, x = snapshot.outlines["grain"], 1e3 * snapshot.outlines["position"]
        polygons = [x[grain == g] for g in range(int(grain.max()) + 1)]
        axes.add_collection(PolyCollection(polygons, facecolors=scale.to_rgba(pressure), edgecolors=INK, linewidths=0.25))
        for x0, y0, x1, y1 in 1e3 * snapshot.walls:
            axes.plot([x0, x1], [y0, y1], color=INK, lw=0.8)
        strain = np.interp(snapshot.time, run.series["time"], run.series["strain"])
        axes.set(aspect="equal", title=rf"$\varepsilon = {strain:.2f}$", ylim=(-0.5, 1.01e3 * chosen[0].walls.max()))
        axes.set_axis_off()
    figure.colorbar(scale, ax=panels.tolist(), label="mean pressure [MPa]")
    return figure


def _grain_pressure(snapshot):
    """Mean over the particles of each grain, weighted by their area [Pa]; none below zero is shown."""
    grain, weight = snapshot.particles["grain"].astype(int), snapshot.particles["radius"] ** 2
    total = np.bincount(grain, weight * snapshot.particles["pressure"])
    return np.maximum(total / np.bincount(grain, weight), 0)


DRAW = {"fig1": draw_fig1, "fig2": draw_fig2, "fig3": draw_fig3, "fig4": draw_fig4}
