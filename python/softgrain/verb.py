"""What all verbs in Python share: what they say of errors, and their exit codes, those of the program `softgrain`."""

import sys

from .options import parse
from .run import NotRecorded

USAGE_ERROR, IO_ERROR = 2, 4


def carry_out(verb, arguments, action) -> int:
    """action(options) returns the exit code, None for 0; an error of its own is told, and becomes 2 or 4."""
    options = parse(verb, arguments)
    try:
        return action(options) or 0
    except (ValueError, NotRecorded) as error:
        print(f"error: {error}", file=sys.stderr)
        return USAGE_ERROR
    except OSError as error:
        words = f"{error.filename}: {error.strerror}" if error.filename and error.strerror else error
        print(f"error: {words}", file=sys.stderr)
        return IO_ERROR
