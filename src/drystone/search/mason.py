"""Lays the planned stones of a course one after the other."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from drystone.model.landscape import Landscape
from drystone.model.placement import Side
from drystone.model.wall import outlined
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.dropping import wedge_limits
from drystone.planner.evaluate import Evaluator
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.poses import wrap_deg
from drystone.search.course_plan import PlannedStone
from drystone.search.laying_settings import LayingSettings
from drystone.search.letting_go import Aim, Hand, Resting
from drystone.search.views import View
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.stabilise.stabilise import Stabilised

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
    """

    stone: PlannedStone
    status: Status


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
        statuses: list[Status] = []
        for stone in course:
            left, right = _seen((stone.left_px, stone.right_px), stone.side, width_px)
            front = fronts[stone.side]
            chosen = self._chosen(build, stone, stone.side, front.aim_px(left), views)
            statuses.append(chosen.status)
            reached = front.reached_px
            if chosen.action is not None:
                build = build.add(chosen.action, keep=True)
                settled = chosen.action.stabilised.placement.settled
                assert settled is not None  # noqa: S101 - it settled on outlines
                reached = _seen(settled.corners[:, 0].tolist(), stone.side, width_px)[1]
            fronts[stone.side] = _Front(right, reached)
        build = self._again(build, course, statuses, views)
        return build, tuple(map(Outcome, course, statuses))

    def _again(
        self, build: Build, course: Sequence[PlannedStone], statuses: list[Status], views: Views
    ) -> Build:
        """Try the stones that could not be laid anywhere in their course."""
        for k, stone in enumerate(course):
            if statuses[k] in LAID or statuses[k] == "used":
                continue
            both = [self._chosen(build, stone, side, None, views) for side in views]
            best = min(both, key=lambda one: one.cost)
            if best.action is not None:
                build = build.add(best.action, keep=True)
                statuses[k] = "elsewhere"
        return build

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
        for status, half_deg in HALVES:
            angle_deg = wrap_deg(planned.angle_deg + half_deg)
            turned = self.workshop.outlines.hung(stone, angle_deg, side).turned
            aim = Aim(left_px, planned.top_px, angle_deg, highest_px, unit_px)
            starts = self.hand.starts(turned, view, aim)
            resting = self.hand.resting(turned, view, aim, starts)
            cost, action = self._best(build, planned, side, resting)
            if action is not None:
                return _Chosen(status, action, cost)
            reasons.append("falls" if resting else "no rest" if starts else "no place")
        # How far the pose came that came furthest.
        for reason in ("falls", "no rest"):
            if reason in reasons:
                return _Chosen(reason)
        return _Chosen("no place")

    def _best(
        self, build: Build, planned: PlannedStone, side: Side, resting: Sequence[Resting]
    ) -> tuple[float, Candidate | None]:
        """Judge the cheapest places, and return the best after which the wall stands."""
        laying = self.laying
        best: tuple[float, Candidate | None] = (math.inf, None)
        standing = 0
        landscape = Landscape.of(build.wall, side)
        for spot, place in enumerate(resting[: laying.judged]):
            stabilised = self._stabilised(build, planned.stone_id, side, place)
            if stabilised is None:
                continue
            proposal = Proposal(stabilised, planned.angle_deg, cost=place.cost, spot=spot)
            action = self.evaluator.judge(build, landscape, proposal)
            llc = action.indices.LLC or 0.0
            if not action.sturdy or llc <= 0.0:
                continue
            cost = round(place.cost - laying.llc * llc, 9)
            if cost < best[0]:
                best = cost, action
            standing += 1
            if standing == laying.analysed:
                break
        return best

    def _stabilised(
        self, build: Build, stone_id: int, side: Side, place: Resting
    ) -> Stabilised | None:
        """Return a stone and its wedge with the pixels that they fill; None when it fills none."""
        wall, found = build.wall, place.repose
        assert wall.outlines is not None  # noqa: S101 - a course plan is laid on outlines
        stone = self.workshop.stones.by_id(stone_id)
        placement = settled_placement(
            wall.outlines, wall.site, stone, found.angle_deg, found.settled, side, int(found.turned)
        )
        if placement is None or place.wedge is None:
            return None if placement is None else Stabilised(placement)
        with_stone = wall.outlines.added(outlined(placement, ()), wall.site.scale)
        number = self.workshop.next_wedge(build)
        wedge = settled_wedge(with_stone, wall.site, number, stone_id, place.wedge)
        return Stabilised(placement, (wedge,))


def _seen(x_px: Iterable[float], side: Side, width_px: float) -> tuple[float, float]:
    """Return the ends of a stone as a side sees them."""
    x = list(x_px)
    return (min(x), max(x)) if side == "left" else (width_px - max(x), width_px - min(x))
