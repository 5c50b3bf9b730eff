"""Re-derive walls from the input stones and plans alone, and verify what plans claim."""

from drystone.verify.check import check_plan
from drystone.verify.replay import rebuild_wall
from drystone.verify.report import CheckReport, PrefixAlpha, Problem

__all__ = ["CheckReport", "PrefixAlpha", "Problem", "check_plan", "rebuild_wall"]
