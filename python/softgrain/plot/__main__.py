"""python3 -m softgrain.plot DIR...: the figures of a run; several runs share one stress-strain curve."""

import sys
from pathlib import Path

import softgrain
from softgrain import plot
from softgrain.verb import USAGE_ERROR, carry_out

KINDS_OF_DIE = ("die", "heckel", "kawakita", "profile")


def draw(options):
    """Draws and saves every figure asked for; returns the paths. Names those that the data do not allow."""
    runs = [softgrain.open(path) for path in options.dir]
    window = window_of(options.window)
    names = distinct_names(runs)
    figures = {"curve": (runs, lambda: plot.draw_curve(runs, names, options.normalise))}
    if any({"phi", "z"} <= run.series.keys() for run in runs) or options.kind == "packing":
        figures["packing"] = (runs, lambda: plot.draw_packing(runs, names))
    if any("shear_strain" in run.series for run in runs) or options.kind == "shear":
        figures["shear"] = (runs, lambda: plot.draw_shear(runs, names))
    for run, name in zip(runs, names):
        suffix = "" if len(runs) == 1 else "-" + name.replace("/", "-")
        draw_grain = plot.draw_space if run.in_space else plot.draw_grain
        figures["grain" + suffix] = ([run], lambda run=run, draw_grain=draw_grain: draw_grain(run))
        figures["diagnostics" + suffix] = ([run], lambda run=run: plot.draw_diagnostics(run))
        if options.kind in KINDS_OF_DIE or run.case.get("experiment", {}).get("loading") == "die":
            figures["die" + suffix] = ([run], lambda run=run: plot.draw_die(run))
            figures["heckel" + suffix] = ([run], lambda run=run: plot.draw_heckel(run, window))
            figures["kawakita" + suffix] = ([run], lambda run=run: plot.draw_kawakita(run, window))
            figures["profile" + suffix] = ([run], lambda run=run: plot.draw_profile(run))

        if options.kind == "voronoi":
            figures["voronoi" + suffix] = ([run], lambda run=run: plot.draw_voronoi(run))

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


def window_of(word):
    """"0.05:0.2" in MPa as two pressures [Pa]; None for none. Raises ValueError."""
    if word is None:
        return None
    try:
        low, high = (1e6 * float(bound) for bound in word.split(":"))
    except ValueError:
        low = high = 0.0
    if not 0 <= low < high:
        raise ValueError(f"--window takes two pressures in MPa, the lower first, as in 0.05:0.2; got {word}")
    return low, high


def distinct_names(runs):
    """The name of each run's directory, or the whole path where two runs have the same name."""
    names = [run.name for run in runs]
    return [name if names.count(name) == 1 else str(run.path) for run, name in zip(runs, names)]


def main(arguments=None):
    def draw_and_tell(options):
        paths = draw(options)
        print(*paths, sep="\n")
        return 0 if paths else USAGE_ERROR

    return carry_out("plot", arguments, draw_and_tell)


if __name__ == "__main__":
    sys.exit(main())
