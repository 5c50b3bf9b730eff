"""The stones of a course, laid one after the other from both ends to its gap."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal, Protocol

from drystone.model.placement import Side
from drystone.planner.build import Build, Candidate
from drystone.planner.solves import Solves
from drystone.search.course_plan import PlannedStone

Status = Literal["as planned", "half turn", "elsewhere", "used", "no place", "no rest", "falls"]
"""What became of a planned stone.

Laid as planned, turned by half, or elsewhere in its course after it could not be laid in its turn.
Not laid: it is in the wall already; there is nowhere to let it go near its planned top; it rests
nowhere there (of stones on outlines); or the wall would not stand.
"""

LAID: tuple[Status, ...] = ("as planned", "half turn", "elsewhere")
"""Of a stone that is in the wall by the plan."""

HALVES: tuple[tuple[Status, float], ...] = (("as planned", 0.0), ("half turn", 180.0))
"""Turns from the planned pose that are tried, one after the other."""

SIDES: tuple[Side, ...] = ("left", "right")

Ends = tuple[float, float]
"""Left and right end of a stone as a side of the wall sees them."""


@dataclass(frozen=True)
class Outcome:
    """What became of a planned stone.

    Parameters
    ----------
    stone : PlannedStone
        As it was planned.
    status : str
        One of :data:`Status`.
    solves : Solves
        What trouble the solver had with its places.
    """

    stone: PlannedStone
    status: Status
    solves: Solves = field(default_factory=Solves)


@dataclass(frozen=True, eq=False)
class Chosen:
    """How a stone is laid; without an action why it is not.

    Parameters
    ----------
    status : str
        One of :data:`Status`.
    action : Candidate or None
        What is to be done.
    solves : Solves
        What trouble the solver had with its places.
    """

    status: Status
    action: Candidate | None = None
    solves: Solves = field(default_factory=Solves)


class Choose(Protocol):
    """Chooses how a stone is laid."""

    def __call__(
        self, build: Build, planned: PlannedStone, side: Side, left: float | None
    ) -> Chosen:
        """Choose with the stone's left end near a place of the view, or anywhere in its course."""
        ...


@dataclass(frozen=True)
class Front:
    """How far the stones of a side of a course have come, in the view of that side.

    Parameters
    ----------
    planned : float
        Planned right end of the stone that was planned last.
    reached : float
        Right end of the one that was laid last.
    """

    planned: float = 0.0
    reached: float = 0.0

    def aim(self, left: float) -> float:
        """Return where the left end of a stone shall be that is planned at a place.

        As far from its neighbour as planned, but no further in than planned.
        """
        return min(left, self.reached + left - self.planned)


def laid_course(
    build: Build,
    course: Sequence[PlannedStone],
    choose: Choose,
    planned_ends: Callable[[PlannedStone], Ends],
    reached: Callable[[Candidate], float],
) -> tuple[Build, tuple[Outcome, ...]]:
    """Lay a course.

    Parameters
    ----------
    build : Build
        What is there.
    course : sequence of PlannedStone
        In the order of laying.
    choose : callable
        Says how a stone is laid.
    planned_ends : callable
        Where a stone is planned, as its side sees it.
    reached : callable
        How far a stone reaches that is laid, likewise.

    Returns
    -------
    build : Build
        The wall with the course.
    outcomes : tuple of Outcome
        Of its stones, in their order.
    """
    fronts: dict[Side, Front] = {side: Front() for side in SIDES}
    outcomes: list[Outcome] = []
    for stone in course:
        left, right = planned_ends(stone)
        front = fronts[stone.side]
        chosen = choose(build, stone, stone.side, front.aim(left))
        outcomes.append(Outcome(stone, chosen.status, chosen.solves))
        end = front.reached
        if chosen.action is not None:
            build = build.add(chosen.action, keep=True)
            end = reached(chosen.action)
        fronts[stone.side] = Front(right, end)
    return _again(build, outcomes, choose)


def _again(
    build: Build, outcomes: Sequence[Outcome], choose: Choose
) -> tuple[Build, tuple[Outcome, ...]]:
    """Try the stones that could not be laid anywhere in their course, from their own side first."""
    ended = list(outcomes)
    for k, one in enumerate(outcomes):
        if one.status in LAID or one.status == "used":
            continue
        status, solves = one.status, one.solves
        for side in sorted(SIDES, key=lambda side: side != one.stone.side):
            chosen = choose(build, one.stone, side, None)
            solves += chosen.solves
            if chosen.action is not None:
                build = build.add(chosen.action, keep=True)
                status = "elsewhere"
                break
        ended[k] = Outcome(one.stone, status, solves)
    return build, tuple(ended)


def furthest(reasons: Sequence[Status]) -> Status:
    """Return why a stone is not laid: how far the pose came that came furthest."""
    order: tuple[Status, ...] = ("falls", "no rest", "no place")
    return min(reasons, key=order.index)


def seen_from(side: Side, ends: Ends, width: float) -> Ends:
    """Return the ends of a stone as a side sees them, by those in the wall frame."""
    left, right = ends
    return (left, right) if side == "left" else (width - right, width - left)
