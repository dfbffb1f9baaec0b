"""python3 -m softgrain.export RUN --to FORMAT: snapshots for other programs."""

import sys
from pathlib import Path

import softgrain

from .. import colours
from ..verb import carry_out
from . import scale_of, write_contacts, write_csv, write_grains, write_lammps, write_rocrate, write_svg, write_vtkhdf, write_xyz
from .paraview import write_scene

MOVIES = {"xyz": (write_xyz, "xyz"), "lammps": (write_lammps, "dump"), "vtkhdf": (write_vtkhdf, "vtkhdf")}  # all frames in one file
ONE_FRAME = {"csv": (write_csv, "csv"), "contacts": (write_contacts, "contacts.csv"), "grains": (write_grains, "grains.csv"),
             "svg": (write_svg, "svg")}


def export(options):
    """Writes the file under its name when it is whole; returns its path."""
    run = softgrain.open(options.run)
    if options.to != "rocrate" and (options.license or options.author):
        raise ValueError("--license and --author belong to --to rocrate")
    if options.to == "rocrate":
        if options.output:
            raise ValueError(f"--to rocrate describes {run.path} where it is; it takes no --output")
        return write_rocrate(run, options.license, options.author)
    if len(run) == 0:
        raise ValueError(f"{run.path} has no snapshots")
    if options.to == "paraview":
        return write_scene(run, run.path / "paraview")
    frame = options.frame if options.frame is not None or options.to in MOVIES else -1
    if not -len(run) <= (frame or 0) < len(run):
        raise ValueError(f"{run.path} has {len(run)} snapshots; --frame {frame or 0} is none of them")
    if options.to not in {**MOVIES, **ONE_FRAME}:
        raise ValueError(f"--to {options.to} is written by the program itself: softgrain export")
    write, suffix = {**MOVIES, **ONE_FRAME}[options.to]
    name = run.name if frame is None else f"{run.name}_{run[frame].step:06d}"
    path = Path(options.output) if options.output else run.path / "export" / f"{name}.{suffix}"
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".tmp")
    if options.to == "vtkhdf":
        write(*what(run, options.to, frame), temporary)
    else:
        with temporary.open("w") as file:
            write(*what(run, options.to, frame), file)
    return temporary.replace(path)


def what(run, form, frame):
    """What the writer of a format takes before its file."""
    if form in MOVIES:
        return [run[i] for i in (range(len(run)) if frame is None else [frame])],
    if form == "svg":
        return run[frame], scale_of([run[i] for i in colours.sampled(len(run))])
    return run[frame],


def main(arguments=None):
    return carry_out("export", arguments, lambda options: print(export(options)))


if __name__ == "__main__":
    sys.exit(main())
