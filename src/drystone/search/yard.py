"""What every wall of a search is built with."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from numpy.random import Generator

from drystone.model.wall import Group
from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.planner import Planner
from drystone.planner.replay import Replayed, replayed
from drystone.planner.settings import PlannerSettings
from drystone.planner.vary import varied
from drystone.planner.workshop import Workshop


@dataclass(frozen=True, eq=False)
class Yard:
    """Stones, site and settings, and until when walls are built.

    The time limit is looked at inside every wall: `TimeIsUp` when it has struck.
    """

    workshop: Workshop
    settings: PlannerSettings
    until: Deadline = NEVER

    @classmethod
    def of(cls, planner: Planner, until: Deadline = NEVER) -> "Yard":
        """Return that of a planner."""
        return cls(planner.workshop, planner.settings, until)

    def jointed(self, number: int) -> "Yard":
        """Return that of a wall of a search: every other one has open joints."""
        if not number % 2:
            return self
        joint_px = self.settings.search.joint * self.workshop.seats.mean_size
        settle = replace(self.settings.settle, joint_px=joint_px)
        return replace(self, settings=replace(self.settings, settle=settle))

    def planner(self, seed: int = 0, settings: PlannerSettings | None = None) -> Planner:
        """Return a planner that has built nothing."""
        return Planner(
            self.workshop.stones,
            self.workshop.site,
            seed=seed,
            settings=settings or self.settings,
            workshop=self.workshop,
        )

    def built_up(self, build: Build, rng: Generator) -> Planner:
        """Build on to the end, stone by stone, with craft weights varied."""
        seed = int(rng.integers(2**31))
        planner = self.planner(seed, varied(self.settings, self.settings.search.spread, rng))
        planner.build = build
        for _ in planner.steps(self.until):
            pass
        return planner

    def replayed(
        self,
        start: Build,
        groups: Sequence[Group],
        course_heights_px: Mapping[int, float],
        *,
        strict: bool = True,
    ) -> Replayed:
        """Place stones with their wedges where they were, judging every step anew."""
        return replayed(
            start, groups, course_heights_px, self.workshop, self.settings,
            strict=strict, until=self.until,
        )  # fmt: skip
