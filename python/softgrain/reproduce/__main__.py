"""python3 -m softgrain.reproduce: the paper's figures, from the runs to the verdicts and one page of it all."""

import os
import shlex
import sys
from pathlib import Path

from .. import NotRecorded
from ..options import parse
from ..plot import save, style
from ..sweep.execute import NOT_TRUSTED
from ..sweep.state import doubts
from . import causes, figures, page, tables, verdict, verdicts
from .execute import RunFailed, Workplace, execute
from .plan import FAST, FIGURES, FRICTIONS, MODELS, SCALES, planned_runs
from .results import read_results

USAGE = 2


def reproduce(options):
    """Runs, figures, tables, verdicts, page. Returns the paths that were written, the verdicts and the doubtful runs."""
    scale = SCALES[options.scale]
    if options.seeds:
        scale = scale.with_seeds(options.seeds)
    wanted = FIGURES if options.figure == "all" else (options.figure,)
    runs = planned_runs(wanted, scale, options.speed, values_of(options.set))
    output = Path(options.output)
    folder = output / "runs"
    program = os.environ.get("SOFTGRAIN_PROGRAM", "softgrain")
    if options.no_runs:
        runs = [run for run in runs if Workplace(program, folder).is_done(run)]
    else:
        execute(runs, folder, program, options.jobs or os.cpu_count() or 1)
    results = read_results(folder, runs)
    paths = draw(results, wanted, output)
    tables.write(results, output)
    found = list(verdicts.verdicts(results, wanted))
    facts = {"scale": options.scale, "samples": verdict.seeds_of(results) or "none", **provenance(results)}
    verdict.write(found, results, output, options.scale, facts["program"])
    paths += [output / "verdicts.md", page.write(found, paths, output, facts)]
    return paths, found, [run.name for run in runs if doubts(folder / run.name)]


def draw(results, wanted, output):
    """Paths of the figures, and of pictures of the first sample of each kind of packing."""
    paths = []
    opened = [run for runs in (*results.grains.values(), *results.runs.values()) for run in runs]

    def keep(figure, name):
        paths.append(output / f"{name}.png")
        save(figure, paths[-1], opened, dpi=200)

    with style():
        for name in wanted:
            keep(figures.DRAW[name](results), name)
        for model in MODELS:
            for friction in FRICTIONS:
                for run in results.runs.get((FAST, model, friction), [])[:1]:
                    keep(figures.draw_packing(run), run.name)
    return paths


def values_of(words):
    """{key: value} of `--set KEY=VALUE`. Raises ValueError for a word without an equals sign."""
    values = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not (key and equals):
            raise ValueError(f"--set takes KEY=VALUE, as in contact.wall_friction=0.1; got '{word}'")
        values[key] = value
    return values


def provenance(results):
    """What the page says of where its numbers come from."""
    opened = [run for runs in (*results.grains.values(), *results.runs.values()) for run in runs]
    programs = sorted({"softgrain {version} ({commit})".format(**{"version": "?", "commit": "?", **run.info.get("program", {})})
                       for run in opened})
    return {"program": ", ".join(programs), "runs": len(opened),
            "CPU time of all runs": f"{sum(run.info.get('cpu_seconds', 0) for run in opened):.0f} s",
            "the command": "softgrain reproduce " + " ".join(shlex.quote(word) for word in sys.argv[1:])}


def main(arguments=None):
    options = parse("reproduce", arguments)
    try:
        paths, found, doubtful = reproduce(options)
    except RunFailed as error:
        print(f"error: {error}", file=sys.stderr)
        return error.code
    except (NotRecorded, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return USAGE
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    print(*paths, sep="\n")
    print(causes.headline(found), file=sys.stderr)
    if doubtful:
        print(f"warning: doubtful runs, `softgrain info` tells why: {', '.join(doubtful)}", file=sys.stderr)
    return NOT_TRUSTED if doubtful else 0


if __name__ == "__main__":
    sys.exit(main())
