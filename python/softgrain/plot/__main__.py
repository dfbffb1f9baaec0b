"""python3 -m softgrain.plot DIR...: the figures of a run; several runs share one stress-strain curve."""

import argparse
import sys
from pathlib import Path

import softgrain
from softgrain import plot

USAGE_ERROR, IO_ERROR = 2, 4  # exit codes, those of the program `softgrain`


def parse(arguments):
    parser = argparse.ArgumentParser(prog="softgrain plot", description="Draws the figures of runs.")
    parser.add_argument("runs", metavar="DIR", nargs="+", type=Path, help="directory of a run")
    parser.add_argument("-o", "--output", metavar="DIR", type=Path,
                        help="where the figures go (default: DIR/figures; ./figures for several runs)")
    parser.add_argument("--format", choices=("png", "svg", "pdf"), default="png")
    parser.add_argument("--kind", choices=("curve", "grain", "diagnostics", "all"), default="all")
    parser.add_argument("--normalise", action="store_true", help="stress over sigma_I = F0/<a0>")
    parser.add_argument("--dpi", type=int, default=300, help="resolution of PNG, and of disks in SVG and PDF")
    return parser.parse_args(arguments)


def draw(options):
    """Draws and saves every figure asked for; returns the paths. Names those that the data do not allow."""
    runs = [softgrain.open(path) for path in options.runs]
    names = distinct_names(runs)
    figures = {"curve": (runs, lambda: plot.draw_curve(runs, names, options.normalise))}
    for run, name in zip(runs, names):
        suffix = "" if len(runs) == 1 else "-" + name.replace("/", "-")
        figures["grain" + suffix] = ([run], lambda run=run: plot.draw_grain(run))
        figures["diagnostics" + suffix] = ([run], lambda run=run: plot.draw_diagnostics(run))

    folder = options.output or (options.runs[0] if len(runs) == 1 else Path()) / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name, (sources, draw_figure) in figures.items():
        if options.kind not in ("all", name.partition("-")[0]):
            continue
        try:
            with plot.style():
                path = folder / f"{name}.{options.format}"
                plot.save(draw_figure(), path, sources, options.dpi)
                paths.append(path)
        except softgrain.NotRecorded as missing:
            print(f"softgrain plot: no {name}: {missing}", file=sys.stderr)
    return paths


def distinct_names(runs):
    """The name of each run's directory, or the whole path where two runs have the same name."""
    names = [run.name for run in runs]
    return [name if names.count(name) == 1 else str(run.path) for run, name in zip(runs, names)]


def main(arguments=None):
    options = parse(arguments)
    try:
        paths = draw(options)
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return USAGE_ERROR
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return IO_ERROR
    print(*paths, sep="\n")
    return 0 if paths else USAGE_ERROR


if __name__ == "__main__":
    sys.exit(main())
