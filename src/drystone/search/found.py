"""A finished wall and what it is worth."""

from dataclasses import dataclass, field

from drystone.planner.build import Build
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.course_plan import CoursePlan
from drystone.search.goal import Figures, figures_of, merit_of, possible_filling


@dataclass(frozen=True)
class Courses:
    """How a wall was laid course by course.

    Parameters
    ----------
    plan : CoursePlan
        What was planned.
    ends : tuple of int
        How many stones the wall had before the first course, and after each.
    """

    plan: CoursePlan
    ends: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Found:
    """A finished wall and what it is worth.

    Parameters
    ----------
    build : Build
        The wall.
    figures : Figures or None
        Its figures of merit; None when it is empty.
    merit : float
        Their weighted sum.
    solves : Solves
        What trouble there was with it.
    courses : Courses or None
        How it was laid; None for a wall that was not planned before.
    """

    build: Build
    figures: Figures | None
    merit: float
    solves: Solves = field(default_factory=Solves)
    courses: Courses | None = None

    @classmethod
    def of(
        cls, planner: Planner, courses: Courses | None = None, before: Solves | None = None
    ) -> "Found":
        """Measure what a planner has built, after what trouble there was before."""
        solves = (before or Solves()) + Solves(planner.failed_solves, planner.cold_solves)
        return cls.measured(planner.build, planner.workshop, planner.settings, solves, courses)

    @classmethod
    def measured(
        cls,
        build: Build,
        workshop: Workshop,
        settings: PlannerSettings,
        solves: Solves | None = None,
        courses: Courses | None = None,
    ) -> "Found":
        """Measure a wall."""
        figures = figures_of(build, settings.pin)
        merit = merit_of(figures, possible_filling(workshop), settings.goal)
        return cls(build, figures, merit, solves or Solves(), courses)
