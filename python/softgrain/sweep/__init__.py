"""Many runs of one case with some of its values varied. On the command line: `softgrain sweep CASE`."""

from .plan import PlanError, Plan, PlannedRun, read_plan

__all__ = ["Plan", "PlanError", "PlannedRun", "read_plan"]
