"""What checking a plan found."""

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

from drystone.model.plan import PlanMetrics
from drystone.model.steps import Problem


def contradicted(name: str, claimed: float | None, found: float | None) -> str:
    """Say that a plan claims another value than was found; None is written null, as in JSON."""
    said = "null" if claimed is None else claimed
    if found is None:
        return f"{name} is {said} by the plan, but there is no such value."
    return f"{name} is {said} by the plan, {found} was found."


@dataclass(frozen=True)
class PrefixAlpha:
    """What the wall carries after a stone and its wedges."""

    step: int  # last step of the stone and its wedges
    alpha_left: float | None
    alpha_right: float | None  # load multipliers found; None where the wall does not stand


@dataclass(frozen=True)
class CheckReport:
    """Outcome of :func:`drystone.verify.check.check_plan`."""

    problems: tuple[Problem, ...]
    """Every claim that does not hold; empty when the plan is what it says."""
    overlap_depth: float
    """How deep real outlines of two stones (on exact geometry also of wedges) lie in each other at
    most, source px; see :func:`drystone.model.overlap.overlap_depth`."""
    overlap_depth_at: tuple[int, int] | None  # ids of the two; None when no two outlines overlap
    buried: tuple[int, ...]  # ids of stones that cannot be lowered in from above; no failure
    area_error: float
    """Largest deviation of a stone's pixels in the wall from its own area, as a share of it."""
    area_error_at: int | None  # id of that stone; None for an empty plan
    prefixes: tuple[PrefixAlpha, ...]
    """Load multipliers after every stone, as far as the wall could be built."""
    metrics: PlanMetrics | None  # recomputed; None when the wall could not be built to its end
    notes: tuple[str, ...]
    geometry: Literal["raster", "exact"] = "raster"
    """What the plan was verified on: the pixels or the outlines of its stones."""

    @property
    def ok(self) -> bool:
        """True when nothing was found that does not hold."""
        return not self.problems

    def as_dict(self) -> dict[str, Any]:
        """Return what ``drystone check --json`` prints."""
        return {"ok": self.ok, **dataclasses.asdict(self)}
