"""Carries out the runs of a plan: several programs at a time; what is done already is not done again."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

from .state import DONE, DOUBTFUL, FAILED, RUNNING, condition

STOPPED, COME_AGAIN = 130, 75  # exit codes after Ctrl-C and after SIGTERM, those of `softgrain run`
NOT_TRUSTED = 5  # done, but not to be trusted, or short of what the case asks: no failure of the sweep
STOP_SIGNALS = {signal.SIGINT: STOPPED, signal.SIGTERM: COME_AGAIN, signal.SIGUSR2: COME_AGAIN,
                signal.SIGHUP: COME_AGAIN}
POLL = 0.02  # [s]


class RefusedCase(ValueError):
    """A case of the sweep is invalid, or its directory holds another one; `code` is the exit code."""

    def __init__(self, message, code=2):
        super().__init__(message)
        self.code = code


class Sorted(NamedTuple):
    """The runs of a sweep by what there is to do."""

    done: list
    failed: list  # and not to be tried again
    running: list  # somewhere else
    to_do: list


def sort_runs(plan, runs, jobs, retry_failed=False):
    """Every case is checked before the first run starts: raises RefusedCase."""
    with ThreadPoolExecutor(jobs) as pool:
        found = list(pool.map(lambda run: _checked(plan, run), runs))
    parts = Sorted([], [], [], [])
    for run, how in zip(runs, found):
        part = {DONE: parts.done, DOUBTFUL: parts.done, RUNNING: parts.running,
                FAILED: parts.to_do if retry_failed else parts.failed}.get(how, parts.to_do)
        part.append(run)
    return parts


def _checked(plan, run):
    """The run's condition. One that came to an end did so with this case, but for what it wrote."""
    checked = subprocess.run(plan.command("check", run, "--json"), capture_output=True, text=True)
    if checked.returncode != 0:
        raise RefusedCase(f"{run.name}: {checked.stderr.strip()}", checked.returncode)
    directory = plan.directory(run)
    how = condition(directory)
    if how not in (DONE, DOUBTFUL, FAILED):
        return how
    try:
        stored = tomllib.loads((directory / "case.toml").read_text())
    except ValueError as error:
        raise RefusedCase(f"{directory}/case.toml is damaged: {error}; remove it: it is written again", 4) from error
    if _physics(stored) != _physics(json.loads(checked.stdout)["case"]):
        raise RefusedCase(f"{directory} holds a run of another case; choose another directory with -o")
    return how


def _physics(case):
    return {name: table for name, table in case.items() if name != "output"}


def cores():
    return len(os.sched_getaffinity(0))


class Pool:
    """Up to `jobs` runs at a time, by `plan.run_command(run, *options)`. A signal goes to each of them; after one that
    stops, and after more than `most_failed` failures, no other begins. `is_taken(run)` is asked before each."""

    def __init__(self, plan, jobs, most_failed=None, is_taken=lambda run: False):
        self.plan, self.jobs, self.most_failed, self.is_taken = plan, jobs, most_failed, is_taken
        given = os.environ.get("OMP_NUM_THREADS", "")
        self.threads = int(given) if given.isdecimal() and int(given) > 0 else max(1, cores() // jobs)
        self.running = {}  # name of a run -> (process, file with its stderr, when it began)
        self.failed = {}  # name of a run -> (exit code, what it said)
        self.stop_code = 0

    @property
    def gave_up(self):
        return self.most_failed is not None and len(self.failed) > self.most_failed

    def carry_out(self, runs):
        """Returns {name of a failed run: (exit code, what it said)}. `stop_code` is set if a signal came."""
        waiting = list(reversed(runs))
        # What is ignored stays so: SIGHUP under nohup.
        heeded = [number for number in (*STOP_SIGNALS, signal.SIGUSR1) if signal.getsignal(number) != signal.SIG_IGN]
        before = {number: signal.signal(number, self._pass_on) for number in heeded}
        try:
            while self.running or (waiting and not self.stop_code and not self.gave_up):
                while waiting and len(self.running) < self.jobs and not self.stop_code and not self.gave_up:
                    self._start(waiting.pop())
                time.sleep(POLL)
                self._collect()
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        return self.failed

    def _start(self, run):
        if self.is_taken(run):
            return
        said = tempfile.TemporaryFile("w+")
        words = self.plan.run_command(run, "--quiet", f"--threads={self.threads}")
        # In its own session, so that Ctrl-C reaches it through us alone: once.
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said,
                                   start_new_session=True)
        self.running[run.name] = process, said, time.monotonic()

    def _collect(self):
        """Takes leave of the runs that have ended."""
        for name, (process, said, began) in list(self.running.items()):
            code = process.poll()
            if code is None:
                continue
            del self.running[name]
            with said:
                said.seek(0)
                words = said.read().strip()
            done = f"done in {time.monotonic() - began:.0f} s"
            ended = {0: done, NOT_TRUSTED: f"{done}, doubtful: {words}", STOPPED: "stopped",
                     COME_AGAIN: "stopped"}.get(code, f"failed ({code}): {words}")
            print(f"{name}: {ended}", file=sys.stderr, flush=True)
            if ended.startswith("failed"):
                self.failed[name] = code, words
            elif code not in (0, NOT_TRUSTED) and not self.stop_code:
                self.stop_code = code  # someone else sent it the signal

    def _pass_on(self, number, _):
        self.stop_code = self.stop_code or STOP_SIGNALS.get(number, 0)
        for process, *_ in self.running.values():
            if process.poll() is None:
                process.send_signal(number)
