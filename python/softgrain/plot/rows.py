"""Ways to look at the grain, one class each: what a panel shows, and the key beside the row of panels.

Each is built from snapshots of the whole run, so that its scale is the same in every panel. It raises NotRecorded
when they lack what it shows. To add a way: add a class, and its name to ROWS."""

from functools import partial

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.lines import Line2D

from .. import NotRecorded, colours, picture
from ..stress_unit import unit_for
from .scene import draw_chains, draw_polygons, draw_surface
from .style import GREY, PALE, POINT


def _draw_scale_bar(view, grid, row):
    """For rows that need no words."""
    radius = np.ptp(view.snapshots[0].particles["position"][:, 0]) / 2
    length = float(f"{radius:.0e}")  # one digit
    axes = grid.add_key_axes(row, width=length * grid.scale, height=0.7)
    axes.set_axis_off()
    axes.plot([0, 1], [0.5, 0.5], color="k", lw=1.2, solid_capstyle="butt")
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.annotate(f"{1e3 * length:g} mm", (0, 0.5), xytext=(0, 2), textcoords="offset points")


class Pressure:
    """Particles or cells coloured by pressure.

    Before the first step no contact carries a force; what the attraction alone would give is not shown."""

    def __init__(self, snapshots):
        self.surfaces = [self._surface(s) for s in snapshots]
        self.name = "pressure" if "pressure" in snapshots[0].particles else "contact pressure"
        known = [s.values for s in self.surfaces if not np.isnan(s.values).all()]
        if not known:
            raise NotRecorded("no snapshot after the first step, so no pressure")
        self.range = colours.range_of(np.concatenate(known))

    def draw(self, panel, index):
        self._fill(panel, self.surfaces[index])

    def draw_snapshot(self, panel, snapshot):
        """One that need not be among those that the range was made of."""
        self._fill(panel, self._surface(snapshot))

    def _fill(self, panel, surface):
        unknown = np.isnan(surface.values).all()
        draw_surface(panel, surface, PALE if unknown else self.range.rgb(surface.values))

    @staticmethod
    def _surface(snapshot):
        """Values in Pa; nan before the first step."""
        values = picture.pressure(snapshot)
        return picture.surface(snapshot, values if picture.has_forces(snapshot) else np.full_like(values, np.nan))

    def draw_key(self, grid, row):
        axes = grid.add_key_axes(row, width=2, height=0.75)
        ramp = LinearSegmentedColormap.from_list(self.range.map, colours.colours_of(self.range.map))
        unit = unit_for(self.range.low, self.range.high)
        scale = ScalarMappable(Normalize(self.range.low / unit.pascal, self.range.high / unit.pascal), ramp)
        extend = {0.0: "max"}.get(self.range.low, "both" if self.range.high else "min")
        bar = grid.figure.colorbar(scale, cax=axes, extend=extend, extendfrac=0.04)
        bar.set_label(f"{self.name} [{unit.name}]", labelpad=2)
        bar.outline.set_linewidth(0.5)
        axes.tick_params(direction="out", length=2, pad=2)


class Forces:
    """Contact forces between centres: width in proportion to force, the weaker the paler."""

    name = "contact forces"

    def __init__(self, snapshots):
        self.snapshots = snapshots
        if picture.is_elastic(snapshots[0]) and len(snapshots[0].body_radii()) < 2:
            raise NotRecorded("what two walls do to one grain is no chain")
        self.scale = picture.force_scale(snapshots)

    def draw(self, panel, index):
        snapshot = self.snapshots[index]
        draw_surface(panel, picture.bodies(snapshot), PALE)
        draw_chains(panel, picture.chains(snapshot, self.scale), colours.CHAINS)

    def draw_key(self, grid, row, colour=colours.CHAINS):
        axes = grid.add_key_axes(row, width=14, height=0.7)
        axes.set_axis_off()
        force = float(f"{self.scale.force / 2:.0e}")  # one digit
        width = self.scale.width * force / self.scale.force * grid.scale / POINT
        line = Line2D([], [], color=colour, lw=width, alpha=force / self.scale.force, solid_capstyle="butt")
        axes.legend([line], [f"{force:g} N/m"], loc="center left", borderaxespad=0, handlelength=1, handletextpad=0.4)


class Kinds:
    """The grains of a mixture, coloured by kind, in the order of the case; `names` are theirs."""

    name = "kinds"
    colours = ("#F0D9A8", "#3B6FA0", "#8C3B2E", "#5C8A4A")

    def __init__(self, snapshots, names=()):
        if "kind" not in snapshots[0].particles:
            raise NotRecorded("one kind of grains")
        self.snapshots = snapshots
        self.kinds = np.unique(snapshots[0].particles["kind"].astype(int))
        self.names = names

    def draw(self, panel, index):
        snapshot = self.snapshots[index]
        shapes = picture.grains(snapshot, picture.grain_means(snapshot, snapshot.particles["kind"].astype(float)))
        draw_surface(panel, shapes, [self._colour(kind) for kind in np.rint(shapes.values).astype(int)])

    def _colour(self, kind):
        return self.colours[kind % len(self.colours)]

    def draw_key(self, grid, row):
        axes = grid.add_key_axes(row, width=14, height=0.7)
        axes.set_axis_off()
        marks = [Line2D([], [], color=self._colour(kind), marker="o", ls="none", ms=4) for kind in self.kinds]
        axes.legend(marks, [self._name(kind) for kind in self.kinds], loc="center left", borderaxespad=0, handletextpad=0.4)

    def _name(self, kind):
        return self.names[kind] if kind < len(self.names) else f"kind {kind + 1}"


class Layers:
    """Particles, or the elastic grains of a packing, coloured by the layer in which they started: how they have flowed."""

    name = "initial layers"
    count = 12
    colours = np.array([(0.05, 0.27, 0.42), (0.93, 0.79, 0.48)])

    def __init__(self, snapshots):
        self.snapshots = snapshots
        first = snapshots[0]
        if any(len(s.particles["position"]) != len(first.particles["position"]) for s in snapshots):
            raise NotRecorded("the number of particles changes")
        grains = len(picture.outlines(first))
        if grains == 1 and picture.is_elastic(first) and picture.cells(first) is not None:
            raise NotRecorded("the cells of an elastic grain say more")
        self.of_grains = picture.shows_whole_grains(first) or (picture.is_elastic(first) and grains > 1)
        position, radius = first.particles["position"], first.particles["radius"]
        height, count = position[:, 1], self.count
        if self.of_grains:  # layers as thick as a grain
            height = picture.grain_means(first, height)
            radius = np.sqrt(np.bincount(first.particles["grain"].astype(int), radius**2))
            count = min(count, 1 + round(np.ptp(height) / (2 * radius.mean())))
        share = (height - height.min()) / (np.ptp(height) or 1)
        self.layer = np.minimum((share * count).astype(int), count - 1)

    def draw(self, panel, index):
        snapshot = self.snapshots[index]
        if self.of_grains:
            shapes = picture.grains(snapshot, self.layer)
        else:
            shapes = picture.surface(snapshot, self.layer.astype(float))
        draw_surface(panel, shapes, self.colours[np.rint(shapes.values).astype(int) % 2])

    draw_key = _draw_scale_bar


class Cells:
    """The grid of an elastic grain, which deforms with it."""

    name = "cells"

    def __init__(self, snapshots):
        self.snapshots = snapshots
        if len(picture.outlines(snapshots[0])) != 1 or not picture.is_elastic(snapshots[0]):
            raise NotRecorded("no single elastic grain")
        self.cells = [picture.cells(s) for s in snapshots]
        if any(cells is None for cells in self.cells):
            raise NotRecorded("points that are in no cells")

    def draw(self, panel, index):
        draw_surface(panel, picture.bodies(self.snapshots[index]), PALE)
        draw_polygons(panel, self.cells[index], facecolors="none", edgecolors=GREY, linewidths=0.25)

    draw_key = _draw_scale_bar


ROWS = (Pressure, Forces, Kinds, Layers, Cells)


def rows_of(case):
    """ROWS, which call the kinds of grains what the case calls them."""
    names = [kind["name"] for kind in case.get("kind", ()) if "name" in kind]
    return [partial(Kinds, names=names) if row is Kinds else row for row in ROWS]
