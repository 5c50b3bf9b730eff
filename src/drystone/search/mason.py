"""Laying a course plan, stone by stone.

A plan knows height profiles only.  Here each stone is let go near its planned place, pushed to the
neighbour on its side of the course, and of all places where it rests one is taken that is near the
plan, keeps the course's width, and leaves a wall that stands.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from operator import attrgetter
from typing import Literal

from drystone.kernels.raster import wrap_deg
from drystone.model.landscape import Landscape
from drystone.model.outlines import Outlined
from drystone.model.placement import Side
from drystone.model.stone import Stone
from drystone.planner.build import Build, Candidate, Proposal, Solves
from drystone.planner.evaluate import Evaluator, Loaded, trouble
from drystone.planner.search_settings import LayingSettings
from drystone.planner.views import SideView
from drystone.search.courses import CoursePlan, PlannedStone
from drystone.search.letting_go import Aim, Hand, Resting
from drystone.search.yard import Yard
from drystone.settle.placing import settled_in

Status = Literal["as planned", "half turn", "elsewhere", "used", "no place", "no rest", "falls"]
"""What became of a planned stone.

Laid as planned, turned by half, or elsewhere in its course after it could not be laid in its turn.
Not laid: it is in the wall already; there is nowhere to let it go near its planned top; it rests
nowhere there (of stones on outlines); or the wall would not stand.
"""

HALVES: tuple[tuple[Status, float], ...] = (("as planned", 0.0), ("half turn", 180.0))
"""Turns from the planned pose that are tried, one after the other."""

SIDES: tuple[Side, ...] = ("left", "right")


@dataclass(frozen=True, eq=False)
class StoneLaying:
    """What became of a planned stone."""

    stone: PlannedStone
    status: Status
    action: Candidate | None = None  # what is done; None where it is not laid
    solves: Solves = field(default_factory=Solves)  # trouble with its places


@dataclass(frozen=True, eq=False)
class CourseLaying:
    """A course plan, laid."""

    states: tuple[Build, ...]  # before the first course, and after each
    courses: tuple[tuple[StoneLaying, ...], ...]  # in the order of the plan

    @property
    def build(self) -> Build:
        """The wall after the last course."""
        return self.states[-1]

    @property
    def solves(self) -> Solves:
        """What trouble the solver had."""
        return sum((one.solves for one in chain(*self.courses)), Solves())


def lay(
    plan: CoursePlan, build: Build, yard: Yard, laying: LayingSettings | None = None
) -> CourseLaying:
    """Lay a course plan on what is built; stones that are in the wall already are passed over."""
    mason = Mason.of(yard, laying or yard.settings.laying)
    states, courses = [build], []
    for course in plan.courses:
        after, became = mason.course(states[-1], course)
        states.append(after)
        courses.append(became)
    return CourseLaying(tuple(states), tuple(courses))


@dataclass(frozen=True, eq=False)
class _RatedPlace:
    """A place of a stone, and what the wall carries with the stone there."""

    place: Resting
    spot: int  # which of the pose's, the cheapest first
    blocks: list[Outlined]  # the stone and its wedge
    loaded: Loaded  # the wall with them
    cost: float  # of the place, less the bonus for LLC; infinite where the wall does not stand


@dataclass(frozen=True, eq=False)
class Mason:
    """Lays the planned stones of courses one after the other."""

    yard: Yard
    laying: LayingSettings
    hand: Hand
    evaluator: Evaluator
    views: dict[Side, SideView]  # from both ends; brought up to date when they are looked at

    @classmethod
    def of(cls, yard: Yard, laying: LayingSettings) -> "Mason":
        """Return one who looks at the bare ground."""
        workshop, settings = yard.workshop, yard.settings
        hand = Hand(laying, settings.settle, yard.limits, settings.stabilise.method)
        evaluator = Evaluator(settings, workshop.stock, until=yard.until)
        width_px, mu = workshop.site.extent_px[0], settings.mu
        views = {side: SideView.bare(width_px, side, mu, laying.column_px) for side in SIDES}
        return cls(yard, laying, hand, evaluator, views)

    def course(
        self, build: Build, course: Sequence[PlannedStone]
    ) -> tuple[Build, tuple[StoneLaying, ...]]:
        """Lay the stones of a course in their order, on the same wall as before with more on it."""
        width_px = self.yard.workshop.site.extent_px[0]
        # Of each side, as it sees them: the planned right end of the stone that was planned last,
        # and the right end of the one that was laid last.
        planned, reached = dict.fromkeys(SIDES, 0.0), dict.fromkeys(SIDES, 0.0)
        became: list[StoneLaying] = []
        for stone in course:
            side = stone.side
            left, right = _seen_from(side, stone.left_px, stone.right_px, width_px)
            # As far from its neighbour as planned, but no further in than planned.
            aim = min(left, reached[side] + left - planned[side])
            became.append(self._laid(build, stone, side, aim))
            planned[side], action = right, became[-1].action
            if action is not None:
                build = build.add(action, keep=True)
                x_px = action.stabilised.placement.exact.corners[:, 0].tolist()
                _, reached[side] = _seen_from(side, min(x_px), max(x_px), width_px)
        # What could not be laid is tried anywhere in its course, from its own side first.
        for k, one in enumerate(became):
            if one.action is not None or one.status == "used":
                continue
            status, solves = one.status, one.solves
            for side in sorted(SIDES, key=lambda side: side != one.stone.side):
                again = self._laid(build, one.stone, side, None)
                solves += again.solves
                if again.action is not None:
                    build = build.add(again.action, keep=True)
                    status = "elsewhere"
                    break
            became[k] = StoneLaying(one.stone, status, again.action, solves)
        return build, tuple(became)

    def _laid(
        self, build: Build, planned: PlannedStone, side: Side, left: float | None
    ) -> StoneLaying:
        """Choose how a stone is laid, with its left end near a place of the view or anywhere."""
        workshop = self.yard.workshop
        if planned.stone_id not in workshop.remaining(build):
            return StoneLaying(planned, "used")
        site = workshop.site
        view = self.views[side] = self.views[side].grown(build.wall.exact.polygons)
        unit_px = workshop.stock.mean_height_px / site.scale
        highest_px = site.extent_px[1] + self.yard.settings.settle.beyond_px
        stone = workshop.stones.by_id(planned.stone_id)
        reasons: list[Status] = []
        least, surest = math.inf, None
        solves = Solves()
        for status, half_deg in HALVES:
            angle_deg = wrap_deg(planned.angle_deg + half_deg)
            turned = workshop.outlines.hung(stone, angle_deg, side).turned
            aim = Aim(left, planned.top_px, angle_deg, highest_px, unit_px)
            starts = self.hand.starts(turned, view, aim)
            resting = self.hand.resting(turned, view, aim, starts)
            least, action, trouble = self._surest(build, stone, angle_deg, side, resting, least)
            solves += trouble
            if action is not None:
                surest = StoneLaying(planned, status, action)
                if not least:
                    break
            reasons.append("falls" if resting else "no rest" if starts else "no place")
        if surest is not None:
            return replace(surest, solves=solves)
        # Why not: how far the pose came that came furthest.
        order: tuple[Status, ...] = ("falls", "no rest", "no place")
        return StoneLaying(planned, min(reasons, key=order.index), None, solves)

    def _surest(
        self, build: Build, stone: Stone, angle_deg: float, side: Side,
        resting: Sequence[Resting], least: float,
    ) -> tuple[float, Candidate | None, Solves]:  # fmt: skip
        """Compare the cheapest places after which the wall stands.

        Return one of them, and in which share of the trials something falls there: the best where
        nothing does, else that of the least share, if it is below `least`.
        """
        surest: tuple[float, Candidate | None] = least, None
        places, seats = list(enumerate(resting[: self.laying.judged])), self.yard.workshop.seats
        solves = Solves()
        while places:
            rated = self._rated(build, stone, places)
            places = places[len(rated) :]
            solves += sum((trouble(one.loaded) for one in rated), Solves())
            # What stands is asked of the best of them first: most often it does.
            for one in sorted(rated, key=attrgetter("cost")):
                if one.cost == math.inf:
                    break
                sturdy = self.evaluator.sturdily(build, one.blocks)
                if sturdy is not None:
                    solves += trouble(one.loaded, sturdy) - trouble(one.loaded)
                    if not sturdy.grown.resistance.stable:
                        continue
                place = one.place
                stabilised = settled_in(
                    build.wall, stone, side, place.repose, place.wedge,
                    wedge_id=self.yard.workshop.next_wedge(build),
                )  # fmt: skip
                if stabilised is None:  # it fills no pixel there
                    continue
                proposal = Proposal(stabilised, angle_deg, cost=place.cost, spot=one.spot)
                landscape = Landscape.of(build.wall, side)
                action = self.evaluator.candidate(landscape, proposal, one.loaded, sturdy)
                falls = seats.falls(stabilised, build.wall, surest[0]) if action.sturdy else None
                if falls is not None:
                    surest = falls, action
                if not surest[0]:
                    return *surest, solves
        return *surest, solves

    def _rated(
        self, build: Build, stone: Stone, places: Sequence[tuple[int, Resting]]
    ) -> list[_RatedPlace]:
        """Compare some places by cost and LLC: the first, as far as one may be the best."""
        laying, number = self.laying, self.yard.workshop.next_wedge(build)
        rated: list[_RatedPlace] = []
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
            rated.append(_RatedPlace(place, spot, blocks, loaded, cost))
            best, standing = min(best, cost), standing + (llc > 0.0)
        return rated


def _seen_from(side: Side, left: float, right: float, width: float) -> tuple[float, float]:
    """Return the left and right end of a stone as a side of the wall sees them."""
    return (left, right) if side == "left" else (width - right, width - left)
