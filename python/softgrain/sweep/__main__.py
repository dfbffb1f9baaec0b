"""python3 -m softgrain.sweep CASE: the runs of a sweep, its table and its figure."""

import os
import shlex
import sys

from .. import NotRecorded
from ..verb import carry_out
from . import execute, scripts, table
from .plan import PlanError, read_plan

RUNS_FAILED = 3  # exit code, that of the program `softgrain`


def list_runs(plan):
    for number, run in enumerate(plan.runs):
        state = execute.state(plan.directory(run)) or "to do"
        print(f"{number}\t{state}\t{shlex.join(plan.run_command(run))}")


def become_run(plan, index):
    """Becomes the run, so that its signals and its exit code are ours."""
    runs = plan.runs
    if not 0 <= index < len(runs):
        raise PlanError(f"--index {index}: the runs are numbered from 0 to {len(runs) - 1}")
    if not execute.select_undone(plan, [runs[index]], 1):
        print(f"{runs[index].name}: done before", file=sys.stderr)
        return execute.DOUBTFUL if execute.doubts(plan.directory(runs[index])) else 0
    plan.directory(runs[index]).parent.mkdir(parents=True, exist_ok=True)
    words = plan.run_command(runs[index], "--progress=plain")
    os.execvp(words[0], words)


def write_script(plan, name, text_of, columns):
    execute.select_undone(plan, plan.runs, len(os.sched_getaffinity(0)))  # refuses a wrong case here, not in the queue
    plan.folder.mkdir(parents=True, exist_ok=True)
    path = plan.folder / name
    path.write_text(text_of(plan, scripts.sweep_words(plan, columns), path))
    print(path)
    return 0


def sweep(plan, jobs, columns):
    """All runs, then the table and the figure."""
    waiting = execute.select_undone(plan, plan.runs, jobs)
    if len(waiting) < len(plan.runs):
        print(f"{len(plan.runs) - len(waiting)} of {len(plan.runs)} runs: done before", file=sys.stderr)
    (plan.folder / "runs").mkdir(parents=True, exist_ok=True)
    pool = execute.Pool(plan, jobs)
    failed = pool.carry_out(waiting)
    collect(plan, columns)
    if failed:
        print(f"error: {len(failed)} of {len(plan.runs)} runs failed: {', '.join(failed)}", file=sys.stderr)
    doubtful = [run.name for run in plan.runs if execute.doubts(plan.directory(run))]
    if doubtful:
        print(f"warning: {len(doubtful)} of {len(plan.runs)} runs are doubtful, `softgrain info` tells why: "
              f"{', '.join(doubtful)}", file=sys.stderr)
    return pool.stop_code or (RUNS_FAILED if failed else execute.DOUBTFUL if doubtful else 0)


def collect(plan, columns):
    opened = table.read_runs(plan)
    results = plan.folder / "results.csv"
    table.write_results(plan, opened, columns, results)
    print(results)
    try:
        from .. import plot
        from .figure import draw_sweep

        with plot.style():
            path = plan.folder / "sweep.png"
            plot.save(draw_sweep(plan, opened, columns), path, list(opened.values()))
        print(path)
    except (NotRecorded, ImportError) as missing:
        print(f"softgrain sweep: no figure: {missing}", file=sys.stderr)


def plan_or_carry_out(options):
    """What the options ask for: the list, one run, a script, or all runs."""
    program = os.environ.get("SOFTGRAIN_PROGRAM", "softgrain")
    try:
        plan = read_plan(program, options.case, options.set, options.vary, options.output)
        if options.list:
            return list_runs(plan)
        if options.index is not None:
            return become_run(plan, options.index)
        if options.slurm:
            return write_script(plan, "array.sh", scripts.slurm_script, options.column)
        if options.snakemake:
            return write_script(plan, "Snakefile", scripts.snakefile, options.column)
        return sweep(plan, options.jobs or len(os.sched_getaffinity(0)), options.column)
    except execute.RefusedCase as error:
        print(f"error: {error}", file=sys.stderr)
        return error.code


def main(arguments=None):
    return carry_out("sweep", arguments, plan_or_carry_out)


if __name__ == "__main__":
    sys.exit(main())
