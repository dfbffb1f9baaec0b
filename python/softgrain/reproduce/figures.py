"""The paper's four figures and the packings themselves."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure

from .. import measure
from ..plot.style import BLUE, DOUBLE_COLUMN, GREEN, GREY, INK, MM, PURPLE, SINGLE_COLUMN, VERMILLION
from .curves import REFERENCE_PACKING_FRACTION, coordination_law
from .single_grain import approach, johnson_force, paper_force, reduced_force

HEIGHT, LOW_HEIGHT = 62, 42  # [mm]
LOOKS = {("bpm", 0.0): (VERMILLION, "-"), ("bpm", 0.5): (VERMILLION, "--"),
         ("mpm", 0.0): (BLUE, "-"), ("mpm", 0.5): (BLUE, "--")}
ELASTIC = {"grain_mpm": ("neo-Hookean", BLUE), "grain_mpm_hooke": ("small-strain Hooke", GREEN)}
STAGES = (0.0, 0.2, 0.3, 9.9)  # strains of the pictures; the last one is the end


def _panels(count, width=DOUBLE_COLUMN, height=HEIGHT):
    figure = Figure(figsize=(width * MM, height * MM), layout="constrained")
    return figure, figure.subplots(1, count, squeeze=False)[0]


def draw_fig1(results):
    """sigma(eps) of one grain: bonded and elastic."""
    figure, (left, middle, right) = _panels(3)
    bonded = results.grains["grain_bpm"]
    sigma_i = measure.characteristic_stress(bonded)
    left.plot(bonded.series["strain"], measure.vertical_stress(bonded.series) / 1e6, color=VERMILLION, lw=0.4, alpha=0.7)
    strain, stress = measure.envelope(bonded.series["strain"], measure.vertical_stress(bonded.series))
    left.plot(strain, measure.moving_mean(strain, stress) / 1e6, color=VERMILLION, lw=1.3, label="mean over 1 %")
    left.axhline(0.2 * sigma_i / 1e6, color=GREY, lw=0.7, ls=":", label=r"$\sigma_I/5$")
    left.set(xlabel=r"axial strain $\varepsilon$", ylabel=r"$\sigma$ [MPa]", title="bonded particles",
             xlim=(0, None), ylim=(0, 1.6 * stress.max() / 1e6))
    for name, (label, colour) in ELASTIC.items():
        run = results.grains[name]
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


def _each(results):
    """(curve, look of its line) of every packing; one label for each kind."""
    for (model, friction), curves in results.packings.items():
        colour, dash = LOOKS[model, friction]
        for number, curve in enumerate(curves):
            label = rf"{model.upper()}, $\mu = {friction:g}$" if number == 0 else None
            yield curve, dict(color=colour, ls=dash, lw=1.0 if len(curves) == 1 else 0.7, label=label)


def draw_fig2(results):
    """sigma/sigma0 over eps' of the packings."""
    figure, (left, right) = _panels(2)
    for curve, look in _each(results):
        after = curve.after_reference
        for axes in (left, right):
            axes.plot(curve.strain_from_reference[after], curve.stress[after] / curve.reference_stress, **look)
    elastic = [c.stress.max() / c.reference_stress for (model, _), all_c in results.packings.items() if model == "mpm"
               for c in all_c]
    left.set(ylim=(0, 1.2 * max(elastic)))
    right.set(ylim=(0.5, None), yscale="log")
    for axes in (left, right):
        axes.set(xlabel=r"strain from the reference state $\varepsilon'$", ylabel=r"$\sigma/\sigma_0$", xlim=(0, None))
    left.legend()
    return figure


def draw_fig3(results):
    """Z and Phi over eps."""
    figure, (left, right) = _panels(2)
    for curve, look in _each(results):
        left.plot(curve.strain, curve.z, **look)
        right.plot(curve.strain, curve.phi_deformed, **look)
    strain = np.linspace(0, max(c.strain.max() for c, _ in _each(results)), 100)
    right.plot(strain, 0.7 * np.exp(strain), color=GREY, lw=0.7, ls=":", label=r"$0.7\,e^{\varepsilon}$")
    left.set(xlabel=r"strain $\varepsilon$", ylabel="coordination number $Z$", xlim=(0, None), ylim=(0, None))
    right.set(xlabel=r"strain $\varepsilon$", ylabel=r"packing fraction $\Phi$", xlim=(0, None))
    left.legend()
    right.legend(handles=right.get_lines()[-1:])
    return figure


def draw_fig4(results):
    """(Z - Z0)/(Z1 - Z0) over Phi - Phi0, with the square root."""
    figure, (axes,) = _panels(1, SINGLE_COLUMN)
    for curve, look in _each(results):
        law, after = coordination_law(curve), curve.phi > REFERENCE_PACKING_FRACTION + 0.002
        if law:
            axes.plot(curve.phi[after] - REFERENCE_PACKING_FRACTION, (curve.z[after] - law.z0) / (law.z1 - law.z0), **look)
    distance = np.geomspace(0.004, 0.25, 50)
    axes.plot(distance, (distance / distance[-1]) ** 0.5, color=GREY, lw=0.7, ls=":", label=r"$(\Phi-\Phi_0)^{1/2}$")
    axes.set(xlabel=r"$\Phi - \Phi_0$", ylabel="$(Z - Z_0)/(Z_1 - Z_0)$", xscale="log", yscale="log", ylim=(0.02, 1.3))
    axes.legend(loc="lower right")
    return figure


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
