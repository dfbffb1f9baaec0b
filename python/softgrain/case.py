"""A case and its run, through the program `softgrain`."""

import json
import os
import subprocess
import tomllib
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from .run import Run, html_table, open_run

DOUBTFUL = 5  # the program's exit code


class CaseError(ValueError):
    """The case is invalid; the message is the program's, with the nearest valid key."""


class RunFailed(RuntimeError):
    """The run ended before its end; `code` is the program's exit code, 75 or 130 after a signal."""

    def __init__(self, message: str, code: int):
        super().__init__(message)
        self.code = code


class DoubtfulRun(UserWarning):
    """The run is done, but not to be trusted, or did not reach all that its case asks: `run.doubts`."""


@dataclass(frozen=True)
class Case:
    """A case file and values that replace its own: `Case("case.toml").set("contact.friction", 0.3)`, or values alone in
    place of the defaults: `Case({"experiment": {"model": "mpm"}, "mpm": {"young_modulus": "5 MPa"}})`."""

    path: str | Path | Mapping
    values: tuple[tuple[str, str], ...] = ()

    def __post_init__(self):
        if isinstance(self.path, Mapping):  # an empty file, and all of them set
            object.__setattr__(self, "values", (*_flat(self.path), *self.values))
            object.__setattr__(self, "path", os.devnull)

    def set(self, key: str, value) -> "Case":
        """The same case with one more value replaced; a quantity is a number in SI or text, "0.05 us"."""
        kept = tuple(pair for pair in self.values if pair[0] != key)
        return Case(self.path, (*kept, (key, _toml(value))))

    def resolve(self) -> dict:
        """The whole case in SI, with every default filled in. Raises CaseError."""
        return json.loads(call_program("check", *self.words(), "--json"))["case"]

    def _repr_html_(self) -> str:
        """What a notebook shows: the values that are not left to their defaults, unchecked."""
        given = dict(_flat(tomllib.loads(Path(str(self.path)).read_text())))
        name = "" if self.path == os.devnull else str(self.path)
        return html_table(name, {**given, **dict(self.values)})

    def words(self) -> list[str]:
        """The words that name this case to the program."""
        return [str(self.path), *(f"--set={key}={value}" for key, value in self.values)]


def run_case(case: Case | str | Path, directory: str | Path, threads: int | None = None, resume: bool = False) -> Run:
    """Carries out the case in `directory` and opens it; warns with DoubtfulRun of one that is not to be trusted.
    Raises CaseError, RunFailed; Ctrl-C leaves a snapshot."""
    case = case if isinstance(case, Case) else Case(case)
    options = ["--resume"] if resume else []
    if threads is not None:
        options.append(f"--threads={threads}")
    try:
        call_program("run", *case.words(), "-o", str(directory), "--quiet", *options)
    except RunFailed as failure:
        if failure.code != DOUBTFUL:
            raise
        warnings.warn(DoubtfulRun(str(failure)), stacklevel=2)
    return open_run(directory)


def call_program(*words: str) -> str:
    """Stdout of `softgrain words`; SOFTGRAIN_PROGRAM names another program."""
    program = os.environ.get("SOFTGRAIN_PROGRAM", "softgrain")
    with subprocess.Popen([program, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            out, err = process.communicate()
        except KeyboardInterrupt:
            process.wait()  # it got Ctrl-C as well, and writes its last snapshot
            raise
    if process.returncode == 2:
        raise CaseError(err.strip())
    if process.returncode != 0:
        raise RunFailed(err.strip() or f"stopped with exit code {process.returncode}", process.returncode)
    return out


def _flat(tables: Mapping):
    """("contact.friction", "0.3") for {"contact": {"friction": 0.3}} or {"contact.friction": 0.3}."""
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from ((f"{name}.{key}", text) for key, text in _flat(value))
        else:
            yield name, _toml(value)


def _toml(value) -> str:
    """A Python value as it is written in a case file."""
    return value if isinstance(value, str) else json.dumps(value)
