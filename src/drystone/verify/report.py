"""What checking a plan found."""

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

from drystone.model.plan import PlanMetrics


@dataclass(frozen=True)
class Problem:
    """One claim of a plan that does not hold.

    Parameters
    ----------
    code : str
        Stable code, ``"E210"`` to ``"E242"``; documented in ``docs/errors.md``.
    step : int or None
        Number of the step concerned; None when it is the plan as a whole.
    message : str
        What is claimed and what was found.
    """

    code: str
    step: int | None
    message: str

    def __str__(self) -> str:
        where = "" if self.step is None else f"step {self.step}: "
        return f"{self.code} {where}{self.message}"


def contradicted(name: str, claimed: float | None, found: float | None) -> str:
    """Say that a plan claims another value than was found; None is written null, as in JSON.

    Examples
    --------
    >>> contradicted("F_AH", 2.5, None)
    'F_AH is 2.5 by the plan, but there is no such value.'
    >>> contradicted("F_AH", None, 2.5)
    'F_AH is null by the plan, 2.5 was found.'
    """
    said = "null" if claimed is None else claimed
    if found is None:
        return f"{name} is {said} by the plan, but there is no such value."
    return f"{name} is {said} by the plan, {found} was found."


@dataclass(frozen=True)
class PrefixAlpha:
    """What the wall carries after a stone and its wedges.

    Parameters
    ----------
    step : int
        Last step of the stone and its wedges.
    alpha_left, alpha_right : float or None
        Load multipliers found; None where the wall does not stand.
    """

    step: int
    alpha_left: float | None
    alpha_right: float | None


@dataclass(frozen=True)
class CheckReport:
    """Outcome of :func:`drystone.verify.check.check_plan`.

    Parameters
    ----------
    problems : tuple of Problem
        Every claim that does not hold; empty when the plan is what it says.
    overlap_depth : float
        How deep real outlines of two stones (on exact geometry also of wedges) lie in each other
        at most, source px; see :func:`drystone.model.overlap.overlap_depth`.
    overlap_depth_at : (int, int) or None
        Ids of the two; None when no two outlines overlap.
    buried : tuple of int
        Ids of stones that cannot be lowered in from above; no failure.
    area_error : float
        Largest deviation of a stone's pixels in the wall from its own area, as a share of it.
    area_error_at : int or None
        Id of that stone; None for an empty plan.
    prefixes : tuple of PrefixAlpha
        Load multipliers after every stone, as far as the wall could be built.
    metrics : PlanMetrics or None
        Recomputed; None when the wall could not be built to its end.
    notes : tuple of str
        What was not or could not be checked, and what is worth knowing.
    geometry : {"raster", "exact"}
        What the plan was verified on: the pixels or the outlines of its stones.
    """

    problems: tuple[Problem, ...]
    overlap_depth: float
    overlap_depth_at: tuple[int, int] | None
    buried: tuple[int, ...]
    area_error: float
    area_error_at: int | None
    prefixes: tuple[PrefixAlpha, ...]
    metrics: PlanMetrics | None
    notes: tuple[str, ...]
    geometry: Literal["raster", "exact"] = "raster"

    @property
    def ok(self) -> bool:
        """True when nothing was found that does not hold."""
        return not self.problems

    def as_dict(self) -> dict[str, Any]:
        """Return what ``drystone check --json`` prints."""
        return {"ok": self.ok, **dataclasses.asdict(self)}
