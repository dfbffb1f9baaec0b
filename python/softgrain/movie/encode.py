"""Frames into files: H.264 in MP4 by ffmpeg, GIF and WebP by Pillow, or one PNG for each."""

import subprocess

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

FFMPEG = "ffmpeg"
PALETTE = 256  # colours of a GIF
NEAR = 8  # of 255: Pillow may take a colour this near for another
ONE_FRAME = "frame_{:05}.png"
SMOOTHING = 3  # of frames that become a WebP
LAST = 1500  # how long its last frame stands [ms]
IMAGE_DESCRIPTION = 0x010E  # tag of Exif


def write_mp4(film, path, rate, comment):
    """`rate` frames a second, for every player. Raises OSError with ffmpeg's words where it fails."""
    first = film[0]
    height, width, _ = first.shape
    temporary = path.with_name(path.name + ".tmp")
    words = [FFMPEG, "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
             "-r", f"{rate:g}", "-i", "-", "-c:v", "libx264", "-crf", "18", "-preset", "medium", "-pix_fmt", "yuv420p",
             "-movflags", "+faststart", "-metadata", f"comment={comment}", "-f", "mp4", str(temporary)]
    try:
        with subprocess.Popen(words, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            try:
                for frame in film:
                    process.stdin.write(frame.tobytes())
                process.stdin.close()
            except BrokenPipeError:
                pass  # it says why
            said = process.stderr.read().decode(errors="replace").strip()
        if process.returncode != 0:
            raise OSError(f"{FFMPEG} could not write {path}: {said or f'exit code {process.returncode}'}")
        return temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_gif(film, path, rate, comment):
    """One palette for all frames, so that no colour changes where nothing does; plays again and again."""
    palette = _palette(film)
    images = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in film)
    temporary = path.with_name(path.name + ".tmp")
    hundredths = max(2, round(100 / rate))  # what GIF counts in; browsers slow a frame of less than two down
    try:
        next(images).save(temporary, "GIF", save_all=True, append_images=images, duration=10 * hundredths, loop=0,
                          comment=comment.encode(), optimize=False)
        return temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_webp(film, path, rate, comment):
    """For a page of text: few bytes, plays again and again, and rests at the last frame. Frames are SMOOTHING times as
    large as the film, and are made smaller, so that no seams of cells are seen."""
    frames = (Image.fromarray(frame) for frame in film)
    smaller = (frame.resize((frame.width // SMOOTHING, frame.height // SMOOTHING), Image.LANCZOS) for frame in frames)
    about = Image.Exif()
    about[IMAGE_DESCRIPTION] = comment
    first, *others = smaller
    duration = round(1000 / rate)
    durations = [duration] * len(others) + [LAST]
    temporary = path.with_name(path.name + ".tmp")
    try:
        first.save(temporary, "WEBP", save_all=True, append_images=others, duration=durations, loop=0, quality=60, method=4,
                   exif=about.tobytes())
        return temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_png(film, folder, comment):
    """frame_00000.png and so on in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    about = PngInfo()
    about.add_text("Comment", comment)
    for number, frame in enumerate(film):
        Image.fromarray(frame).save(folder / ONE_FRAME.format(number), pnginfo=about, compress_level=3)
    return folder


def _palette(film):
    """The colours that carry meaning, and the paper; beside them those of the first frame, one in the middle and the last,
    however rare."""
    fixed = np.concatenate([film.key_colours, film[0][:1, 0]]).astype(np.uint8)
    some = np.concatenate([film[k] for k in sorted({0, len(film) // 2, len(film) - 1})])
    found = Image.fromarray(np.unique(some.reshape(-1, 3), axis=0)[None])
    others = found.quantize(PALETTE - len(fixed), method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    palette = Image.new("P", (1, 1))
    others = np.array(others.getpalette(), np.uint8).reshape(-1, 3)
    apart = np.abs(others[:, None].astype(int) - fixed).max(axis=2).min(axis=1)
    palette.putpalette((fixed.tobytes() + others[apart >= NEAR].tobytes())[: 3 * PALETTE])
    return palette
