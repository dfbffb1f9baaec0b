"""A run as a film: each snapshot as `softgrain plot` draws it, beside the curve. On the command line: `softgrain movie RUN`."""

from .encode import write_gif, write_mp4, write_png
from .frames import Film

__all__ = ["Film", "write_gif", "write_mp4", "write_png"]
