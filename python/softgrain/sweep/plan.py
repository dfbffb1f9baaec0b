"""Which runs a sweep consists of: every point with every combination of the varied values, by name."""

import hashlib
import itertools
import re
from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from .design import design_points
from .values import PlanError, read_range, read_values, told_at

LONGEST_NAME = 200  # of a run's directory [bytes]
SEED = "sample.seed"
# Many runs fill quotas of files: one can go on from each quarter, and from each turn of the load.
FEW_FILES = {"output.vtk": "false", "output.report": "false", "output.snapshots": "4"}


@dataclass(frozen=True)
class PlannedRun:
    """One run: its number and name, unique in the sweep, and its values as they were written, by key."""

    number: int
    name: str
    values: dict


@dataclass(frozen=True)
class Plan:
    """`softgrain run CASE --set ...` for each of `runs`, into FOLDER/runs/NAME."""

    program: str
    case: Path
    fixed: tuple  # key=value of --set, the same in all runs
    varied: dict  # key -> values as they were written, each with each
    folder: Path
    points: dict = field(default_factory=dict)  # key -> values: the first of all keys are a point, the second, ...

    @property
    def keys(self):
        """All that differ between runs, in the order of the table."""
        return [*self.points, *self.varied]

    @cached_property
    def runs(self):
        """The last key varies fastest, points slowest."""
        points = [dict(zip(self.points, values)) for values in zip(*self.points.values())] or [{}]
        grid = [dict(zip(self.varied, values)) for values in itertools.product(*self.varied.values())]
        return [PlannedRun(number, self._name(place, values), {**points[place], **values})
                for number, (place, values) in enumerate(itertools.product(range(len(points)), grid))]

    def directory(self, run):
        return self.folder / "runs" / run.name

    def command(self, verb, run, *options):
        """The words that call `verb` for the run's case."""
        given = {word.partition("=")[0] for word in self.fixed} | run.values.keys()
        few = [f"{key}={value}" for key, value in FEW_FILES.items() if key not in given]
        sets = [*few, *self.fixed, *(f"{key}={value}" for key, value in run.values.items())]
        return [self.program, verb, str(self.case), *(f"--set={word}" for word in sets), *options]

    def run_command(self, run, *options):
        """The words that begin the run, or go on with it."""
        return self.command("run", run, "-o", str(self.directory(run)), "--resume", *options)

    def _name(self, place, values):
        """"point_7-friction_0.5": a point has more digits than anybody reads; results.csv has them."""
        parts = [f"point_{place}"] if self.points else []
        return _short("-".join([*parts, *(f"{self._label(key)}_{_plain(value)}" for key, value in values.items())]))

    def _label(self, key):
        """"friction" of "contact.friction", unless another varied key ends so."""
        short = key.rpartition(".")[2]
        alone = sum(other.rpartition(".")[2] == short for other in self.varied) == 1
        return short if alone else key


def read_plan(program, case, fixed, varied, folder, design="", ranges=()):
    """The plan of the words behind --vary, --design and --range. Raises PlanError."""
    if ranges and not design:
        raise PlanError("--range says where a design has its points, and there is none: --design sobol:64")
    with told_at("--range "):
        spans = {key: read_range(key, text) for key, text in _by_key(ranges, "LOW..HIGH").items()}
    with told_at("--vary "):
        values = {key: read_values(key, text) for key, text in _by_key(varied, "VALUE,VALUE,...").items()}
    with told_at("--design "):
        points = design_points(design, spans) if design else {}
    return checked(Plan(program, Path(case), tuple(fixed), values, Path(folder), points))


def checked(plan):
    """The plan, if each of its runs differs from all others. Raises PlanError."""
    if not plan.keys:
        raise PlanError("nothing varies: --vary KEY=VALUES, or --design sobol:64 with --range KEY=LOW..HIGH")
    for key in plan.points.keys() & plan.varied.keys():
        raise PlanError(f"{key} is varied, and a number of each point as well")
    if len({len(values) for values in plan.points.values()}) > 1:
        raise PlanError("the keys of the points have not the same number of values: "
                        + ", ".join(f"{key} has {len(values)}" for key, values in plan.points.items()))
    [(name, times)] = Counter(run.name for run in plan.runs).most_common(1)
    if times > 1:
        raise PlanError(f"two runs would both be named {name}; is a value given twice?")
    return plan


def _by_key(words, form):
    texts = {}
    for word in words:
        key, equals, text = (part.strip() for part in word.partition("="))
        if not equals or not key:
            raise PlanError(f"{word}: want KEY={form}")
        if key in texts:
            raise PlanError(f"{key}: given twice")
        texts[key] = text
    return texts


def _short(name):
    """The name of a directory: file systems take 255 bytes, and files get names that are longer than their run's."""
    if len(name.encode()) <= LONGEST_NAME:
        return name
    return f"{name.encode()[:LONGEST_NAME - 50].decode(errors='ignore')}-{hashlib.sha256(name.encode()).hexdigest()[:12]}"


def _plain(value):
    """The value with nothing that a shell or a file system could mind: "0.05 us" -> "0.05us"."""
    return re.sub(r"[^\w.+-]+", "_", value.replace(" ", ""))
