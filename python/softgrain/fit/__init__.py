"""Parameters from a measured curve, with intervals. On the command line: `softgrain fit CASE CURVE --free KEY`."""

from .estimate import Estimate, estimate
from .problem import FitError, Problem

__all__ = ["Estimate", "FitError", "Problem", "estimate"]
