"""A run as a film: each snapshot as `softgrain plot` draws it, beside the curve. On the command line: `softgrain movie RUN`."""

from .encode import write_gif, write_mp4, write_png
from .frames import Film
from .space import FilmInSpace

__all__ = ["Film", "FilmInSpace", "film_of", "write_gif", "write_mp4", "write_png"]


def film_of(run, width) -> Film:
    """Of either dimension; width of the picture [px]. Raises NotRecorded."""
    return (FilmInSpace if run.in_space else Film)(run, width)
