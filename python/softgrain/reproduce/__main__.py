"""python3 -m softgrain.reproduce: the paper's figures, from the runs to the verdicts."""

import os
import sys
from pathlib import Path

from .. import NotRecorded, open_run
from ..options import parse
from ..plot import save, style
from ..sweep.execute import NOT_TRUSTED
from ..sweep.state import doubts
from . import figures, tables, verdicts
from .execute import RunFailed, execute
from .plan import FIGURES, FRICTIONS, MODELS, SCALES, packing_name, planned_runs


def reproduce(options):
    """Runs, figures, tables, verdicts. Returns the paths of the figures."""
    scale = SCALES[options.scale]
    wanted = FIGURES if options.figure == "all" else (options.figure,)
    runs = planned_runs(wanted, scale)
    output = Path(options.output)
    folder = output / "runs"
    program = os.environ.get("SOFTGRAIN_PROGRAM", "softgrain")
    execute(runs, folder, program, options.jobs or os.cpu_count() or 1)
    results = verdicts.read_results(folder, wanted, scale)
    opened = [open_run(folder / run.name) for run in runs]
    paths = []

    def keep(figure, name):
        paths.append(output / f"{name}.png")
        save(figure, paths[-1], opened, dpi=200)

    with style():
        for name in wanted:
            keep(figures.DRAW[name](results), name)
        for model in MODELS if results.packings else ():
            for friction in FRICTIONS:
                name = packing_name(model, friction, scale.seeds[0])
                keep(figures.draw_packing(open_run(folder / name)), name)
    tables.write(results, output)
    built = opened[0].info.get("program", {})
    found = list(verdicts.verdicts(results, wanted))
    verdicts.write(found, results, output, options.scale,
                   f"softgrain {built.get('version', '?')} ({built.get('commit', '?')})")
    return paths, found, [run.name for run in runs if doubts(folder / run.name)]


def main(arguments=None):
    options = parse("reproduce", arguments)
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
    print(*paths, Path(options.output) / "verdicts.md", sep="\n")
    print(f"{agree} of {len(found)} statements agree", file=sys.stderr)
    if doubtful:
        print(f"warning: doubtful runs, `softgrain info` tells why: {', '.join(doubtful)}", file=sys.stderr)
    return NOT_TRUSTED if doubtful else 0


if __name__ == "__main__":
    sys.exit(main())
