"""plan.toml: what a sweep consists of, to be written by hand; each sweep keeps one in its folder.

Its keys are `case`, `output`, `seeds` and `design`, its tables `[set]`, `[vary]`, `[range]` and `[points]`."""

import difflib
import json
import os
import re
import tempfile
import tomllib
from pathlib import Path

from .design import design_points
from .plan import SEED, Plan, checked
from .values import PlanError, read_range, read_values, told_at

NAME = "plan.toml"
HEADER = r"# \d+ runs\. "  # of one that a sweep keeps
WORDS, TABLES = ("case", "output", "design", "seeds"), ("set", "vary", "range", "points")


class AsWritten(str):
    """A number of the file with the digits that it has there."""


def is_plan(path):
    """Whether the file has the key that no case has."""
    try:
        return "case" in tomllib.loads(Path(path).read_text())
    except (OSError, ValueError):
        return False


def read_plan_file(program, path, folder=None):
    """The plan that stands in the file; paths in it start from its folder, where the runs go unless it says otherwise.

    Raises PlanError with the place in the file, OSError."""
    path = Path(path)
    text = path.read_text()
    try:
        table = tomllib.loads(text, parse_float=AsWritten)
    except tomllib.TOMLDecodeError as error:
        raise PlanError(f"{path}: {error}") from error
    at = _Places(path, text)
    _refuse_unknown(table, at)
    if "case" not in table:
        raise PlanError(f"{path}: it is no plan, which names its case: case = \"case.toml\". "
                        "A case itself needs --vary KEY=VALUES, and -o DIR")
    varied = {key: _values(key, value, at) for key, value in _flat(table.get("vary", {}))}
    if "seeds" in table:
        seeds = table["seeds"]
        varied[SEED] = _values(SEED, f"1..{seeds}" if isinstance(seeds, int) else seeds, at)
    points = {key: _list(key, value, at) for key, value in _flat(table.get("points", {}))}
    here = path.parent
    fixed = tuple(f"{key}={_text(value)}" for key, value in _flat(table.get("set", {})))
    folder = Path(folder or here / table.get("output", ""))
    plan = Plan(program, here / table["case"], fixed, varied, folder, points | _design(table, at))
    with told_at(f"{path}: "):
        return checked(plan)


def write_plan_file(plan):
    """FOLDER/plan.toml. Raises PlanError where one lies that was written by hand."""
    path, folder = plan.folder / NAME, plan.folder.resolve()
    if path.exists() and not re.match(HEADER, path.read_text()):
        raise PlanError(f"{path} was written by hand and would be overwritten; call softgrain sweep {path}, or choose "
                        "another directory with -o")
    case = os.path.relpath(plan.case.resolve(), folder)
    lines = [f"# {len(plan.runs)} runs. Go on with: softgrain sweep {plan.folder}    "
             f"How far they are: softgrain sweep status {plan.folder}", f"case = {_quoted(case)}"]
    fixed = dict(word.split("=", 1) for word in plan.fixed)
    for name, table in (("set", fixed), ("points", plan.points), ("vary", plan.varied)):
        if table:
            lines += ["", f"[{name}]", *(f"{_quoted(key)} = {_toml(value)}" for key, value in table.items())]
    write_whole(path, "\n".join(lines) + "\n")
    return path


def write_whole(path, text):
    """The file is whole at any time, whoever is killed and whoever else writes it."""
    if path.exists() and path.read_text() == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    number, temporary = tempfile.mkstemp(dir=path.parent, prefix=path.name, suffix=".tmp")
    with open(number, "w") as file:
        file.write(text)
    os.chmod(temporary, 0o666 & ~_umask())
    os.replace(temporary, path)


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


class _Places:
    """Where a key stands in the file, for messages."""

    def __init__(self, path, text):
        self.path, self.lines = path, text.splitlines()

    def __call__(self, key):
        """"plan.toml, line 3: "; a key may be written short in a table of its own."""
        for name in (key, key.rpartition(".")[2]):
            for number, line in enumerate(self.lines, 1):
                if re.match(rf"\s*\[?[\s\"']*{re.escape(name)}[\s\"']*[=\]]", line):
                    return f"{self.path}, line {number}: "
        return f"{self.path}: "


def _refuse_unknown(table, at):
    for key, value in table.items():
        known = TABLES if isinstance(value, dict) else WORDS
        if key not in known:
            near = difflib.get_close_matches(key, known, 1) or known
            kind = "table" if isinstance(value, dict) else "key"
            raise PlanError(f"{at(key)}'{key}' is no {kind} of a plan; do you mean {' or '.join(near)}?")
    for key in ("case", "output", "design"):
        if not isinstance(table.get(key, ""), str):
            raise PlanError(f"{at(key)}{key} = {table[key]}: want text in quotation marks")


def _flat(tables):
    """("contact.friction", 0.3) for {"contact": {"friction": 0.3}} or {"contact.friction": 0.3}."""
    for name, value in tables.items():
        if isinstance(value, dict):
            yield from ((f"{name}.{key}", each) for key, each in _flat(value))
        else:
            yield name, value


def _values(key, value, at):
    """A list has the values one by one; text is read as behind --vary."""
    if isinstance(value, list):
        return _list(key, value, at)
    with told_at(at(key)):
        return read_values(key, _text(value))


def _list(key, value, at):
    if not isinstance(value, list) or not value:
        raise PlanError(f"{at(key)}{key} = {_text(value)}: want a list of values, as in [0, 0.5]")
    return [_text(each) for each in value]


def _design(table, at):
    spans = {}
    for key, value in _flat(table.get("range", {})):
        with told_at(at(key)):
            spans[key] = read_range(key, _text(value))
    if spans and "design" not in table:
        raise PlanError(f"{at('range')}[range] is where a design has its points, and there is none: "
                        "design = \"sobol:64\"")
    with told_at(at("design")):
        return design_points(table["design"], spans) if "design" in table else {}


def _text(value, within=False):
    """As --set takes it: text without its quotation marks unless it stands in a list."""
    if isinstance(value, list):
        return f"[{', '.join(_text(each, True) for each in value)}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return _quoted(value) if within and not isinstance(value, (int, AsWritten)) else str(value)


def _toml(value):
    """A value, or a list of them; whole numbers that follow each other as "1..5"."""
    if isinstance(value, str):
        return _quoted(value)
    if len(value) > 2 and value[0].isdecimal() and list(value) == [str(int(value[0]) + k) for k in range(len(value))]:
        return _quoted(f"{value[0]}..{value[-1]}")
    return f"[{', '.join(map(_quoted, value))}]"


def _quoted(text):
    return json.dumps(str(text), ensure_ascii=False)
