"""softgrain's runs."""

import json
import shutil
import subprocess

import numpy as np
import softgrain

from .case import Curve
from .work import cpu_seconds_of, read_columns

COME_TO_ITS_END = (0, 5)  # 5: with a warning, which the page of results repeats


def version(program):
    if not shutil.which(program):
        return ""
    done = subprocess.run([program, "--version"], capture_output=True, text=True)
    return done.stdout.strip().splitlines()[0] if done.returncode == 0 and done.stdout else ""


def run(place, name, values, deck="case.toml"):
    """(series, case, CPU time [s]) of a run of the case's deck with some values changed."""
    folder = place.folder / name
    record = folder / "run.json"
    if place.new or not record.exists() or json.loads(record.read_text())["state"] != "done":
        words = [f"--set={key}={value}" for key, value in values.items()]
        cpu = cpu_seconds_of([place.softgrain, "run", place.decks / deck, "-o", folder, "--force", "--quiet", "-j", "1",
                        "--set=output.report=false", "--set=output.vtk=false", *words], place.folder, f"{name}.log",
                             allowed=COME_TO_ITS_END)
        (folder / "cpu_seconds").write_text(f"{cpu:.3f}\n")
    return read_columns(folder / "series.csv"), softgrain.open_run(folder).case, float((folder / "cpu_seconds").read_text())


def rising(x):
    """Rows at which x is larger than ever before."""
    return np.unique(np.maximum.accumulate(x), return_index=True)[1]


def curve(variant, sample, columns, x, cpu):
    """A Curve of columns, along rows where column x rises."""
    rows = rising(columns[x])
    return Curve(variant, sample, {name: np.asarray(values)[rows] for name, values in columns.items()}, cpu)
