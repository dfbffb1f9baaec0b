"""What `softgrain plot`, `movie`, `sweep`, `export` and the other verbs of Python become: python3 DIR/softgrain VERB WORDS."""

import gc
import sys
from importlib import import_module
from pathlib import Path

if not __package__:  # the folder itself was run: its neighbours must not hide other packages
    sys.path[0] = str(Path(__file__).parent.parent)


GARBAGE_THRESHOLD = 100_000  # objects: to import Matplotlib makes many and no rubbish, and looking for it costs 5 % of a plot


def main(verb, *words):
    gc.set_threshold(GARBAGE_THRESHOLD)
    try:
        if verb != "sweep":
            import h5py  # noqa: F401  needed later, wanted now
        program = import_module(f"softgrain.{verb}.__main__")
    except ImportError as missing:
        more = (", SciPy", " python3-scipy") if verb == "fit" else ("", "")
        print(f"error: {missing}\n`softgrain {verb}` needs NumPy, h5py{more[0]} and Matplotlib for {sys.executable}; on Debian:\n"
              f"  apt install python3-matplotlib python3-h5py{more[1]}", file=sys.stderr)
        return 2
    return program.main(words)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
