"""Colours of pictures: the same maps and ranges in `softgrain plot`, in SVG and on the page (viewer/src/colours.ts, colouring.ts)."""

from typing import NamedTuple

import numpy as np

# Perceptual maps, each as 17 colours between which we interpolate (from Matplotlib).
MAPS = {
    "viridis": "44015448186a472d7b4240863b528b33638d2c728e26828e21918c1fa08828ae803fbc735ec96284d44baddc30d8e219fde725",
    "cividis": "00224e002e6a1a386f32436d434e6c535a6d61656f6f70737d7c788c88789b9476aba072bcae6ccdbb63dec958f0d846fee838",
    "PuOr": "2d004b4518715f3a917b6aa89990bfb7b1d5cfcfe5e4e5f0f7f7f6fce8cdfed59ffdbc6bee9b39d97b12bd61099e4c077f3b08",
}
INK, PALE = "#222222", "#E4E4E4"
CHAINS, CHAINS_ON_ORANGE = "#E62947", "#00806A"  # a hue that the colours of the grains do not have
OUTERMOST = 0.01  # share of the values beyond either end of a range
CLOSE = 0.8  # where the least is more of the largest, zero is far away
SAMPLED_FRAMES = 12  # of a run: enough for a range


class Range(NamedTuple):
    """A colour map from `low` to `high`."""

    map: str
    low: float
    high: float

    def rgb(self, values) -> np.ndarray:
        """(n, 3), from 0 to 1. What is not finite has the colour of `low`."""
        share = (np.asarray(values, float) - self.low) / (self.high - self.low or 1)
        colours = colours_of(self.map)
        place = np.linspace(0, 1, len(colours))
        return np.column_stack([np.interp(np.nan_to_num(share), place, channel) for channel in colours.T])

    def hexadecimal(self, values) -> list[str]:
        return words_of(self.rgb(values))

    @property
    def chains(self) -> str:
        return CHAINS_ON_ORANGE if self.map == "PuOr" else CHAINS


def words_of(rgb) -> list[str]:
    """(n, 3), from 0 to 1, as #rrggbb."""
    return ["#%02x%02x%02x" % tuple(row) for row in np.rint(255 * np.asarray(rgb)).astype(int)]


def colours_of(name: str) -> np.ndarray:
    """(17, 3), from 0 to 1."""
    return np.frombuffer(bytes.fromhex(MAPS[name]), np.uint8).reshape(-1, 3) / 255


def range_of(values) -> Range:
    """From 0, or symmetric about it where both signs are common, or from end to end where they are close together;
    without the outermost 1 % of the values."""
    values = np.asarray(values, float)
    values = np.sort(values[np.isfinite(values)])
    if values.size == 0:
        return Range("cividis", 0.0, 1.0)
    low, high = (float(values[int(share * (values.size - 1))]) for share in (OUTERMOST, 1 - OUTERMOST))
    if low > CLOSE * high and high > low:
        return Range("viridis", low, high)
    low, high = min(0.0, low), max(0.0, high)
    reach = max(-low, high) or 1.0
    if min(-low, high) > 0.1 * reach:
        return Range("PuOr", -reach, reach)
    return Range("cividis", 0.0, reach) if high >= -low else Range("cividis", -reach, 0.0)


def sampled(count: int, most: int = SAMPLED_FRAMES) -> list[int]:
    """Up to `most` of `count` frames, evenly, the first and the last among them."""
    return sorted({int(k * (count - 1) / max(1, most - 1) + 0.5) for k in range(most)}) if count else []
