"""A measured curve against a run's. On the command line: `softgrain compare RUN CURVE`."""

from .curve import Comparison, MeasuredCurve, compare, is_smooth, read_measured, run_curve
from .figure import draw_comparison

__all__ = ["Comparison", "MeasuredCurve", "compare", "draw_comparison", "is_smooth", "read_measured", "run_curve"]
