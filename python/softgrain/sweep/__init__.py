"""Many runs of one case with some of its values varied. On the command line: `softgrain sweep CASE`."""

from .plan import Plan, PlannedRun, read_plan
from .plan_file import read_plan_file
from .values import PlanError

__all__ = ["Plan", "PlanError", "PlannedRun", "read_plan", "read_plan_file"]
