"""Which runs a sweep consists of: every combination of the varied values, by name."""

import hashlib
import itertools
import re
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

LONGEST_RANGE = 100_000
LONGEST_NAME = 200  # of a run's directory [bytes]
SEED = "sample.seed"


class PlanError(ValueError):
    """The values to vary make no sense."""


@dataclass(frozen=True)
class PlannedRun:
    """One run: its name, unique in the sweep, and its values as they were written, by key."""

    name: str
    values: dict


@dataclass(frozen=True)
class Plan:
    """`softgrain run CASE --set ...` for each of `runs`, into FOLDER/runs/NAME."""

    program: str
    case: Path
    fixed: tuple  # key=value of --set, the same in all runs
    varied: dict  # key -> values as they were written
    folder: Path

    @property
    def runs(self):
        """The last key varies fastest."""
        combinations = itertools.product(*self.varied.values())
        return [self._run(dict(zip(self.varied, values))) for values in combinations]

    def directory(self, run):
        return self.folder / "runs" / run.name

    def command(self, verb, run, *options):
        """The words that call `verb` for the run's case."""
        sets = [*self.fixed, *(f"{key}={value}" for key, value in run.values.items())]
        return [self.program, verb, str(self.case), *(f"--set={word}" for word in sets), *options]

    def run_command(self, run, *options):
        """The words that begin the run, or go on with it."""
        return self.command("run", run, "-o", str(self.directory(run)), "--resume", *options)

    def _run(self, values):
        return PlannedRun(_short("-".join(f"{self._label(key)}_{_plain(value)}" for key, value in values.items())), values)

    def _label(self, key):
        """"friction" of "contact.friction", unless another varied key ends so."""
        short = key.rpartition(".")[2]
        alone = sum(other.rpartition(".")[2] == short for other in self.varied) == 1
        return short if alone else key


def read_plan(program, case, fixed, varied, folder):
    """The plan of `--vary KEY=VALUES` words. Raises PlanError."""
    values = {}
    for word in varied:
        key, equals, text = word.partition("=")
        if not equals or not key.strip():
            raise PlanError(f"--vary {word}: want KEY=VALUE,VALUE,... as in contact.friction=0,0.5")
        if key in values:
            raise PlanError(f"--vary {key}: given twice")
        values[key] = _values(key, text)
    plan = Plan(program, Path(case), tuple(fixed), values, Path(folder))
    names = [run.name for run in plan.runs]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise PlanError(f"two runs would both be named {min(twice)}; is a value given twice?")
    return plan


def _values(key, text):
    """"0,0.5" -> two values; "1..5" -> five whole numbers; "0:0.5:0.1" -> first, last and step, the last included.

    Commas within brackets part nothing."""
    values = []
    for part in (part.strip() for part in re.split(r",(?![^\[]*\])", text)):
        if re.fullmatch(r"-?\d+\.\.-?\d+", part):
            first, last = map(int, part.split(".."))
            if not first <= last < first + LONGEST_RANGE:
                raise PlanError(f"--vary {key}: '{part}' is not a range of whole numbers FIRST..LAST")
            values.extend(str(number) for number in range(first, last + 1))
        elif ".." in part and _NUMBER.match(part):
            raise PlanError(f"--vary {key}: '{part}': only whole numbers are counted from FIRST..LAST; write {key}=0:0.5:0.1, "
                            "first, last and step, or the values one by one")
        elif ":" in part and _NUMBER.match(part):
            values.extend(_steps(key, part))
        else:
            values.append(part)
    if "" in values:
        raise PlanError(f"--vary {key}: an empty value")
    return values


_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


def _steps(key, part):
    """"0:0.5:0.1" -> 0, 0.1, ... 0.5; "1:5:2 MPa" -> 1 MPa, 3 MPa, 5 MPa. In decimals, so that 0.3 is 0.3."""
    *numbers, tail = part.split(":")
    found = _NUMBER.match(tail.strip())
    unit = tail.strip()[found.end():].strip() if found else ""
    try:
        first, last, step = (Decimal(number.strip()) for number in (*numbers, found[0] if found else ""))
        count = int((last - first) / step) if step else -1
    except (ArithmeticError, ValueError):
        count = -1
    if not 0 <= count < LONGEST_RANGE:
        raise PlanError(f"--vary {key}: '{part}' is no FIRST:LAST:STEP, as in 0:0.5:0.1 or 1:5:2 MPa")
    values = (first + number * step for number in range(count + 1))
    return [f"{value.normalize():f} {unit}".strip() for value in values]


def _short(name):
    """The name of a directory: file systems take 255 bytes, and files get names that are longer than their run's."""
    if len(name.encode()) <= LONGEST_NAME:
        return name
    return f"{name.encode()[:LONGEST_NAME - 50].decode(errors='ignore')}-{hashlib.sha256(name.encode()).hexdigest()[:12]}"


def _plain(value):
    """The value with nothing that a shell or a file system could mind: "0.05 us" -> "0.05us"."""
    return re.sub(r"[^\w.+-]+", "_", value.replace(" ", ""))
