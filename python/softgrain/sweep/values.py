"""The values of a sweep as they are written: lists, ranges, and the numbers between two ends."""

import math
import re
from contextlib import contextmanager
from dataclasses import dataclass
from decimal import Decimal

LONGEST_RANGE = 100_000
DIGITS = 9  # of a number that was computed between two ends
DESIGN_DIGITS = 6  # of one whose place is arbitrary


class PlanError(ValueError):
    """The values to vary make no sense."""


@contextmanager
def told_at(place):
    """What is wrong is told with the place where it was written before it, as "--vary " or "plan.toml, line 3: "."""
    try:
        yield
    except PlanError as error:
        raise PlanError(f"{place}{error}") from error


_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_RANGE = re.compile(rf"({_NUMBER.pattern})\.\.({_NUMBER.pattern})")


def read_values(key, text):
    """"0,0.5" -> two values; "1..5" -> five whole numbers; "0:0.5:0.1" -> first, last and step, the last included;
    "0..0.5:6" -> six numbers from 0 to 0.5.

    Commas within brackets part nothing. Raises PlanError."""
    values = []
    for part in (part.strip() for part in re.split(r",(?![^\[]*\])", text)):
        if re.fullmatch(r"-?\d+\.\.-?\d+", part):
            values.extend(_whole_numbers(key, part))
        elif _RANGE.match(part):
            values.extend(_between(key, part))
        elif ":" in part and _NUMBER.match(part):
            values.extend(_steps(key, part))
        else:
            values.append(part)
    if "" in values or not values:
        raise PlanError(f"{key}: an empty value")
    return values


def _whole_numbers(key, part):
    first, last = map(int, part.split(".."))
    if not first <= last < first + LONGEST_RANGE:
        raise PlanError(f"{key}: '{part}' is not a range of whole numbers FIRST..LAST")
    return [str(number) for number in range(first, last + 1)]


def _between(key, part):
    """"0..0.5:3" -> 0, 0.25, 0.5; "1..3:2 MPa" -> 1 MPa, 3 MPa."""
    ends = _RANGE.match(part)
    tail = re.fullmatch(r":\s*(\d+)\b\s*(.*)", part[ends.end():])
    count = int(tail[1]) if tail else 0
    if not 2 <= count < LONGEST_RANGE:
        raise PlanError(f"{key}: '{part}': only whole numbers are counted from FIRST..LAST; write {key}=0..0.5:6, six "
                        f"numbers from 0 to 0.5, or {key}=0:0.5:0.1, first, last and step")
    low, high = Decimal(ends[1]), Decimal(ends[4])
    return [_quantity(low + (high - low) * k / (count - 1), tail[2]) for k in range(count)]


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
        raise PlanError(f"{key}: '{part}' is no FIRST:LAST:STEP, as in 0:0.5:0.1 or 1:5:2 MPa")
    return [_quantity(first + number * step, unit) for number in range(count + 1)]


def _quantity(number, unit):
    rounded = Decimal(f"{number:.{DIGITS}g}")
    return f"{(number if number == rounded else rounded).normalize():f} {unit}".strip()


@dataclass(frozen=True)
class Range:
    """Where a design puts its points: low..high in `unit`, evenly in the value or in its logarithm."""

    low: float
    high: float
    unit: str = ""
    logarithmic: bool = False

    def at(self, place):
        """The value at 0 (low) to 1 (high), as it is written in a case."""
        if self.logarithmic:
            value = self.low * math.exp(place * math.log(self.high / self.low))
        else:
            value = self.low + place * (self.high - self.low)
        return f"{value:.{DESIGN_DIGITS}g} {self.unit}".strip()


def read_range(key, text):
    """"0..0.5", "1..100 MPa" or "1..100 MPa,log". Raises PlanError."""
    ends, comma, word = (part.strip() for part in text.partition(","))
    found = _RANGE.match(ends)
    if not found or bool(comma) != (word == "log"):
        raise PlanError(f"{key} = {text}: want LOW..HIGH, LOW..HIGH UNIT or LOW..HIGH,log, as in 0..0.5 or "
                        "1..100 MPa,log")
    low, high = float(found[1]), float(found[4])
    if not low < high:
        raise PlanError(f"{key} = {text}: the first end must be below the last")
    if comma and low <= 0:
        raise PlanError(f"{key} = {text}: a range with log begins above 0")
    return Range(low, high, ends[found.end():].strip(), bool(comma))
