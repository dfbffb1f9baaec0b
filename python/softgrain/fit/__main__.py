"""python3 -m softgrain.fit CASE CURVE --free KEY -o DIR: parameters from a measured curve."""

import json
import os
import sys
from pathlib import Path

from .. import plot
from ..case import Case, RunFailed
from ..compare import Comparison, draw_comparison, read_measured
from ..verb import carry_out
from . import Problem, estimate, report

INCOMPLETE, STOPPED = 5, 130  # exit codes, those of the program `softgrain`


def case_of(options) -> Case:
    case = Case(options.case)
    for word in options.set:
        key, equals, value = word.partition("=")
        if not equals:
            raise ValueError(f"--set {word}: want KEY=VALUE")
        case = case.set(key.strip(), value.strip())
    return case


def fit(options, command):
    free = list(dict.fromkeys(options.free))
    case = case_of(options)
    if fixed := {key for key, _ in case.values} & set(free):
        print(f"softgrain fit: the search for {', '.join(sorted(fixed))} begins at its --set", file=sys.stderr)
    folder = Path(options.output)
    curve = read_measured(options.curve)
    problem = Problem(case, curve, free, folder, options.jobs or len(os.sched_getaffinity(0)), options.most_runs, options.seeds)
    found = estimate(problem.residuals, problem.jacobian, problem.bounds)
    told = report.findings(problem, found)
    best = problem.run(found.x)
    comparison = Comparison(problem.within, problem.measured, problem.model(found.x))
    with plot.style():
        plot.save(draw_comparison(comparison, curve.name, "fit"), folder / "fit.png", [best])
    (folder / "fit.json").write_text(json.dumps(told, indent=2) + "\n")
    (folder / "fit.md").write_text(report.page(told, command, best.path))
    print(report.summary(told), folder / "fit.md", sep="\n")
    return 0 if report.is_complete(told) else INCOMPLETE


def main(arguments=None):
    words = ["softgrain", "fit", *(sys.argv[2:] if arguments is None else map(str, arguments))]

    def fit_until_stopped(options):
        try:
            return fit(options, words)
        except KeyboardInterrupt:
            print("stopped; called again, the fit goes on", file=sys.stderr)
            return STOPPED
        except RunFailed as failed:
            print(f"error: {failed}", file=sys.stderr)
            return failed.code

    return carry_out("fit", arguments, fit_until_stopped)


if __name__ == "__main__":
    sys.exit(main())
