"""A frame as SVG: grains coloured by pressure, force chains, walls, and a legend; scales are those of the whole run.

In space the faces that look at us, the farthest first, and no chains, which lie behind them."""

from typing import NamedTuple

import numpy as np

from .. import colours, picture, solids, view
from ..run import NotRecorded

WIDTH = 1000  # of the picture [px]
MARGIN = 0.03  # of its width
LEGEND = 60  # height of what stands below [px]
TEXT = 'font-family="sans-serif" font-size="18"'


class Scale(NamedTuple):
    """What all frames of a run share."""

    box: tuple  # ((x0, x1), (y0, y1)) [m]
    colour: colours.Range | None  # of pressure [Pa]
    force: picture.ForceScale | None


def scale_of(snapshots: list) -> Scale:
    """From frames evenly over the run."""
    if solids.in_space(snapshots[0]):
        snapshots = view.with_surfaces(snapshots)
        x0, x1, y0, y1 = view.extent(snapshots)
        return Scale(((x0, x1), (y0, y1)), colours.range_of(np.concatenate([s.surface["pressure"] for s in snapshots])), None)
    try:
        surfaces = [picture.surface(s, picture.pressure(s)).values for s in snapshots if picture.has_forces(s)]
        colour = colours.range_of([value for values in surfaces for value in values]) if surfaces else None
    except NotRecorded:
        colour = None
    try:
        force = picture.force_scale(snapshots)
    except NotRecorded:
        force = None
    return Scale(picture.box(snapshots), colour, force)


def write_svg(snapshot, scale, file):
    """One frame; positions are at one scale and one place in all frames."""
    (x0, x1), (y0, y1) = scale.box
    pixels = WIDTH * (1 - 2 * MARGIN) / (x1 - x0)
    height = pixels * (y1 - y0) + 2 * MARGIN * WIDTH

    def place(points):
        """Pixels from the top left corner."""
        return MARGIN * WIDTH + pixels * ((points - (x0, y1)) * (1, -1))

    file.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height + LEGEND:.1f}">\n'
               f"<title>step {snapshot.step}, time {snapshot.time:.6g} s</title>\n")
    if solids.in_space(snapshot):
        file.writelines(_faces(snapshot, scale, place))
    else:
        file.writelines(_plane(snapshot, scale, place, pixels))
    if scale.colour:
        file.writelines(_legend(scale.colour, MARGIN * WIDTH, height))
    file.write("</svg>\n")


def _plane(snapshot, scale, place, pixels):
    (x0, x1), (y0, y1) = scale.box
    height = pixels * (y1 - y0) + 2 * MARGIN * WIDTH
    yield from _surface(snapshot, scale, place, pixels)
    if _shows_chains(snapshot, scale):
        yield from _chains(picture.chains(snapshot, scale.force), _chain_colour(scale), place, pixels)
    for wall in picture.walls(snapshot):
        yield _line(place(wall), 'stroke-width="3"')
    for edge in picture.cell_edges(snapshot):
        yield _line(place(edge), 'stroke-width="1" stroke-dasharray="6 4"')
    if _shows_chains(snapshot, scale):
        yield from _chain_key(scale, WIDTH * (1 - MARGIN), height, pixels)


def _faces(snapshot, scale, place):
    """Behind them the edges of a box, or both walls of a single sphere."""
    walls = view.walls(snapshot)
    for wall in walls:
        if len(walls) > 2:
            yield f'<polygon points="{_corners(place(wall))}" fill="none" stroke="#777777" stroke-width="1"/>\n'
        else:
            yield _polygon(place(wall), "#dddddd", "#777777")
    faces = view.faces(snapshot)
    colour = scale.colour.rgb(snapshot.surface["pressure"][faces.quad]) * faces.shade[:, None]
    for polygon, fill in zip(faces.corners, colours.words_of(colour)):
        yield _polygon(place(polygon), fill, fill)


def _shows_chains(snapshot, scale):
    """What two walls do to one elastic grain is no chain."""
    return scale.force and not (picture.is_elastic(snapshot) and len(snapshot.body_radii()) < 2)


def _chain_colour(scale):
    return scale.colour.chains if scale.colour else colours.CHAINS


def _surface(snapshot, scale, place, pixels):
    try:
        shapes = picture.surface(snapshot, picture.pressure(snapshot))
    except NotRecorded:
        shapes = picture.bodies(snapshot)
    known = scale.colour and picture.has_forces(snapshot)
    fills = scale.colour.hexadecimal(shapes.values) if known else [colours.PALE] * len(shapes.values)
    whole = len(shapes.polygons) == len(shapes.rims)
    for polygon, fill in zip(shapes.polygons, fills):
        stroke = colours.INK if whole else fill  # between cells no ground shines through
        yield _polygon(place(polygon), fill, stroke)
    if not len(shapes.polygons):
        for (x, y), radius, fill in zip(place(shapes.centres), pixels * shapes.radii, fills):
            yield f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{radius:.2f}" fill="{fill}" stroke="#c8c8c8" stroke-width="0.5"/>\n'
    if not whole:
        for rim in shapes.rims:
            yield _polygon(place(rim), "none", colours.INK)


def _corners(points):
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points)


def _polygon(points, fill, stroke):
    return f'<polygon points="{_corners(points)}" fill="{fill}" stroke="{stroke}" stroke-width="0.7"/>\n'


def _chains(chains, colour, place, pixels):
    yield f'<g class="chains" stroke="{colour}" stroke-linecap="round">\n'
    for segment, width, opacity in zip(chains.segments, pixels * chains.widths, chains.opacities):
        yield _line(place(segment), f'stroke-width="{width:.2f}" stroke-opacity="{opacity:.2f}"', stroke=None)
    yield "</g>\n"


def _line(ends, look, stroke=colours.INK):
    (ax, ay), (bx, by) = ends
    paint = f'stroke="{stroke}" ' if stroke else ""
    return f'<line x1="{ax:.2f}" y1="{ay:.2f}" x2="{bx:.2f}" y2="{by:.2f}" {paint}{look}/>\n'


def _legend(colour, left, top):
    """A bar with its ends in words."""
    stops = [colour.low + k / 16 * (colour.high - colour.low) for k in range(17)]
    for k, fill in enumerate(colour.hexadecimal(stops)):
        yield f'<rect x="{left + 20 * k:.1f}" y="{top:.1f}" width="20.5" height="14" fill="{fill}"/>\n'
    reach = max(-colour.low, colour.high)
    factor, unit = next(((f, u) for f, u in ((1e6, "MPa"), (1e3, "kPa")) if reach >= f), (1, "Pa"))
    for value, x, anchor in ((colour.low, left, "start"), (colour.high, left + 340, "end")):
        yield f'<text x="{x:.1f}" y="{top + 36:.1f}" text-anchor="{anchor}" {TEXT}>{value / factor:.3g}</text>\n'
    yield f'<text x="{left + 360:.1f}" y="{top + 14:.1f}" {TEXT}>pressure [{unit}]</text>\n'


def _chain_key(scale, right, top, pixels):
    """A line as wide as half of the largest force is, with its force."""
    force = float(f"{scale.force.force / 2:.0e}")  # one digit
    share = force / scale.force.force
    yield (f'<line class="chain-key" x1="{right - 150:.1f}" y1="{top + 7:.1f}" x2="{right - 110:.1f}" y2="{top + 7:.1f}" '
           f'stroke="{_chain_colour(scale)}" stroke-width="{pixels * scale.force.width * share:.2f}" stroke-opacity="{share:.2f}"/>\n')
    yield f'<text x="{right - 100:.1f}" y="{top + 14:.1f}" {TEXT}>{force:g} N/m</text>\n'
