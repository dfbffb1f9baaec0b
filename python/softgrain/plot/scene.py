"""The pieces of a picture of particles: disks, plates and contact forces, drawn into given axes."""

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from .style import INK

STRONG, WEAK = "#A11D33", "#8FA9BD"


def draw_disks(axes, snapshot, colours, rim="none"):
    """Filled disks; `colours` is one colour or one RGBA row per particle.

    Pixels also in SVG and PDF: as paths, a figure of 30 000 disks takes 20 MB."""
    position, diameter = snapshot.particles["position"], 2 * snapshot.particles["radius"]
    look = dict(facecolors=colours, edgecolors=rim, linewidths=0.15, rasterized=True)
    disks = EllipseCollection(diameter, diameter, np.zeros_like(diameter), units="xy", offsets=position,
                              offset_transform=axes.transData, **look)
    axes.add_collection(disks)


def draw_outlines(axes, snapshot, colours):
    """Grains filled within their outlines; `colours` is one colour or one RGBA row per grain."""
    grain, position = snapshot.outlines["grain"], snapshot.outlines["position"]
    polygons = np.split(position, np.flatnonzero(np.diff(grain)) + 1)
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=INK, linewidths=0.3))


def grain_means(snapshot, values):
    """Mean of a field of material points over each grain, weighted by their areas."""
    grain, area = snapshot.particles["grain"], snapshot.particles["radius"] ** 2
    return np.bincount(grain, area * values) / np.bincount(grain, area)


MOST_GRAINS_WITH_FIELDS = 60  # beyond, a triangulation takes too long and shows nothing more


def has_cells(snapshot):
    """Whether the particles are material points in cells of four, with outlines around them."""
    many = np.ptp(snapshot.outlines["grain"]) >= MOST_GRAINS_WITH_FIELDS if "grain" in snapshot.outlines else True
    return not many and {"stress", "grain"} <= snapshot.particles.keys()


def draw_cells(axes, snapshot, values, scale):
    """A field of material points: the mean of each cell's four, between the outlines of its grain."""
    cells = snapshot.particles["position"].reshape(-1, 4, 2).mean(axis=1)
    means = values.reshape(-1, 4).mean(axis=1)
    grain = snapshot.particles["grain"].astype(int)[::4]
    for g in range(grain.max() + 1):
        outline = snapshot.outlines["position"][snapshot.outlines["grain"] == g]
        inside = cells[grain == g]
        nearest = np.argmin(((outline[:, None] - inside[None]) ** 2).sum(axis=2), axis=1)
        points = np.concatenate([inside, outline])
        field = np.concatenate([means[grain == g], means[grain == g][nearest]])
        surface = axes.tripcolor(*points.T, field, shading="gouraud", norm=scale.norm, cmap=scale.cmap, rasterized=True)
        rim = axes.fill(*outline.T, facecolor="none", edgecolor=INK, lw=0.4)[0]
        surface.set_clip_path(rim)


def draw_plates(axes, snapshot, thickness):
    """A bar along each wall, on the side away from the particles."""
    centre = snapshot.particles["position"].mean(axis=0)
    bars = []
    for start, end in snapshot.walls.reshape(-1, 2, 2):
        normal = np.array([start[1] - end[1], end[0] - start[0]]) / np.hypot(*(end - start))
        away = normal * np.sign(normal @ (start - centre))
        bars.append([start, end, end + thickness * away, start + thickness * away])
    axes.add_collection(PolyCollection(bars, facecolors=INK, edgecolors="none"))


def draw_forces(axes, snapshot, largest, widest):
    """Contact forces as segments between centres, as wide as they are large: `widest` points at `largest`.

    Forces above the snapshot's mean (the strong network) are dark, drawn over the others."""
    pair, force = pairs_of_bodies(snapshot)
    position = snapshot.bodies()
    strong = force > force.mean() if force.size else np.empty(0, bool)
    for network, colour in ((~strong, WEAK), (strong, STRONG)):
        width = widest * np.minimum(force[network] / largest, 1)
        axes.add_collection(LineCollection(position[pair[network]], linewidths=width, colors=colour,
                                           capstyle="round"))


def pairs_of_bodies(snapshot):
    """(pair (m, 2), force (m,)) of the contacts between two particles, or grains, that push; empty if not recorded."""
    if not {"pair", "force"} <= snapshot.contacts.keys():
        return np.empty((0, 2), int), np.empty(0)
    pair, force = snapshot.contacts["pair"].astype(int), snapshot.contacts["force"]
    count = len(snapshot.bodies())
    inside = (pair >= 0).all(axis=1) & (pair < count).all(axis=1) & (force > 0)
    return pair[inside], force[inside]


def extent(snapshot, margin):
    """(x0, x1, y0, y1) [m] of the particles, and of a box's walls, with a margin all around."""
    position, radius = snapshot.particles["position"], snapshot.particles["radius"][:, None]
    low, high = (position - radius).min(axis=0), (position + radius).max(axis=0)
    if len(snapshot.walls) > 2:  # plates are longer than the grain between them
        corners = snapshot.walls.reshape(-1, 2)
        low, high = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))
    low, high = low - margin, high + margin
    return low[0], high[0], low[1], high[1]
