"""What every solver returns."""

from dataclasses import dataclass

from drystone.statics.lp.program import Floats
from drystone.statics.result import LimitStatus


@dataclass(frozen=True, eq=False)
class Solution:
    """Answer to: minimise costs . x subject to the program."""

    status: LimitStatus  # OPTIMAL; UNSTABLE when the program has no solution; UNBOUNDED; FAILED
    columns: Floats | None
    """Unknowns; for UNBOUNDED a ray along which the costs fall for ever, if the solver has it."""
    duals: Floats | None
    """Of the rows, y with costs - y . column >= 0; for UNSTABLE a ray with y . column <= 0 and y .
    rhs > 0, if the solver has it."""
    said: str  # status in the solver's words
    solver: str
