"""python3 -m softgrain.export RUN --to FORMAT: snapshots for other programs."""

import argparse
import sys
from pathlib import Path

import softgrain

from . import write_csv, write_lammps, write_svg, write_xyz
from .paraview import write_scene

USAGE_ERROR, IO_ERROR = 2, 4  # exit codes, those of the program `softgrain`
MOVIES = {"xyz": (write_xyz, "xyz"), "lammps": (write_lammps, "dump")}  # all frames in one file
PICTURES = {"csv": (write_csv, "csv"), "svg": (write_svg, "svg")}  # of one frame


def parse(arguments):
    parser = argparse.ArgumentParser(prog="softgrain export", description="Writes snapshots for other programs.")
    parser.add_argument("run", metavar="RUN", type=Path)
    parser.add_argument("--to", choices=(*MOVIES, *PICTURES, "paraview"), required=True)
    parser.add_argument("--frame", type=int, help="snapshot, from 0; -1 is the last")
    parser.add_argument("-o", "--output", metavar="FILE", type=Path)
    return parser.parse_args(arguments)


def export(options):
    """Writes the file under its name when it is whole; returns its path."""
    run = softgrain.open(options.run)
    if len(run) == 0:
        raise ValueError(f"{run.path} has no snapshots")
    if options.to == "paraview":
        return write_scene(run, run.path / "paraview")
    frame = options.frame if options.frame is not None or options.to in MOVIES else -1
    if not -len(run) <= (frame or 0) < len(run):
        raise ValueError(f"{run.path} has {len(run)} snapshots; --frame {frame or 0} is none of them")
    write, suffix = {**MOVIES, **PICTURES}[options.to]
    name = run.name if frame is None else f"{run.name}_{run[frame].step:06d}"
    path = options.output or run.path / "export" / f"{name}.{suffix}"
    path.parent.mkdir(parents=True, exist_ok=True)
    frames = range(len(run)) if frame is None else [frame]
    temporary = path.with_name(path.name + ".tmp")
    with temporary.open("w") as file:
        write((run[i] for i in frames) if options.to in MOVIES else run[frame], file)
    return temporary.replace(path)


def main(arguments=None):
    options = parse(arguments)
    try:
        print(export(options))
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return USAGE_ERROR
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return IO_ERROR
    return 0


if __name__ == "__main__":
    sys.exit(main())
