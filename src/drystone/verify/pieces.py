"""The steps of a plan, one by one, as the stones and wedges that they place."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from drystone.kernels.polygons import Points
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import StoneStep, WedgeStep
from drystone.model.wall import Labels
from drystone.verify.report import Problem

Step = StoneStep | WedgeStep


@dataclass(frozen=True, eq=False)
class Piece:
    """A stone or wedge where the plan puts it, whether it has room there or not.

    Parameters
    ----------
    step : StoneStep or WedgeStep
        Its step.
    item : Placement or Wedge or None
        What the step comes to; None when it cannot be in the wall at all, which is a problem.
    corners : (n, 2) float array or None
        Its outline in the wall frame, source px, when the stones of the plan are outlines.
    """

    step: Step
    item: Placement | Wedge | None
    corners: Points | None = None

    @property
    def id(self) -> int:
        """Value in wall.png."""
        return piece_id(self.step)


class Canvas(Protocol):
    """Puts piece after piece where the plan says, on one geometry."""

    @property
    def labels(self) -> Labels:
        """All pieces as an image, row 0 at the top."""
        ...

    def put(self, step: Step) -> tuple[Piece, list[Problem]]:
        """Return what a step places, and what stands in the way (E220, E221).

        Raises
        ------
        PlanError
            When the step places nothing: E201, there is no such stone; E220 or E222, there is no
            such wedge.
        """
        ...


def piece_id(step: Step) -> int:
    """Return the value in wall.png of what a step places."""
    return step.id if isinstance(step, WedgeStep) else step.stone


def piece_name(step: Step) -> str:
    """Return what messages call it.

    Examples
    --------
    >>> piece_name(WedgeStep(2, 301, 7, (), None, None))
    'wedge 301'
    """
    return f"{step.kind} {piece_id(step)}"


def grouped(steps: Sequence[Step]) -> tuple[list[list[Step]], list[Problem]]:
    """Put each stone and its wedges together (E214 where the order is not the contract's)."""
    groups: list[list[Step]] = []
    problems = []
    for number, step in enumerate(steps, 1):
        if step.step != number:
            problems.append(Problem("E214", step.step, f"this is step {number} of the plan."))
        if isinstance(step, StoneStep):
            groups.append([step])
            continue
        above = groups[-1][0] if groups else None
        if not isinstance(above, StoneStep) or above.stone != step.under:
            message = f"wedge {step.id} does not follow stone {step.under}, which it supports."
            problems.append(Problem("E214", step.step, message))
        if groups:
            groups[-1].append(step)
    for group in groups:
        early = [s.step for s in group[:-1] if (s.alpha_left, s.alpha_right) != (None, None)]
        problems += [
            Problem("E214", at, "load multipliers are claimed before the stone's last wedge.")
            for at in early
        ]
    return groups, problems
