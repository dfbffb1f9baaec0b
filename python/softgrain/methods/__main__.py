"""python3 -m softgrain.methods RUN: a paragraph and BibTeX for a paper."""

import sys

import softgrain

from ..verb import carry_out
from . import bibtex, facts_of, latex, paragraph

DOUBTFUL = 5  # exit code, that of the program `softgrain`


def write(options):
    run = softgrain.open(options.run)
    facts = facts_of(run)
    text, keys = paragraph(run, facts)
    print(latex(text) if options.format == "latex" else text, bibtex(facts, keys), sep="\n\n")
    return DOUBTFUL if run.doubts or run.info.get("state") != "done" else 0


def main(arguments=None):
    return carry_out("methods", arguments, write)


if __name__ == "__main__":
    sys.exit(main())
