"""python3 -m softgrain.law TABLE FIGURE: what `softgrain law CASE -o TABLE --plot FIGURE` draws."""

import argparse
import sys
from pathlib import Path

from softgrain.law import draw_law, read_table
from softgrain.plot import style

USAGE_ERROR, IO_ERROR = 2, 4  # exit codes, those of the program `softgrain`
FORMATS = (".png", ".svg", ".pdf")


def main(words=None):
    parser = argparse.ArgumentParser(prog="softgrain law")
    parser.add_argument("--path", default="uniaxial")
    parser.add_argument("--law", default="")
    parser.add_argument("table")
    parser.add_argument("figure")
    options = parser.parse_args(words)
    if Path(options.figure).suffix not in FORMATS:
        print(f"error: --plot {options.figure}: the name must end in one of {', '.join(FORMATS)}", file=sys.stderr)
        return USAGE_ERROR
    try:
        with style():
            draw_law(read_table(options.table), options.path, options.law).savefig(options.figure, dpi=300)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return IO_ERROR
    print(options.figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
