"""Laying a course plan, stone by stone.

A plan knows height profiles only.  Here each stone is let go near its planned place, pushed to the
neighbour on its side of the course, and of all places where it rests one is taken that is near the
plan, keeps the course's width, and leaves a wall that stands.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.laying_settings import LayingSettings
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.course_plan import CoursePlan, PlannedStone
from drystone.search.mason import LAID, Mason, Outcome


@dataclass(frozen=True, eq=False)
class Laid:
    """A course plan, laid."""

    states: tuple[Build, ...]  # Before the first course, and after each
    # Of the stones of each course, in the order of the plan
    courses: tuple[tuple[Outcome, ...], ...]

    @property
    def build(self) -> Build:
        """The wall after the last course."""
        return self.states[-1]

    @property
    def laid(self) -> tuple[PlannedStone, ...]:
        """The planned stones that were laid."""
        return tuple(one.stone for one in self._outcomes() if one.status in LAID)

    @property
    def failed(self) -> tuple[Outcome, ...]:
        """The planned stones that were not, and why."""
        return tuple(one for one in self._outcomes() if one.status not in LAID)

    @property
    def solves(self) -> Solves:
        """What trouble the solver had."""
        return sum((one.solves for one in self._outcomes()), Solves())

    def _outcomes(self) -> Iterator[Outcome]:
        return (one for course in self.courses for one in course)


def lay(
    plan: CoursePlan,
    build: Build,
    workshop: Workshop,
    settings: PlannerSettings,
    laying: LayingSettings | None = None,
    until: Deadline = NEVER,
) -> Laid:
    """Lay a course plan."""
    mason = Mason.of(workshop, settings, laying or settings.laying, until)
    views = mason.views()
    states: list[Build] = [build]
    courses: list[tuple[Outcome, ...]] = []
    for course in plan.courses:
        after, became = mason.course(states[-1], course, views)
        states.append(after)
        courses.append(became)
    return Laid(tuple(states), tuple(courses))
