"""Runs programs for a case and measures what they cost."""

import csv
import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]


@dataclass(frozen=True)
class Place:
    """Where runs of one code for one case go, and the programs."""

    folder: Path
    softgrain: str
    decks: Path  # the folder of the case
    samples: int  # how many, where the samples are random
    new: bool = True  # make runs again that are there


class CodeFailed(RuntimeError):
    """A program ended with an error."""


def cpu_seconds_of(command, folder, log="log.txt", environment=None, allowed=(0,)):
    """Runs the command in the folder, on one thread, its words into `log`; returns its CPU time [s], all its children's too."""
    folder.mkdir(parents=True, exist_ok=True)
    quiet = {**os.environ, "OMP_NUM_THREADS": "1", **(environment or {})}
    with (folder / log).open("w") as words:
        child = subprocess.Popen([str(word) for word in command], cwd=folder, stdout=words, stderr=subprocess.STDOUT, env=quiet,
                                 stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode not in allowed:
        tail = (folder / log).read_text(errors="replace").splitlines()[-8:]
        raise CodeFailed(f"{command[0]} ended with code {child.returncode} in {folder}:\n" + "\n".join(tail))
    return usage.ru_utime + usage.ru_stime


def first_line_of(command, word=""):
    """The first line that a program says, with `word` in it; "" if there is no such program."""
    if not shutil.which(command[0]):
        return ""
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd=tempfile.gettempdir())  # LIGGGHTS leaves a log
    lines = [line.strip() for line in (done.stdout + done.stderr).splitlines() if word in line and line.strip()]
    return lines[0] if lines else "?"


def read_columns(path):
    """{name without its unit: values} of a CSV file of numbers."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name.partition("[")[0]: np.array([float(row[name]) for row in rows]) for name in (rows[0] if rows else ())}


def write_rows(path, header, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(header)
        table.writerows(rows)
