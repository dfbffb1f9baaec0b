"""Runs the plan: several programs at a time; what is done already is not done again."""

import json
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor


class RunFailed(RuntimeError):
    """A run ended with an error; `code` is its exit code."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


def execute(runs, folder, program, jobs):
    """Makes each run in folder/NAME. Raises RunFailed after the others have ended."""
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(jobs) as pool:
        results = [pool.submit(_execute_one, run, folder, program) for run in runs]
    for result in results:
        result.result()


def _execute_one(run, folder, program):
    directory = folder / run.name
    if _is_done(directory, run):
        print(f"{run.name}: done before", file=sys.stderr, flush=True)
        return
    case = folder / "cases" / run.name
    if not (case / "case.toml").exists():
        _call([program, "new", str(case), "--template", run.template], run)
    start = time.monotonic()
    _call([program, "run", str(case / "case.toml"), "-o", str(directory), "--force", "--quiet", *run.command_values],
          run)
    (directory / "plan.json").write_text(json.dumps(run.values))
    print(f"{run.name}: {time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)


def _is_done(directory, run):
    """Whether the directory holds this very run, ended: not one with other values."""
    try:
        state = json.loads((directory / "run.json").read_text())["state"]
        return state == "done" and json.loads((directory / "plan.json").read_text()) == run.values
    except (OSError, ValueError, KeyError):
        return False


def _call(command, run):
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RunFailed(f"{run.name}: {done.stderr.strip()}", done.returncode)
