"""The eight cases, in their order."""

from .flowing import METAL_SPHERE, POWDER
from .one_grain import ONE_GRAIN, SPHERE
from .packing_cases import COMPACTION, JAMMING, MIXTURE
from .two_disks import TWO_DISKS

CASES = (ONE_GRAIN, TWO_DISKS, JAMMING, COMPACTION, MIXTURE, SPHERE, METAL_SPHERE, POWDER)
