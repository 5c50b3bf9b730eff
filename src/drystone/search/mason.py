"""Lays the planned stones of a course one after the other."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Literal

from drystone.model.landscape import Landscape
from drystone.model.outlines import Outlined
from drystone.model.placement import Side
from drystone.model.stone import Stone
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.dropping import wedge_limits
from drystone.planner.evaluate import Evaluator, Loaded
from drystone.planner.laying_settings import LayingSettings
from drystone.planner.settings import PlannerSettings
from drystone.planner.settled import settled_in
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.poses import wrap_deg
from drystone.search.course_plan import PlannedStone
from drystone.search.letting_go import Aim, Hand, Resting
from drystone.search.views import View

Views = dict[Side, View]

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


@dataclass(frozen=True)
class Outcome:
    """What became of a planned stone."""

    stone: PlannedStone  # As it was planned
    status: Status  # One of `Status`
    solves: Solves = field(default_factory=Solves)  # What trouble the solver had with its places


@dataclass(frozen=True, eq=False)
class _Chosen:
    """How a stone is laid; without an action why it is not."""

    status: Status  # One of `Status`
    action: Candidate | None = None  # What is to be done
    solves: Solves = field(default_factory=Solves)  # What trouble the solver had with its places


@dataclass(frozen=True)
class _Front:
    """How far the stones of a side of a course have come, in the view of that side."""

    planned: float = 0.0  # Planned right end of the stone that was planned last
    reached: float = 0.0  # Right end of the one that was laid last

    def aim(self, left: float) -> float:
        """Return where the left end of a stone shall be that is planned at a place.

        As far from its neighbour as planned, but no further in than planned.
        """
        return min(left, self.reached + left - self.planned)


@dataclass(frozen=True, eq=False)
class _Rated:
    """A place of a stone, and what the wall carries with the stone there."""

    place: Resting  # The place
    spot: int  # Which of the pose's, the cheapest first
    blocks: list[Outlined]  # (n, 2) Ids and outlines of the stone and its wedge
    loaded: Loaded  # The wall with them
    cost: float  # Of the place, less the bonus for LLC; infinite where the wall does not stand


@dataclass(frozen=True, eq=False)
class Mason:
    """Lays courses."""

    workshop: Workshop  # Stones and site
    settings: PlannerSettings  # How stones settle and are judged
    laying: LayingSettings  # How a plan is laid
    hand: Hand  # Lets stones go
    evaluator: Evaluator  # Judges walls

    @classmethod
    def of(
        cls,
        workshop: Workshop,
        settings: PlannerSettings,
        laying: LayingSettings,
        until: Deadline = NEVER,
    ) -> "Mason":
        """Return who lays stones of a workshop."""
        limits = wedge_limits(settings, workshop.stock, workshop.site)
        hand = Hand(laying, settings.settle, limits, settings.stabilise.method)
        evaluator = Evaluator(settings, workshop.stock, until=until)
        return cls(workshop, settings, laying, hand, evaluator)

    def views(self) -> Views:
        """Look at the bare ground from both ends."""
        width_px, column_px = self.workshop.site.extent_px[0], self.laying.column_px
        return {side: View.bare(width_px, side, self.settings.mu, column_px) for side in SIDES}

    def course(
        self, build: Build, course: Sequence[PlannedStone], views: Views
    ) -> tuple[Build, tuple[Outcome, ...]]:
        """Lay a course."""
        width_px = self.workshop.site.extent_px[0]
        fronts: dict[Side, _Front] = {side: _Front() for side in SIDES}
        outcomes: list[Outcome] = []
        for stone in course:
            side = stone.side
            left, right = _seen_from(side, stone.left_px, stone.right_px, width_px)
            chosen = self._chosen(views, build, stone, side, fronts[side].aim(left))
            outcomes.append(Outcome(stone, chosen.status, chosen.solves))
            end = fronts[side].reached
            if chosen.action is not None:
                build = build.add(chosen.action, keep=True)
                settled = chosen.action.stabilised.placement.settled
                assert settled is not None  # noqa: S101 - it settled on outlines
                x_px = settled.corners[:, 0].tolist()
                _, end = _seen_from(side, min(x_px), max(x_px), width_px)
            fronts[side] = _Front(right, end)
        return self._again(build, outcomes, views)

    def _again(
        self, build: Build, outcomes: Sequence[Outcome], views: Views
    ) -> tuple[Build, tuple[Outcome, ...]]:
        """Try what could not be laid anywhere in its course, from its own side first."""
        ended = list(outcomes)
        for k, one in enumerate(outcomes):
            if one.status in LAID or one.status == "used":
                continue
            status, solves = one.status, one.solves
            for side in sorted(SIDES, key=lambda side: side != one.stone.side):
                chosen = self._chosen(views, build, one.stone, side, None)
                solves += chosen.solves
                if chosen.action is not None:
                    build = build.add(chosen.action, keep=True)
                    status = "elsewhere"
                    break
            ended[k] = Outcome(one.stone, status, solves)
        return build, tuple(ended)

    def _chosen(
        self, views: Views, build: Build, planned: PlannedStone, side: Side, left: float | None
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
            aim = Aim(left, planned.top_px, angle_deg, highest_px, unit_px)
            starts = self.hand.starts(turned, view, aim)
            resting = self.hand.resting(turned, view, aim, starts)
            action, trouble = self._best(build, stone, angle_deg, side, resting)
            solves += trouble
            if action is not None:
                return _Chosen(status, action, solves)
            reasons.append("falls" if resting else "no rest" if starts else "no place")
        # Why not: how far the pose came that came furthest.
        order: tuple[Status, ...] = ("falls", "no rest", "no place")
        return _Chosen(min(reasons, key=order.index), solves=solves)

    def _best(
        self, build: Build, stone: Stone, angle_deg: float, side: Side, resting: Sequence[Resting]
    ) -> tuple[Candidate | None, Solves]:
        """Compare the cheapest places, and return the best after which the wall stands."""
        places = list(enumerate(resting[: self.laying.judged]))
        solves = Solves()
        while places:
            rated = self._rated(build, stone, places)
            places = places[len(rated) :]
            solves += sum((_solves(one.loaded) for one in rated), Solves())
            # What stands is asked of the best of them first: most often it does.
            for one in sorted(rated, key=attrgetter("cost")):
                if one.cost == math.inf:
                    break
                sturdy = self.evaluator.sturdily(build, one.blocks)
                if sturdy is not None:
                    solves += _solves(sturdy, _solves(one.loaded))
                if sturdy is not None and not sturdy.grown.resistance.stable:
                    continue
                action = self._action(build, stone, angle_deg, side, one, sturdy)
                if action is not None and action.sturdy:
                    return action, solves
        return None, solves

    def _rated(
        self, build: Build, stone: Stone, places: Sequence[tuple[int, Resting]]
    ) -> list[_Rated]:
        """Compare some places by cost and LLC: the first, as far as one may be the best."""
        laying, number = self.laying, self.workshop.next_wedge(build)
        rated: list[_Rated] = []
        best, standing = math.inf, 0
        for spot, place in places:
            # LLC is 1 at most: the wall slides on the ground.
            if standing == laying.analysed or place.cost - laying.llc >= best:
                break
            wedges = [] if place.wedge is None else [(number, place.wedge)]
            blocks = [(stone.id, place.repose.settled.corners), *wedges]
            loaded = self.evaluator.loaded(build, blocks)
            llc = loaded.grown.resistance.value or 0.0
            cost = round(place.cost - laying.llc * llc, 9) if llc > 0.0 else math.inf
            rated.append(_Rated(place, spot, blocks, loaded, cost))
            best, standing = min(best, cost), standing + (llc > 0.0)
        return rated

    def _action(
        self,
        build: Build,
        stone: Stone,
        angle_deg: float,
        side: Side,
        rated: _Rated,
        sturdy: Loaded | None,
    ) -> Candidate | None:
        """Return the action that lays a stone at a place; None when it fills no pixel there."""
        place, number = rated.place, self.workshop.next_wedge(build)
        stabilised = settled_in(build.wall, stone, side, place.repose, place.wedge, wedge_id=number)
        if stabilised is None:
            return None
        proposal = Proposal(stabilised, angle_deg, cost=place.cost, spot=rated.spot)
        landscape = Landscape.of(build.wall, side)
        return self.evaluator.candidate(landscape, proposal, rated.loaded, sturdy)


def _solves(loaded: Loaded, known: Solves | None = None) -> Solves:
    """Count the trouble with a place, once in both models."""
    known = known or Solves()
    failed, cold = loaded.grown.resistance.failed, loaded.grown.solved_cold
    return Solves(int(failed and not known.failed), int(cold and not known.cold))


def _seen_from(side: Side, left: float, right: float, width: float) -> tuple[float, float]:
    """Return the left and right end of a stone as a side of the wall sees them."""
    return (left, right) if side == "left" else (width - right, width - left)
