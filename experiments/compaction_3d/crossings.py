"""How deep the smooth surfaces of grains lie in each other, and in walls: looked for on the surfaces alone, without the contacts.

    crossings.py RUN [--fine 4] [--move GRAIN,SHARE]

Each patch is drawn by fine x fine points. Of each point x and each other grain the nearest drawn point y with its normal n says
how deep x lies in that grain, -(x - y) . n; the points are so dense that this is right to about (0.5/fine of a quad)^2/2R, 5e-4 R of
6 cells. The deepest points are then asked again by the solid angle that the drawn surface of the other grain fills as seen from x:
4 pi inside, 0 outside. --move puts one grain nearer to its nearest neighbour by a share of its radius, so that the check can be seen to fail."""

import argparse
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))

from softgrain import patches, solids  # noqa: E402
from softgrain.snapshot import Snapshot  # noqa: E402


def drawn(snapshot, fine):
    """Points, unit normals and grains, in cells of equal size of each patch."""
    at = (np.arange(fine) + 0.5) / fine
    u, v = (a.ravel() for a in np.meshgrid(at, at, indexing="ij"))
    points = patches.points_on(snapshot, u, v)
    return points.place, points.normal / np.linalg.norm(points.normal, axis=1)[:, None], points.grain


def depths(place, normal, grain, radius):
    """(depth [m], index of x, grain in which it lies) of all points that lie in another grain."""
    order = np.argsort(grain, kind="stable")
    begin = np.searchsorted(grain[order], np.arange(len(radius) + 1))
    of = [order[a:b] for a, b in zip(begin, begin[1:])]
    centre = np.array([place[points].mean(axis=0) for points in of])
    reach = np.array([np.linalg.norm(place[points] - c, axis=1).max() for points, c in zip(of, centre)])
    trees = [cKDTree(place[points]) for points in of]
    found = []
    for a, b in cKDTree(centre).query_pairs(2 * reach.max()):
        if np.linalg.norm(centre[a] - centre[b]) > reach[a] + reach[b]:
            continue
        for one, other in ((a, b), (b, a)):
            near = of[one][np.linalg.norm(place[of[one]] - centre[other], axis=1) < reach[other]]
            if len(near) == 0:
                continue
            y = of[other][trees[other].query(place[near])[1]]
            depth = -np.einsum("pk,pk->p", place[near] - place[y], normal[y])
            found += [(d, x, other) for d, x in zip(depth[depth > 0], near[depth > 0])]
    return sorted(found, reverse=True)


def solid_angle(x, corners):
    """That triangles (n, 3, 3) fill as seen from x (van Oosterom and Strackee 1983); counter-clockwise seen from outside."""
    r = corners - x
    length = np.linalg.norm(r, axis=2)
    a, b, c = r[:, 0], r[:, 1], r[:, 2]
    volume = np.einsum("tk,tk->t", a, np.cross(b, c))
    flat = (length.prod(axis=1) + np.einsum("tk,tk->t", a, b) * length[:, 2] + np.einsum("tk,tk->t", a, c) * length[:, 1]
            + np.einsum("tk,tk->t", b, c) * length[:, 0])
    return 2 * np.arctan2(volume, flat).sum()


def fine_triangles(snapshot, fine):
    """Of all grains: the patches as triangles with corners on the smooth surface (2 quads fine^2, 3, 3), and the grain of each."""
    at = np.linspace(0, 1, fine + 1)
    u, v = (a.ravel() for a in np.meshgrid(at, at, indexing="ij"))
    points = patches.points_on(snapshot, u, v)
    place = points.place.reshape(-1, fine + 1, fine + 1, 3)
    p, q, r, s = (place[:, i:fine + i, j:fine + j].reshape(-1, 3) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    grain = np.repeat(points.grain.reshape(-1, u.size)[:, 0], fine * fine)
    return np.concatenate([np.stack([p, q, r], axis=1), np.stack([p, r, s], axis=1)]), np.tile(grain, 2)


def look_at(snapshot, fine, move):
    place, normal, grain = drawn(snapshot, fine)
    volume = patches.measures(snapshot).volume
    radius = np.cbrt(3 * volume / (4 * np.pi))
    if move:
        which, share = int(move[0]), float(move[1])
        centre = solids.centres(snapshot)
        away = centre - centre[which]
        nearest = np.argsort(np.linalg.norm(away, axis=1))[1]
        place[grain == which] += share * radius[which] * away[nearest] / np.linalg.norm(away[nearest])
    found = depths(place, normal, grain, radius)
    mean = radius.mean()
    deep = np.array([depth for depth, _, _ in found]) / mean
    print(f"{len(place)} points; in other grains {len(deep)}; deepest {deep[0] if len(deep) else 0:.2g} R, "
          f"deeper than 0.002 R {np.sum(deep > 2e-3)}, than 0.005 R {np.sum(deep > 5e-3)}")
    inside = 0
    asked = [] if move else found[:20]
    if asked:
        corners, owner = fine_triangles(snapshot, fine)
    for _, x, other in asked:
        inside += abs(solid_angle(place[x], corners[owner == other])) > 2 * np.pi
    if asked:
        print(f"of the {len(asked)} deepest, {inside} lie within the other grain by its solid angle")
    walls = snapshot.surface["walls"].reshape(-1, 4, 3)
    if len(walls):
        low, high = walls.min(axis=(0, 1)), walls.max(axis=(0, 1))
        beyond = max((low - place).max(), (place - high).max()) / mean
        print(f"beyond the walls at most {max(beyond, 0):.2g} R; grains over the box {volume.sum() / np.prod(high - low):.4f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--fine", type=int, default=4)
    parser.add_argument("--move")
    options = parser.parse_args()
    for path in sorted((options.run / "snap").glob("s*.h5"), key=lambda p: int(p.stem[1:])):
        snapshot = Snapshot.read(path)
        print(f"step {snapshot.step}:")
        look_at(snapshot, options.fine, options.move.split(",") if options.move else None)


if __name__ == "__main__":
    main()
