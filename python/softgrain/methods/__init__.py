"""What a paper must say of a run: a paragraph with its numbers, and BibTeX. On the command line: `softgrain methods RUN`."""

from .facts import Facts, facts_of
from .references import bibtex
from .text import latex, paragraph

__all__ = ["Facts", "bibtex", "facts_of", "latex", "paragraph"]
