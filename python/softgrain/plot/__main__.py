"""python3 -m softgrain.plot DIR...: the figures of a run; several runs share one stress-strain curve."""

import sys
from pathlib import Path

import softgrain
from softgrain import plot
from softgrain.options import parse

USAGE_ERROR, IO_ERROR = 2, 4  # exit codes, those of the program `softgrain`


def draw(options):
    """Draws and saves every figure asked for; returns the paths. Names those that the data do not allow."""
    runs = [softgrain.open(path) for path in options.dir]
    names = distinct_names(runs)
    figures = {"curve": (runs, lambda: plot.draw_curve(runs, names, options.normalise))}
    if any({"phi", "z"} <= run.series.keys() for run in runs) or options.kind == "packing":
        figures["packing"] = (runs, lambda: plot.draw_packing(runs, names))
    for run, name in zip(runs, names):
        suffix = "" if len(runs) == 1 else "-" + name.replace("/", "-")
        figures["grain" + suffix] = ([run], lambda run=run: plot.draw_grain(run))
        figures["diagnostics" + suffix] = ([run], lambda run=run: plot.draw_diagnostics(run))

    beside = runs[0].path if len(runs) == 1 else Path()
    folder = Path(options.output) if options.output else beside / "figures"
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
    options = parse("plot", arguments)
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
