"""Lays the planned stones of a course one after the other, on pixels."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from drystone.model.landscape import Landscape
from drystone.model.placement import Side
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.evaluate import Evaluator
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.poses import wrap_deg
from drystone.search.course_plan import PlannedStone
from drystone.search.laying_settings import LayingSettings
from drystone.search.one_course import (
    HALVES,
    Chosen,
    Ends,
    Outcome,
    Status,
    furthest,
    laid_course,
    seen_from,
)
from drystone.search.pixel_places import Lying, PixelAim, PixelHand


@dataclass(frozen=True, eq=False)
class PixelMason:
    """Lays courses of stones that are pixels.

    Parameters
    ----------
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        How walls are judged.
    laying : LayingSettings
        How a plan is laid.
    hand : PixelHand
        Puts stones down.
    evaluator : Evaluator
        Judges walls.
    """

    workshop: Workshop
    settings: PlannerSettings
    laying: LayingSettings
    hand: PixelHand
    evaluator: Evaluator

    @classmethod
    def of(
        cls,
        workshop: Workshop,
        settings: PlannerSettings,
        laying: LayingSettings,
        until: Deadline = NEVER,
    ) -> "PixelMason":
        """Return who lays stones of a workshop."""
        hand = PixelHand(laying.put_down, workshop.memory)
        evaluator = Evaluator(settings, workshop.stock, until=until)
        return cls(workshop, settings, laying, hand, evaluator)

    def course(
        self, build: Build, course: Sequence[PlannedStone]
    ) -> tuple[Build, tuple[Outcome, ...]]:
        """Lay a course.

        Parameters
        ----------
        build : Build
            What is there.
        course : sequence of PlannedStone
            In the order of laying.

        Returns
        -------
        build : Build
            The wall with the course.
        outcomes : tuple of Outcome
            Of its stones, in their order.
        """
        return laid_course(build, course, self._chosen, self._planned_ends, self._reached)

    def _chosen(
        self, build: Build, planned: PlannedStone, side: Side, left: float | None
    ) -> Chosen:
        """Choose how a stone is laid, with its left end near a place of the view or anywhere."""
        if planned.stone_id not in self.workshop.remaining(build):
            return Chosen("used")
        scale = self.workshop.site.scale
        stone = self.workshop.stones.by_id(planned.stone_id)
        landscape = Landscape.of(build.wall, side)
        number = self.workshop.next_wedge(build)
        unit = self.workshop.stock.mean_height_px
        reasons: list[Status] = []
        solves = Solves()
        for status, half_deg in HALVES:
            angle_deg = wrap_deg(planned.angle_deg + half_deg)
            aim = PixelAim(left, planned.top_px * scale, angle_deg, unit)
            posed = self.workshop.book.pose(stone, angle_deg)
            lying = self.hand.lying(build.wall, landscape, posed, aim, number)
            action, trouble = self._best(build, landscape, angle_deg, lying)
            solves += trouble
            if action is not None:
                return Chosen(status, action, solves)
            reasons.append("falls" if lying else "no place")
        return Chosen(furthest(reasons), solves=solves)

    def _best(
        self, build: Build, landscape: Landscape, angle_deg: float, lying: Sequence[Lying]
    ) -> tuple[Candidate | None, Solves]:
        """Judge the cheapest places, and return the best after which the wall stands."""
        put_down = self.laying.put_down
        best: tuple[float, Candidate | None] = (math.inf, None)
        standing, solves = 0, Solves()
        for spot, place in enumerate(lying[: put_down.judged]):
            proposal = Proposal(place.stabilised, angle_deg, cost=place.cost, spot=spot)
            action = self.evaluator.judge(build, landscape, proposal)
            solves += Solves.of(action)
            llc = action.indices.LLC or 0.0
            if llc <= 0.0:
                continue
            cost = round(place.cost - put_down.llc * min(llc, 1.0), 9)
            if cost < best[0]:
                best = cost, action
            standing += 1
            if standing == put_down.analysed:
                break
        return best[1], solves

    def _planned_ends(self, stone: PlannedStone) -> Ends:
        """Return where a planned stone ends as its side sees it, working px."""
        site = self.workshop.site
        ends = stone.left_px * site.scale, stone.right_px * site.scale
        return seen_from(stone.side, ends, site.width_px)

    def _reached(self, action: Candidate) -> float:
        """Return how far a stone reaches as its side sees it."""
        at = action.stabilised.placement
        ends = float(at.col), float(at.col + at.posed.width_px)
        return seen_from(action.side, ends, self.workshop.site.width_px)[1]
