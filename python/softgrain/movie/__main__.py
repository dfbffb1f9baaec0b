"""python3 -m softgrain.movie RUN -o FILE: a run as a film."""

import shutil
import sys
from pathlib import Path

import softgrain

from ..plot.style import provenance, style
from ..verb import carry_out
from . import encode, film_of

DURATION = 10  # of a film that says nothing else [s]
SLOWEST, FASTEST = 5, 30  # frames a second
WIDTHS = {".mp4": 1280, ".gif": 800, ".webp": 640, "": 1280}  # [px]


def make(options):
    """Writes the film; returns its path."""
    path = Path(options.output)
    suffix = path.suffix.lower()
    if suffix not in WIDTHS:
        raise ValueError(f"--output {path}: the name must end in .mp4, .gif or .webp; one without an ending is a folder of PNG files")
    run = softgrain.open(options.run)
    with style():
        width = options.width or WIDTHS[suffix]
        film = film_of(run, width * encode.SMOOTHING if suffix == ".webp" else width)
        rate = options.fps or min(FASTEST, max(SLOWEST, len(film) / DURATION))
        comment = "; ".join(provenance([run]))
        path.parent.mkdir(parents=True, exist_ok=True)
        if suffix == ".gif":
            return encode.write_gif(film, path, rate, comment)
        if suffix == ".webp":
            return encode.write_webp(film, path, rate, comment)
        if suffix == ".mp4" and shutil.which(encode.FFMPEG):
            return encode.write_mp4(film, path, rate, comment)
        if suffix == ".mp4":
            folder = path.with_suffix("")
            print(f"softgrain movie: no ffmpeg here (Debian: apt install ffmpeg), so the frames are written as PNG;\n"
                  f"  ffmpeg -r {rate:g} -i {folder}/{encode.ONE_FRAME.replace('{:05}', '%05d')} -pix_fmt yuv420p {path}\n"
                  "makes the film of them", file=sys.stderr)
        return encode.write_png(film, path.with_suffix(""), comment)


def main(arguments=None):
    return carry_out("movie", arguments, lambda options: print(make(options)))


if __name__ == "__main__":
    sys.exit(main())
