"""Lays the planned stones of a course one after the other."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal

from drystone.model.landscape import Landscape
from drystone.model.placement import Side
from drystone.model.stone import Stone
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.dropping import wedge_limits
from drystone.planner.evaluate import Evaluator
from drystone.planner.settings import PlannerSettings
from drystone.planner.settled import settled_in
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.poses import wrap_deg
from drystone.search.course_plan import PlannedStone
from drystone.search.laying_settings import LayingSettings
from drystone.search.letting_go import Aim, Hand, Resting
from drystone.search.views import View

Status = Literal["as planned", "half turn", "elsewhere", "used", "no place", "no rest", "falls"]
"""What became of a planned stone.

Laid as planned, turned by half, or elsewhere in its course after it could not be laid in its turn.
Not laid: it is in the wall already; there is nowhere to let it go near its planned top; it rests
nowhere there; or the wall would not stand.
"""

LAID: tuple[Status, ...] = ("as planned", "half turn", "elsewhere")
"""Of a stone that is in the wall by the plan."""

HALVES: tuple[tuple[Status, float], ...] = (("as planned", 0.0), ("half turn", 180.0))
"""Turns from the planned pose that are tried, one after the other."""

Views = dict[Side, View]


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


@dataclass(frozen=True)
class _Front:
    """How far the stones of a side of a course have come, in the view of that side.

    Parameters
    ----------
    planned_px : float
        Planned right end of the stone that was planned last.
    reached_px : float
        Right end of the one that was laid last.
    """

    planned_px: float = 0.0
    reached_px: float = 0.0

    def aim_px(self, left_px: float) -> float:
        """Return where the left end of a stone shall be that is planned at a place.

        As far from its neighbour as planned, but no further in than planned.
        """
        return min(left_px, self.reached_px + left_px - self.planned_px)


@dataclass(frozen=True, eq=False)
class _Chosen:
    """How a stone is laid; without an action why it is not."""

    status: Status
    action: Candidate | None = None
    cost: float = math.inf
    solves: Solves = field(default_factory=Solves)


@dataclass(frozen=True, eq=False)
class Mason:
    """Lays courses.

    Parameters
    ----------
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        How stones settle and are judged.
    laying : LayingSettings
        How a plan is laid.
    hand : Hand
        Lets stones go.
    evaluator : Evaluator
        Judges walls.
    """

    workshop: Workshop
    settings: PlannerSettings
    laying: LayingSettings
    hand: Hand
    evaluator: Evaluator

    @classmethod
    def of(cls, workshop: Workshop, settings: PlannerSettings, laying: LayingSettings) -> "Mason":
        """Return who lays stones of a workshop."""
        limits = wedge_limits(settings, workshop.stock, workshop.site.scale)
        hand = Hand(laying.let_go, settings.settle, limits, settings.stabilise.method)
        return cls(workshop, settings, laying, hand, Evaluator(settings, workshop.stock))

    def views(self) -> Views:
        """Look at the bare ground from both ends."""
        width_px, column_px = self.workshop.site.extent_px[0], self.laying.let_go.column_px
        sides: tuple[Side, ...] = ("left", "right")
        return {side: View.bare(width_px, side, self.settings.mu, column_px) for side in sides}

    def course(
        self, build: Build, course: Sequence[PlannedStone], views: Views
    ) -> tuple[Build, tuple[Outcome, ...]]:
        """Lay a course.

        Parameters
        ----------
        build : Build
            What is there.
        course : sequence of PlannedStone
            In the order of laying.
        views : dict
            Of an earlier state of the same wall; those that are looked at are brought up to date.

        Returns
        -------
        build : Build
            The wall with the course.
        outcomes : tuple of Outcome
            Of its stones, in their order.
        """
        width_px = self.workshop.site.extent_px[0]
        fronts: dict[Side, _Front] = {"left": _Front(), "right": _Front()}
        outcomes: list[Outcome] = []
        for stone in course:
            left, right = _seen((stone.left_px, stone.right_px), stone.side, width_px)
            front = fronts[stone.side]
            chosen = self._chosen(build, stone, stone.side, front.aim_px(left), views)
            outcomes.append(Outcome(stone, chosen.status, chosen.solves))
            reached = front.reached_px
            if chosen.action is not None:
                build = build.add(chosen.action, keep=True)
                settled = chosen.action.stabilised.placement.settled
                assert settled is not None  # noqa: S101 - it settled on outlines
                reached = _seen(settled.corners[:, 0].tolist(), stone.side, width_px)[1]
            fronts[stone.side] = _Front(right, reached)
        return self._again(build, outcomes, views)

    def _again(
        self, build: Build, outcomes: Sequence[Outcome], views: Views
    ) -> tuple[Build, tuple[Outcome, ...]]:
        """Try the stones that could not be laid anywhere in their course."""
        ended = list(outcomes)
        for k, one in enumerate(outcomes):
            if one.status in LAID or one.status == "used":
                continue
            both = [self._chosen(build, one.stone, side, None, views) for side in views]
            best = min(both, key=lambda chosen: chosen.cost)
            status = one.status
            if best.action is not None:
                build = build.add(best.action, keep=True)
                status = "elsewhere"
            solves = sum((chosen.solves for chosen in both), one.solves)
            ended[k] = Outcome(one.stone, status, solves)
        return build, tuple(ended)

    def _chosen(
        self, build: Build, planned: PlannedStone, side: Side, left_px: float | None, views: Views
    ) -> _Chosen:
        """Choose how a stone is laid, with its left end near a place of the view or anywhere."""
        if planned.stone_id not in self.workshop.remaining(build):
            return _Chosen("used")
        outlines, site = build.wall.outlines, self.workshop.site
        assert outlines is not None  # noqa: S101 - a course plan is laid on outlines
        view = views[side] = views[side].grown(outlines)
        unit_px = self.workshop.stock.mean_height_px / site.scale
        highest_px = site.extent_px[1] + self.settings.settle.beyond_px
        stone = self.workshop.stones.by_id(planned.stone_id)
        reasons: list[Status] = []
        solves = Solves()
        for status, half_deg in HALVES:
            angle_deg = wrap_deg(planned.angle_deg + half_deg)
            turned = self.workshop.outlines.hung(stone, angle_deg, side).turned
            aim = Aim(left_px, planned.top_px, angle_deg, highest_px, unit_px)
            starts = self.hand.starts(turned, view, aim)
            resting = self.hand.resting(turned, view, aim, starts)
            cost, action, trouble = self._best(build, stone, angle_deg, side, resting)
            solves += trouble
            if action is not None:
                return _Chosen(status, action, cost, solves)
            reasons.append("falls" if resting else "no rest" if starts else "no place")
        # How far the pose came that came furthest.
        for reason in ("falls", "no rest"):
            if reason in reasons:
                return _Chosen(reason, solves=solves)
        return _Chosen("no place", solves=solves)

    def _best(
        self, build: Build, stone: Stone, angle_deg: float, side: Side, resting: Sequence[Resting]
    ) -> tuple[float, Candidate | None, Solves]:
        """Judge the cheapest places, and return the best after which the wall stands."""
        laying, number = self.laying, self.workshop.next_wedge(build)
        best: tuple[float, Candidate | None] = (math.inf, None)
        standing, solves = 0, Solves()
        landscape = Landscape.of(build.wall, side)
        for spot, place in enumerate(resting[: laying.judged]):
            stabilised = settled_in(
                build.wall, stone, side, place.repose, place.wedge, wedge_id=number
            )
            if stabilised is None:
                continue
            proposal = Proposal(stabilised, angle_deg, cost=place.cost, spot=spot)
            action = self.evaluator.judge(build, landscape, proposal)
            solves += Solves.of(action)
            llc = action.indices.LLC or 0.0
            if not action.sturdy or llc <= 0.0:
                continue
            cost = round(place.cost - laying.llc * llc, 9)
            if cost < best[0]:
                best = cost, action
            standing += 1
            if standing == laying.analysed:
                break
        return *best, solves


def _seen(x_px: Iterable[float], side: Side, width_px: float) -> tuple[float, float]:
    """Return the ends of a stone as a side sees them."""
    x = list(x_px)
    return (min(x), max(x)) if side == "left" else (width_px - max(x), width_px - min(x))
