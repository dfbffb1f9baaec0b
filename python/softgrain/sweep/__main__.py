"""python3 -m softgrain.sweep CASE or PLAN: the runs of a sweep, its tables and its figure; how far they are."""

import os
import shlex
import sys
from pathlib import Path

from .. import NotRecorded
from ..verb import carry_out
from . import execute, plan_file, scripts, table
from .curves import write_curves
from .plan import PlanError, read_plan
from .state import DONE, DOUBTFUL, FAILED, RUNNING, WAITING, condition, doubts, record
from .status import status_text

RUNS_FAILED = 3  # exit code, that of the program `softgrain`


def plan_of(options, program):
    """The plan that the words describe, or the one in the file or folder that they name. Raises PlanError."""
    path = Path(options.case)
    if path.is_dir():
        if not (path / plan_file.NAME).exists():
            raise PlanError(f"{path} is no sweep's folder: it has no {plan_file.NAME}")
        path = path / plan_file.NAME
    described = [name for name in ("set", "vary", "range", "design") if getattr(options, name)]
    if not (options.vary or options.design or options.range) or plan_file.is_plan(path):
        if described:
            raise PlanError(f"--{described[0]}: {path} is no case to be varied, but a plan, or should be one; "
                            "write it there")
        return plan_file.read_plan_file(program, path, options.output)
    if not options.output:
        raise PlanError(f"where are the runs of {path} to go? -o DIR")
    return read_plan(program, path, options.set, options.vary, options.output, options.design, options.range)


def keep_plan(plan, options):
    """The plan in the sweep's own folder, for `status` and for other machines; one that was read there stays."""
    own, given = plan.folder / plan_file.NAME, Path(options.case)
    given = given / plan_file.NAME if given.is_dir() else given
    if not (own.exists() and given.exists() and own.samefile(given)):
        plan_file.write_plan_file(plan)


def list_runs(plan):
    for run in plan.runs:
        found = condition(plan.directory(run))
        print(f"{run.number}\t{'to do' if found == WAITING else found}\t{shlex.join(plan.run_command(run))}")


def task_of(plan, index, pack):
    """The runs of one task. Raises PlanError."""
    runs = plan.runs[index * pack:(index + 1) * pack]
    if index < 0 or not runs:
        raise PlanError(f"--index {index}: the tasks are numbered from 0 to {-(-len(plan.runs) // pack) - 1}")
    return runs


def become_run(plan, run, options):
    """Becomes the run, so that its signals and its exit code are ours."""
    parts = execute.sort_runs(plan, [run], 1, options.retry_failed)
    directory = plan.directory(run)
    if parts.done:
        print(f"{run.name}: done before", file=sys.stderr)
        return execute.NOT_TRUSTED if doubts(directory) else 0
    if parts.failed:
        print(f"error: {run.name} failed before: {record(directory).get('message', '')}\n--retry-failed tries it again",
              file=sys.stderr)
        return RUNS_FAILED
    if options.max_fails is not None and (failed := failures(plan)) > options.max_fails:
        print(f"error: gave up, {failed} runs have failed", file=sys.stderr)
        return RUNS_FAILED
    directory.parent.mkdir(parents=True, exist_ok=True)
    words = plan.run_command(run, "--progress=plain")
    os.execvp(words[0], words)


def failures(plan):
    return sum(condition(plan.directory(run)) == FAILED for run in plan.runs)


def carry_out_runs(plan, runs, options, jobs):
    """The exit code for these runs together."""
    parts = execute.sort_runs(plan, runs, jobs, options.retry_failed)
    keep_plan(plan, options)
    if parts.done:
        print(f"{len(parts.done)} of {len(runs)} runs: done before", file=sys.stderr)
    if parts.failed:
        print(f"{len(parts.failed)} of {len(runs)} runs: failed before; --retry-failed tries them again",
              file=sys.stderr)
    (plan.folder / "runs").mkdir(parents=True, exist_ok=True)
    before = len(parts.failed) if len(runs) == len(plan.runs) else failures(plan)
    most_failed = None if options.max_fails is None else options.max_fails - before
    taken = (DONE, DOUBTFUL, RUNNING)
    pool = execute.Pool(plan, jobs, most_failed, lambda run: condition(plan.directory(run)) in taken)
    failed = {run.name for run in parts.failed} | pool.carry_out(parts.to_do).keys()
    return told(plan, runs, failed, pool)


def told(plan, runs, failed, pool):
    """Says what is amiss, the worst last, and returns the exit code."""
    found = {run.name: condition(plan.directory(run)) for run in runs}
    doubtful = [name for name, how in found.items() if how == DOUBTFUL]
    elsewhere = [name for name, how in found.items() if how == RUNNING]
    if doubtful:
        print(f"warning: {len(doubtful)} of {len(runs)} runs are doubtful, `softgrain info` tells why: "
              f"{', '.join(doubtful)}", file=sys.stderr)
    if elsewhere:
        print(f"{len(elsewhere)} of {len(runs)} runs go on elsewhere; call again when they are done", file=sys.stderr)
    if failed:
        names = [run.name for run in runs if run.name in failed]
        print(f"error: {len(failed)} of {len(runs)} runs failed: {', '.join(names)}", file=sys.stderr)
    if pool.gave_up and any(how == WAITING for how in found.values()):
        print("error: gave up, as --max-fails says; other runs were not begun", file=sys.stderr)
    if pool.stop_code:
        return pool.stop_code
    return RUNS_FAILED if failed else execute.COME_AGAIN if elsewhere else execute.NOT_TRUSTED if doubtful else 0


def collect(plan, options):
    """Tables and figure of what there is."""
    opened = table.read_runs(plan)
    results, curves = plan.folder / "results.csv", plan.folder / "curves.csv"
    table.write_results(plan, opened, options.column, results)
    print(results)
    if write_curves(plan, opened, options.column, options.over, curves):
        print(curves)
    try:
        from .. import plot
        from .figure import draw_sweep

        with plot.style():
            path = plan.folder / "sweep.png"
            plot.save(draw_sweep(plan, opened, options.column, options.over), path, list(opened.values()))
        print(path)
    except (NotRecorded, ImportError) as missing:
        print(f"softgrain sweep: no figure: {missing}", file=sys.stderr)


def write_scripts(plan, options):
    """The files for Slurm or Snakemake; prints the one to carry out."""
    execute.sort_runs(plan, plan.runs, execute.cores())  # refuses a wrong case here, not in the queue
    keep_plan(plan, options)
    here = [plan.program, "sweep", str(plan.folder.resolve() / plan_file.NAME)]
    retry = ["--retry-failed"] if options.retry_failed else []
    task = here + retry + ([] if options.max_fails is None else ["--max-fails", str(options.max_fails)])
    if options.slurm:
        pack = options.pack or 1
        task += ["--pack", str(pack)] if pack > 1 else []
        files = scripts.slurm_scripts(plan, task, pack, options.throttle, scripts.max_array_size())
    else:
        collecting = [*here, *(f"--column={name}" for name in options.column), f"--over={options.over}"]
        files = {"Snakefile": scripts.snakefile(plan, task, collecting)}
    for name, text in files.items():
        plan_file.write_whole(plan.folder / name, text)
    print(plan.folder / name)
    return 0


def sweep(options):
    """What the options ask for: how far it is, the list, one task, a script, or all runs."""
    program = os.environ.get("SOFTGRAIN_PROGRAM", "softgrain")
    try:
        if options.case == "status":
            if not options.dir:
                raise PlanError("of which sweep? softgrain sweep status DIR")
            options.case = options.dir
            print(status_text(plan_of(options, program)))
            return 0
        if options.dir:
            raise PlanError(f"'{options.dir}' is a word too many: softgrain sweep CASE, softgrain sweep PLAN or "
                            "softgrain sweep status DIR")
        plan = plan_of(options, program)
        if options.list:
            return list_runs(plan)
        if options.index is not None:
            runs = task_of(plan, options.index, options.pack or 1)
            if not options.pack:
                return become_run(plan, *runs, options)
            return carry_out_runs(plan, runs, options, options.jobs or 1)
        if options.slurm or options.snakemake:
            return write_scripts(plan, options)
        code = carry_out_runs(plan, plan.runs, options, options.jobs or execute.cores())
        collect(plan, options)
        return code
    except execute.RefusedCase as error:
        print(f"error: {error}", file=sys.stderr)
        return error.code


def main(arguments=None):
    return carry_out("sweep", arguments, sweep)


if __name__ == "__main__":
    sys.exit(main())
