"""python3 -m softgrain.methods RUN: a paragraph and BibTeX for a paper."""

import sys

import softgrain

from ..options import parse
from . import bibtex, facts_of, latex, paragraph

USAGE_ERROR, IO_ERROR, DOUBTFUL = 2, 4, 5  # exit codes, those of the program `softgrain`


def main(arguments=None):
    options = parse("methods", arguments)
    try:
        run = softgrain.open(options.run)
        facts = facts_of(run)
        text, keys = paragraph(run, facts)
        print(latex(text) if options.format == "latex" else text, bibtex(facts, keys), sep="\n\n")
    except (ValueError, softgrain.NotRecorded) as error:
        print(f"error: {error}", file=sys.stderr)
        return USAGE_ERROR
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return IO_ERROR
    return DOUBTFUL if run.doubts or run.info.get("state") != "done" else 0


if __name__ == "__main__":
    sys.exit(main())
