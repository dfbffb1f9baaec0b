"""python3 -m softgrain.voronoi RUN: cells of the grains of one snapshot, as two tables."""

import sys
from pathlib import Path

import softgrain

from ..verb import carry_out
from . import cells_of, write_cells, write_faces
from .cells import POINTS


def tabulate(options):
    """Writes both files under their names when they are whole; returns their paths."""
    run = softgrain.open(options.run)
    if len(run) == 0:
        raise ValueError(f"{run.path} has no snapshots")
    frame = -1 if options.frame is None else options.frame
    if not -len(run) <= frame < len(run):
        raise ValueError(f"{run.path} has {len(run)} snapshots; --frame {frame} is none of them")
    snapshot = run[frame]
    cells = cells_of(snapshot, options.points or POINTS)
    name = f"{run.name}_{snapshot.step:06d}.voronoi.csv"
    path = Path(options.output) if options.output else run.path / "export" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    paths = path, path.with_name(path.stem + "_faces" + path.suffix)
    for write, target in zip((write_cells, write_faces), paths):
        temporary = target.with_name(target.name + ".tmp")
        with temporary.open("w") as file:
            write(snapshot, cells, file)
        temporary.replace(target)
    return paths


def main(arguments=None):
    return carry_out("voronoi", arguments, lambda options: print(*tabulate(options), sep="\n"))


if __name__ == "__main__":
    sys.exit(main())
