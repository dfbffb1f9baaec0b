"""The pieces of `softgrain.picture`, drawn into a panel of a Matplotlib figure."""

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from .. import picture
from .style import INK, POINT

MOST_VECTORS = 3000  # polygons or disks of a panel; more are pixels also in SVG and PDF: 30 000 would take 20 MB
RIM = "#C8C8C8"  # of disks: a pressure of zero may be as white as the paper


def draw_surface(panel, surface, colours):
    """Polygons or disks, filled; `colours` is one colour or one row for each. Then the rims over them."""
    many = dict(rasterized=len(surface.values) > MOST_VECTORS)
    if len(surface.polygons) == len(surface.rims) > 0:  # whole grains carry their own rims
        rim = 0.3 if len(surface.rims) < 100 else 0.15  # thin enough for chains to be seen over many
        draw_polygons(panel, surface.polygons, facecolors=colours, edgecolors=INK, linewidths=rim)
        return
    if len(surface.polygons):
        draw_polygons(panel, surface.polygons, facecolors=colours, edgecolors="face", linewidths=0.15, **many)
    else:
        diameter = 2 * surface.radii * panel.scale
        panel.add(EllipseCollection(diameter, diameter, np.zeros_like(diameter), units="xy", facecolors=colours,
                                    edgecolors=RIM, linewidths=0.15, offsets=surface.centres,
                                    offset_transform=panel.transform, **many))
    if surface.rims:
        draw_polygons(panel, surface.rims, facecolors="none", edgecolors=INK, linewidths=0.4)


def draw_polygons(panel, polygons, **look):
    panel.add(PolyCollection(polygons, transform=panel.transform, **look))


def draw_chains(panel, chains, colour):
    """Segments as wide as `chains` says, at the scale of the panel."""
    if len(chains.widths) == 0:
        return
    panel.add(LineCollection(chains.segments, linewidths=chains.widths * panel.scale / POINT, colors=colour,
                             alpha=chains.opacities, capstyle="round", rasterized=len(chains.widths) > MOST_VECTORS,
                             transform=panel.transform))


def draw_walls(panel, snapshot, thickness):
    """A bar along each wall, on the side away from the particles; a line along the edges of a periodic cell."""
    centre = snapshot.particles["position"].mean(axis=0)
    bars = []
    edges = picture.cell_edges(snapshot)
    panel.add(LineCollection(edges, linewidths=0.6, linestyles="dashed", colors=INK, transform=panel.transform))
    for start, end in picture.walls(snapshot):
        if np.array_equal(start, end):
            continue  # an open top
        normal = np.array([start[1] - end[1], end[0] - start[0]]) / np.hypot(*(end - start))
        away = normal * np.sign(normal @ (start - centre))
        bars.append([start, end, end + thickness * away, start + thickness * away])
    draw_polygons(panel, bars, facecolors=INK, edgecolors="none")


def extent(snapshot, margin):
    """(x0, x1, y0, y1) [m] of the bodies, and of a box's walls, with a margin all around."""
    position, radius = snapshot.particles["position"], snapshot.particles["radius"][:, None]
    corners = [position - radius, position + radius, *(polygon for _, polygon in picture.outlines(snapshot))]
    if len(snapshot.walls) > 2:  # walls of a single grain are longer than the grain between them
        corners.append(snapshot.walls.reshape(-1, 2))
    corners = np.concatenate(corners)
    low, high = corners.min(axis=0) - margin, corners.max(axis=0) + margin
    return low[0], high[0], low[1], high[1]
