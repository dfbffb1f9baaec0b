"""A frame as SVG: grains by their outlines or their particles, coloured by pressure, and the walls."""

import numpy as np

from .particles import box

WIDTH = 1000  # of the picture [px]
MARGIN = 0.03  # of its width
VIRIDIS = np.array([(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)])
INK = "#222222"


def write_svg(snapshot, file):
    """Outlines are filled where material points carry the grain; else its particles are drawn as disks."""
    (x0, x1), (y0, y1), _ = box(snapshot)
    scale = WIDTH * (1 - 2 * MARGIN) / (x1 - x0)
    height = scale * (y1 - y0) + 2 * MARGIN * WIDTH

    def place(points):
        """Pixels from the top left corner."""
        return MARGIN * WIDTH + scale * ((np.asarray(points) - (x0, y1)) * (1, -1))

    file.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.1f}">\n'
               f"<title>step {snapshot.step}, time {snapshot.time:.6g} s</title>\n")
    low, high = _pressure_range(snapshot)
    if high > low:
        file.write(f"<desc>colour: pressure from {low:.4g} Pa (violet) to {high:.4g} Pa (yellow)</desc>\n")
    file.writelines(_outlines(snapshot, place) if _has_points(snapshot) else _disks(snapshot, place, scale))
    for wall in snapshot.walls:
        (ax, ay), (bx, by) = place(wall.reshape(2, 2))
        file.write(f'<line x1="{ax:.2f}" y1="{ay:.2f}" x2="{bx:.2f}" y2="{by:.2f}" stroke="{INK}" stroke-width="2"/>\n')
    file.write("</svg>\n")


def outline_polygons(snapshot):
    """(grain, vertices (k, 2) [m]) of each outline."""
    if not snapshot.outlines:
        return []
    grain, position = snapshot.outlines["grain"], snapshot.outlines["position"]
    starts = np.flatnonzero(np.diff(grain)) + 1
    return [(int(part[0]), vertices) for part, vertices in zip(np.split(grain, starts), np.split(position, starts))]


def _has_points(snapshot):
    """Whether the particles are material points, which stand for an area and not for disks."""
    return bool(snapshot.outlines) and "J" in snapshot.particles


def _outlines(snapshot, place):
    particles = snapshot.particles
    colours = _colours(snapshot, np.array([particles["pressure"][particles["grain"] == grain].mean()
                                           for grain, _ in outline_polygons(snapshot)]))
    for (_, vertices), colour in zip(outline_polygons(snapshot), colours):
        points = " ".join(f"{x:.2f},{y:.2f}" for x, y in place(vertices))
        yield f'<polygon points="{points}" fill="{colour}" stroke="{INK}" stroke-width="0.7"/>\n'


def _disks(snapshot, place, scale):
    particles = snapshot.particles
    colours = _colours(snapshot, particles.get("pressure", np.zeros(len(particles["radius"]))))
    for (x, y), radius, colour in zip(place(particles["position"]), scale * particles["radius"], colours):
        yield f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{radius:.2f}" fill="{colour}"/>\n'


def _pressure_range(snapshot):
    """From the 3rd to the 97th percentile: a few extremes do not wash out the rest."""
    pressure = snapshot.particles.get("pressure", np.zeros(1))
    return np.percentile(pressure, 3), np.percentile(pressure, 97)


def _colours(snapshot, pressure):
    low, high = _pressure_range(snapshot)
    share = np.clip((pressure - low) / (high - low), 0, 1) if high > low else np.full(len(pressure), 0.5)
    channels = [np.interp(share, np.linspace(0, 1, len(VIRIDIS)), channel) for channel in VIRIDIS.T]
    return [f"#{int(r):02x}{int(g):02x}{int(b):02x}" for r, g, b in zip(*channels)]
