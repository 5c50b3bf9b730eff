"""A finished wall and what it is worth."""

from dataclasses import dataclass, field, replace

from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.course_plan import CoursePlan
from drystone.search.goal import (
    Figures,
    figures_of,
    merit_of,
    possible_filling,
    with_coulomb,
)
from drystone.statics.flow.flow_search import STARTS, NonassociativeSettings

QUICK = NonassociativeSettings(starts=STARTS[:1], random_starts=0, let_go=False)
"""One start of twelve finds the least load without dilatancy of most walls."""


@dataclass(frozen=True)
class Courses:
    """How a wall was laid course by course."""

    plan: CoursePlan  # What was planned
    ends: tuple[int, ...]  # How many stones the wall had before the first course, and after each


@dataclass(frozen=True, eq=False)
class Found:
    """A finished wall and what it is worth."""

    build: Build  # The wall
    figures: Figures | None  # Its figures of merit; None when it is empty
    merit: float  # Their weighted sum; no less than that of the same wall once it is `judged`
    solves: Solves = field(default_factory=Solves)  # What trouble there was with it
    courses: Courses | None = None  # How it was laid; None for a wall that was not planned before

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

    def judged(
        self,
        workshop: Workshop,
        settings: PlannerSettings,
        flow: NonassociativeSettings | None = None,
        until: Deadline = NEVER,
    ) -> "Found":
        """Return the same wall with what it carries without dilatancy, unless that is known."""
        figures = self.figures
        if figures is None or self.build.wall.outlines is None:
            return self
        if figures.F_LR_coulomb is not None and flow is None:
            return self
        figures = with_coulomb(figures, self.build.model, flow or QUICK, until)
        merit = merit_of(figures, possible_filling(workshop), settings.goal)
        return replace(self, figures=figures, merit=merit)
