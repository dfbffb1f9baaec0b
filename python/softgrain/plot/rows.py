"""Ways to look at the grain, one class each: what a panel shows, and the key beside the row of panels.

Each is built from all snapshots of a run, so that its scale is the same in every panel. It raises NotRecorded
when they lack what it shows. To add a way: add a class, and its name to ROWS."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D

from .. import NotRecorded, measure
from .scene import STRONG, WEAK, draw_cells, draw_disks, draw_forces, draw_outlines, grain_means, has_cells, pairs_of_bodies
from .style import PALE, POINT


class Pressure:
    """Particles coloured by pressure; the range leaves out the outermost 1 % of the run's values.

    Before the first step no contact carries a force; what the attraction alone would give is not shown."""

    def __init__(self, snapshots):
        self.snapshots = snapshots
        self.rim = "none"
        self.name = "pressure" if "pressure" in snapshots[0].particles else "contact pressure"
        self.values = [self._values(s) if _has_forces(s) else None for s in snapshots]
        known = [values for values in self.values if values is not None]
        if not known:
            raise NotRecorded("no pressure")
        low, high = np.percentile(np.concatenate(known), (1, 99))
        if low < -0.1 * high:  # tension too: zero is the middle of the range
            reach = max(-low, high)
            self.rim = "#C8C8C8"  # a pressure of zero is as white as the paper
            self.scale, self.extend = ScalarMappable(Normalize(-reach, reach), colormaps["PuOr_r"]), "both"
        else:
            self.scale, self.extend = ScalarMappable(Normalize(0, high), colormaps["cividis"]), "max"

    def draw(self, axes, index, _millimetres_per_metre):
        snapshot, values = self.snapshots[index], self.values[index]
        colours = PALE if values is None else self.scale.to_rgba(values)
        if values is not None and has_cells(snapshot):
            draw_cells(axes, snapshot, values, self.scale)
        elif snapshot.contacts_of_grains:
            draw_outlines(axes, snapshot, colours)
        else:
            draw_disks(axes, snapshot, colours, rim=self.rim)

    @staticmethod
    def _values(snapshot):
        """[MPa]; of many elastic grains the mean of each, for their points are too small to be seen."""
        values = _pressure(snapshot) / 1e6
        return grain_means(snapshot, values) if snapshot.contacts_of_grains and not has_cells(snapshot) else values

    def draw_key(self, grid, row):
        axes = grid.add_key_axes(row, width=2, height=0.75)
        bar = grid.figure.colorbar(self.scale, cax=axes, extend=self.extend, extendfrac=0.04)
        bar.set_label(f"{self.name} [MPa]", labelpad=2)
        bar.outline.set_linewidth(0.5)
        axes.tick_params(direction="out", length=2, pad=2)


class Forces:
    """Contact forces between particles: width in proportion to force, those above the panel's mean dark."""

    name = "contact forces"

    def __init__(self, snapshots):
        self.snapshots = snapshots
        forces = np.concatenate([pairs_of_bodies(s)[1] for s in snapshots])
        if forces.size == 0:
            raise NotRecorded("no contact forces")
        self.largest = np.percentile(forces, 99.5)
        self.diameter = 2 * snapshots[0].body_radii().mean() * (0.25 if snapshots[0].contacts_of_grains else 1)

    def draw(self, axes, index, millimetres_per_metre):
        if self.snapshots[index].contacts_of_grains:
            draw_outlines(axes, self.snapshots[index], PALE)
        else:
            draw_disks(axes, self.snapshots[index], PALE)
        draw_forces(axes, self.snapshots[index], self.largest, self._widest(millimetres_per_metre))

    def draw_key(self, grid, row):
        axes = grid.add_key_axes(row, width=14, height=0.7)
        axes.set_axis_off()
        force = float(f"{self.largest / 2:.0e}")  # one digit
        lines = [Line2D([], [], color=colour, lw=self._widest(grid.scale) * force / self.largest)
                 for colour in (STRONG, WEAK)]
        axes.legend(lines, ("> mean", "< mean"), title=f"width of\n{force:g} N/m", title_fontsize=7,
                    loc="center left", borderaxespad=0, handlelength=1.5, alignment="left")

    def _widest(self, millimetres_per_metre):
        """Line width [points] of the largest force: most of a particle's, or a part of an elastic grain's."""
        return 0.75 * self.diameter * millimetres_per_metre / POINT


class Layers:
    """Particles, or the elastic grains of a packing, coloured by the layer in which they started: how they have flowed."""

    name = "initial layers"
    count = 12
    colours = np.array([(0.05, 0.27, 0.42, 1), (0.93, 0.79, 0.48, 1)])

    def __init__(self, snapshots):
        self.snapshots = snapshots
        first = snapshots[0]
        self.of_grains = first.contacts_of_grains and len(first.body_radii()) > 1
        height = (first.bodies() if self.of_grains else first.particles["position"])[:, 1]
        if any(len(s.particles["position"]) != len(first.particles["position"]) for s in snapshots):
            raise NotRecorded("the number of particles changes")
        count = self.count
        if self.of_grains:  # layers as thick as a grain
            count = min(count, 1 + round(np.ptp(height) / (2 * first.body_radii().mean())))
        share = (height - height.min()) / np.ptp(height)
        self.layer = np.minimum((share * count).astype(int), count - 1)

    def draw(self, axes, index, _millimetres_per_metre):
        draw = draw_outlines if self.of_grains else draw_disks
        draw(axes, self.snapshots[index], self.colours[self.layer % 2])

    def draw_key(self, grid, row):
        """A scale bar: the layers need no words."""
        radius = np.ptp(self.snapshots[0].particles["position"][:, 0]) / 2
        length = float(f"{radius:.0e}")  # one digit
        axes = grid.add_key_axes(row, width=length * grid.scale, height=0.7)
        axes.set_axis_off()
        axes.plot([0, 1], [0.5, 0.5], color="k", lw=1.2, solid_capstyle="butt")
        axes.set(xlim=(0, 1), ylim=(0, 1))
        axes.annotate(f"{1e3 * length:g} mm", (0, 0.5), xytext=(0, 2), textcoords="offset points")


ROWS = (Pressure, Forces, Layers)


def _has_forces(snapshot):
    """Whether contacts carry forces yet; true if contacts were not recorded at all."""
    return snapshot.contacts.get("force", np.ones(1)).size > 0


def _pressure(snapshot):
    """The field `pressure`, or what the contact forces alone give [Pa]."""
    values = snapshot.particles.get("pressure")
    values = measure.contact_pressure(snapshot) if values is None else values
    if values is None:
        raise NotRecorded("neither pressure nor contact forces")
    return values
