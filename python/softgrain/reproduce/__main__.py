"""python3 -m softgrain.reproduce: the paper's figures, from the runs to the verdicts."""

import argparse
import os
import sys
from pathlib import Path

from .. import NotRecorded, open_run
from ..plot import save, style
from ..sweep.execute import DOUBTFUL, doubts
from . import figures, tables, verdicts
from .execute import RunFailed, execute
from .plan import FIGURES, FRICTIONS, MODELS, SCALES, packing_name, planned_runs


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="softgrain reproduce",
        description="Makes the runs of the paper's figures, draws the figures, and holds each of its statements against them.")
    parser.add_argument("figure", nargs="?", choices=(*FIGURES, "all"), default="all")
    parser.add_argument("--scale", choices=SCALES, default="quick",
                        help="quick: small, three seeds, a minute; paper: its full size, half an hour")
    parser.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="where all of it goes")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time")
    parser.add_argument("--program", default=os.environ.get("SOFTGRAIN_PROGRAM", "softgrain"), help=argparse.SUPPRESS)
    return parser.parse_args(arguments)


def reproduce(options):
    """Runs, figures, tables, verdicts. Returns the paths of the figures."""
    scale = SCALES[options.scale]
    wanted = FIGURES if options.figure == "all" else (options.figure,)
    runs = planned_runs(wanted, scale)
    folder = options.output / "runs"
    execute(runs, folder, options.program, max(1, options.jobs))
    results = verdicts.read_results(folder, wanted, scale)
    opened = [open_run(folder / run.name) for run in runs]
    paths = []

    def keep(figure, name):
        paths.append(options.output / f"{name}.png")
        save(figure, paths[-1], opened, dpi=200)

    with style():
        for name in wanted:
            keep(figures.DRAW[name](results), name)
        for model in MODELS if results.packings else ():
            for friction in FRICTIONS:
                name = packing_name(model, friction, scale.seeds[0])
                keep(figures.draw_packing(open_run(folder / name)), name)
    tables.write(results, options.output)
    program = opened[0].info.get("program", {})
    found = list(verdicts.verdicts(results, wanted))
    verdicts.write(found, results, options.output, options.scale,
                   f"softgrain {program.get('version', '?')} ({program.get('commit', '?')})")
    return paths, found, [run.name for run in runs if doubts(folder / run.name)]


def main(arguments=None):
    options = parse(arguments)
    try:
        paths, found, doubtful = reproduce(options)
    except RunFailed as error:
        print(f"error: {error}", file=sys.stderr)
        return error.code
    except NotRecorded as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    agree = sum(verdict.agrees for verdict in found)
    print(*paths, options.output / "verdicts.md", sep="\n")
    print(f"{agree} of {len(found)} statements agree", file=sys.stderr)
    if doubtful:
        print(f"warning: doubtful runs, `softgrain info` tells why: {', '.join(doubtful)}", file=sys.stderr)
    return DOUBTFUL if doubtful else 0


if __name__ == "__main__":
    sys.exit(main())
