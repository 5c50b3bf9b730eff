"""The steps of a plan, one by one, as the stones and wedges that they place."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from drystone.kernels.polygons import Points
from drystone.model.placement import Placement, Wedge
from drystone.model.steps import Fault, Step, piece_id, piece_name
from drystone.model.steps import grouped as steps_grouped
from drystone.model.wall import Labels
from drystone.verify.report import Problem

__all__ = ["Canvas", "Piece", "Step", "grouped", "piece_id", "piece_name", "problem_of"]


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


def grouped(steps: Sequence[Step]) -> tuple[list[list[Step]], list[Problem]]:
    """Put each stone and its wedges together (E214 where the order is not the contract's)."""
    groups, faults = steps_grouped(steps)
    return groups, [problem_of(fault) for fault in faults]


def problem_of(fault: Fault) -> Problem:
    """Return a fault of the steps as what a check found."""
    return Problem(fault.code, fault.step, fault.message)
