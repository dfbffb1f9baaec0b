"""What is said of one statement of the paper, and how all of it is written down."""

import json
from dataclasses import asdict, dataclass

import numpy as np

from . import causes


@dataclass(frozen=True)
class Verdict:
    """A statement of the paper against our number. `cause`: one of causes.ALL; `shown`: what shows it; `run`: its commands."""

    figure: str
    statement: str  # of the paper, in our words
    ours: str
    agrees: bool  # as stated, with the paper's recipe
    cause: str = causes.AS_STATED
    shown: str = ""
    run: str = ""


@dataclass(frozen=True)
class Changed:
    """Our number with one ingredient changed."""

    cause: str  # if it agrees then
    shown: str
    agrees: bool
    run: str = ""


def judge(figure, statement, ours, agrees, changed=(), remark=""):
    """The first change that makes the statement agree gives the cause; none: open, with all that was tried."""
    if agrees:
        return Verdict(figure, statement, ours, True, shown=remark)
    for change in changed:
        if change.agrees:
            return Verdict(figure, statement, ours, False, change.cause, "; ".join(filter(None, (change.shown, remark))), change.run)
    tried = "; ".join(filter(None, (*(change.shown for change in changed), remark)))
    return Verdict(figure, statement, ours, False, causes.OPEN, tried, next((c.run for c in changed if c.run), ""))


@dataclass(frozen=True)
class Spread:
    """Mean and standard deviation over seeds."""

    mean: float
    deviation: float
    count: int

    @classmethod
    def of(cls, values):
        values = [value for value in values if value is not None]
        if not values:
            return cls(float("nan"), 0.0, 0)
        return cls(float(np.mean(values)), float(np.std(values)), len(values))

    def text(self, digits=2):
        plus_minus = f" ± {self.deviation:.{digits}f}" if self.count > 1 else ""
        return f"{self.mean:.{digits}f}{plus_minus}"


def seeds_of(results):
    """"5 (mpm), 3 (bpm)": how many samples there were of each kind."""
    kinds = {}
    for (way, model, _), curves in results.packings.items():
        kinds.setdefault(f"{way} {model}", len(curves))
    return ", ".join(f"{count} {kind}" for kind, count in kinds.items() if count)


def write(found, results, folder, scale_name, program):
    """verdicts.md and verdicts.json."""
    (folder / "verdicts.json").write_text(json.dumps([asdict(v) for v in found], indent=1, default=bool) + "\n")
    lines = ["# The paper's statements, held against these runs", "", causes.headline(found) + ".", "",
             f"Scale `{scale_name}`; samples: {seeds_of(results) or 'none'}; ± is the standard deviation over them. {program}. "
             "Nothing was tuned to agree: each row gives the paper's own recipe first, then what one changed ingredient gives. "
             "The commands of the runs that show a cause stand below.", "",
             "| Fig. | the paper | here | | cause, and what shows it | run |", "|---|---|---|---|---|---|"]
    runs = list(dict.fromkeys(v.run for v in found if v.run))
    for v in found:
        cause = "" if v.agrees else f"**{v.cause}**: "
        lines.append(f"| {v.figure} | {v.statement} | {v.ours} | {'agrees' if v.agrees else 'differs'} | {cause}{v.shown} | "
                     f"{f'({runs.index(v.run) + 1})' if v.run else ''} |")
    if runs:
        lines += ["", "## The runs that show the causes", "",
                  *(f"{number}. `{command}`" for number, command in enumerate(runs, 1))]
    (folder / "verdicts.md").write_text("\n".join(lines) + "\n")
