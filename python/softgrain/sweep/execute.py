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

STOPPED, COME_AGAIN = 130, 75  # exit codes after Ctrl-C and after SIGTERM, those of `softgrain run`
DOUBTFUL = 5  # done, but not to be trusted, or short of what the case asks: no failure of the sweep
STOP_SIGNALS = {signal.SIGINT: STOPPED, signal.SIGTERM: COME_AGAIN, signal.SIGUSR2: COME_AGAIN,
                signal.SIGHUP: COME_AGAIN}
POLL = 0.02  # [s]


class RefusedCase(ValueError):
    """A case of the sweep is invalid, or its directory holds another one; `code` is the exit code."""

    def __init__(self, message, code=2):
        super().__init__(message)
        self.code = code


def state(directory):
    """"done", "stopped", "failed", "running" (or killed), "" before it begins."""
    try:
        return json.loads((directory / "run.json").read_text())["state"]
    except (OSError, ValueError, KeyError):
        return ""


def select_undone(plan, runs, jobs):
    """The runs that are still to do. Every case is checked before the first run starts: raises RefusedCase."""
    with ThreadPoolExecutor(jobs) as pool:
        done = list(pool.map(lambda run: _is_done(plan, run), runs))
    return [run for run, over in zip(runs, done) if not over]


def _is_done(plan, run):
    checked = subprocess.run(plan.command("check", run, "--json"), capture_output=True, text=True)
    if checked.returncode != 0:
        raise RefusedCase(f"{run.name}: {checked.stderr.strip()}", checked.returncode)
    directory = plan.directory(run)
    if state(directory) != "done":
        return False
    if tomllib.loads((directory / "case.toml").read_text()) != json.loads(checked.stdout)["case"]:
        raise RefusedCase(f"{directory} holds a run of another case; choose another directory with -o")
    return True


def doubts(directory):
    """Why the run is not to be trusted, or what it did not reach; [] for a good run, and before it is done."""
    try:
        return json.loads((directory / "run.json").read_text()).get("doubts", []) if state(directory) == "done" else []
    except (OSError, ValueError):
        return []


class Pool:
    """Up to `jobs` runs at a time, by `plan.run_command(run, *options)`. A signal goes to each of them; after one that stops, no other begins."""

    def __init__(self, plan, jobs):
        self.plan, self.jobs = plan, jobs
        self.threads = max(1, len(os.sched_getaffinity(0)) // jobs)
        self.running = {}  # name of a run -> (process, file with its stderr, when it began)
        self.stop_code = 0

    def carry_out(self, runs):
        """Returns {name of a failed run: (exit code, what it said)}. `stop_code` is set if a signal came."""
        waiting, failed = list(runs), {}
        # What is ignored stays so: SIGHUP under nohup.
        heeded = [number for number in (*STOP_SIGNALS, signal.SIGUSR1) if signal.getsignal(number) != signal.SIG_IGN]
        before = {number: signal.signal(number, self._pass_on) for number in heeded}
        try:
            while self.running or (waiting and not self.stop_code):
                while waiting and len(self.running) < self.jobs and not self.stop_code:
                    self._start(waiting.pop(0))
                time.sleep(POLL)
                failed.update(self._collect())
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        return failed

    def _start(self, run):
        said = tempfile.TemporaryFile("w+")
        words = self.plan.run_command(run, "--quiet", f"--threads={self.threads}")
        # In its own session, so that Ctrl-C reaches it through us alone: once.
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said,
                                   start_new_session=True)
        self.running[run.name] = process, said, time.monotonic()

    def _collect(self):
        """Takes leave of the runs that have ended; returns those that failed."""
        failed = {}
        for name, (process, said, began) in list(self.running.items()):
            code = process.poll()
            if code is None:
                continue
            del self.running[name]
            with said:
                said.seek(0)
                words = said.read().strip()
            done = f"done in {time.monotonic() - began:.0f} s"
            ended = {0: done, DOUBTFUL: f"{done}, doubtful: {words}", STOPPED: "stopped",
                     COME_AGAIN: "stopped"}.get(code, f"failed ({code}): {words}")
            print(f"{name}: {ended}", file=sys.stderr, flush=True)
            if ended.startswith("failed"):
                failed[name] = code, words
            elif code not in (0, DOUBTFUL) and not self.stop_code:
                self.stop_code = code  # someone else sent it the signal
        return failed

    def _pass_on(self, number, _):
        self.stop_code = self.stop_code or STOP_SIGNALS.get(number, 0)
        for process, *_ in self.running.values():
            if process.poll() is None:
                process.send_signal(number)
