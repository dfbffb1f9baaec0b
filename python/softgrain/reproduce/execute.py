"""Runs the plan: several programs at a time; what is done already is not done again."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from ..sweep.execute import Pool
from ..sweep.state import state


class RunFailed(RuntimeError):
    """A run ended with an error, or a signal came; `code` is the exit code."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


@dataclass(frozen=True)
class Workplace:
    """Each run in FOLDER/NAME, its case and the values that it was begun with in FOLDER/cases/NAME."""

    program: str
    folder: Path

    def is_done(self, run):
        return self._was_begun(run) and state(self.folder / run.name) == "done"

    def prepare(self, run):
        """Writes the run's case, unless it is there."""
        if not self._case(run).exists():
            _call([self.program, "new", str(self._case(run).parent), "--template", run.template], run)

    def run_command(self, run, *options):
        """The words that begin the run, or go on with it if it was begun with the same values."""
        begin = "--resume" if self._was_begun(run) and state(self.folder / run.name) else "--force"
        if begin == "--force":
            (self.folder / run.name / "run.json").unlink(missing_ok=True)  # of other values
            self._note(run).write_text(json.dumps(run.values))
        return [self.program, "run", str(self._case(run)), "-o", str(self.folder / run.name), begin,
                *run.command_values, *options]

    def _was_begun(self, run):
        try:
            return json.loads(self._note(run).read_text()) == run.values
        except (OSError, ValueError):
            return False

    def _case(self, run):
        return self.folder / "cases" / run.name / "case.toml"

    def _note(self, run):
        return self._case(run).with_name("values.json")


def execute(runs, folder, program, jobs):
    """Makes each run in folder/NAME. Raises RunFailed after the others have ended, or when a signal stopped them."""
    place = Workplace(program, folder)
    waiting = [run for run in runs if not place.is_done(run)]
    if len(waiting) < len(runs):
        print(f"{len(runs) - len(waiting)} of {len(runs)} runs: done before", file=sys.stderr)
    for run in waiting:
        place.prepare(run)
    pool = Pool(place, jobs)
    failed = pool.carry_out(waiting)
    for name, (code, words) in failed.items():
        raise RunFailed(f"{name}: {words}", code)
    if pool.stop_code:
        raise RunFailed("stopped; the same command goes on", pool.stop_code)


def _call(command, run):
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RunFailed(f"{run.name}: {done.stderr.strip()}", done.returncode)
