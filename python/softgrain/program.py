"""The command `softgrain` of a wheel: becomes the program that lies in the package, and this interpreter serves its verbs."""

import os
import sys
from pathlib import Path

PROGRAM = Path(__file__).parent / "bin" / "softgrain"


def main():
    os.environ.setdefault("SOFTGRAIN_PYTHON", sys.executable)
    os.environ.setdefault("SOFTGRAIN_PROGRAM", str(PROGRAM))  # a system without /proc does not tell the program where it lies
    os.execv(PROGRAM, ["softgrain", *sys.argv[1:]])
