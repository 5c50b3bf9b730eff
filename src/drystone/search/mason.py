"""Laying a course plan, stone by stone.

A plan knows height profiles only.  Here each stone is let go near its planned place, pushed to the
neighbour on its side of the course, and of all places where it rests one is taken that is near the
plan, keeps the course's width, and leaves a wall that stands.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import attrgetter

from drystone.kernels.raster import wrap_deg
from drystone.model.landscape import Landscape
from drystone.model.outlines import Outlined
from drystone.model.placement import Side
from drystone.model.stone import Stone
from drystone.planner.build import Build, Candidate, Proposal, Solves
from drystone.planner.evaluate import Evaluator, Loaded, trouble
from drystone.planner.search_settings import LayingSettings
from drystone.search.courses import CoursePlan, PlannedStone
from drystone.search.letting_go import Aim, Hand, Resting
from drystone.search.yard import Yard
from drystone.settle.placing import settled_in

SIDES: tuple[Side, ...] = ("left", "right")


def lay(
    plan: CoursePlan, build: Build, yard: Yard, laying: LayingSettings | None = None
) -> tuple[list[Build], Solves]:
    """Lay a course plan on what is built; stones that are in the wall already are passed over.

    Return the states before the first course and after each, and the trouble with all places.
    """
    mason = Mason.of(yard, laying or yard.settings.laying)
    states = [build]
    for course in plan.courses:
        states.append(mason.course(states[-1], course))
    return states, sum(mason.troubles, Solves())


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
    troubles: list[Solves] = field(default_factory=list)  # with the places that were judged

    @classmethod
    def of(cls, yard: Yard, laying: LayingSettings) -> "Mason":
        """Return one who lays by the settings of a yard."""
        workshop, settings = yard.workshop, yard.settings
        hand = Hand(laying, settings.settle, workshop.limits, settings.stabilise.method)
        evaluator = Evaluator(settings, workshop.stock, until=yard.until)
        return cls(yard, laying, hand, evaluator)

    def course(self, build: Build, course: Sequence[PlannedStone]) -> Build:
        """Lay the stones of a course in their order."""
        width_px = self.yard.workshop.site.extent_px[0]
        # Of each side, as it sees them: the planned right end of the stone that was planned last,
        # and the right end of the one that was laid last.
        planned, reached = dict.fromkeys(SIDES, 0.0), dict.fromkeys(SIDES, 0.0)
        left_out = []
        for stone in course:
            side = stone.side
            left, right = _seen_from(side, stone.left_px, stone.right_px, width_px)
            # As far from its neighbour as planned, but no further in than planned.
            aim = min(left, reached[side] + left - planned[side])
            action = self._laid(build, stone, side, aim)
            planned[side] = right
            if action is None:
                left_out.append(stone)
                continue
            build = build.add(action, keep=True)
            x_px = action.stabilised.placement.exact.corners[:, 0].tolist()
            _, reached[side] = _seen_from(side, min(x_px), max(x_px), width_px)
        # What could not be laid is tried anywhere in its course, from its own side first.
        for stone in left_out:
            for side in sorted(SIDES, key=lambda side: side != stone.side):
                action = self._laid(build, stone, side, None)
                if action is not None:
                    build = build.add(action, keep=True)
                    break
        return build

    def _laid(
        self, build: Build, planned: PlannedStone, side: Side, left: float | None
    ) -> Candidate | None:
        """Choose how a stone is laid, with its left end near a place of the view or anywhere.

        None where it is in the wall already or cannot be laid.
        """
        workshop, surest = self.yard.workshop, None
        if planned.stone_id not in workshop.remaining(build):
            return None
        site, column_px = workshop.site, self.laying.column_px
        columns = math.ceil(site.extent_px[0] / column_px)  # with one for the last piece
        polygons, mu = build.wall.exact.polygons, self.yard.settings.mu
        view = workshop.views.of(polygons, side, mu, columns, column_px)
        unit_px = workshop.stock.mean_height_px / site.scale
        highest_px = site.extent_px[1] + self.yard.settings.settle.beyond_px
        stone, least = workshop.stones.by_id(planned.stone_id), math.inf
        for half_deg in (0.0, 180.0):
            angle_deg = wrap_deg(planned.angle_deg + half_deg)
            turned = workshop.outlines.hung(stone, angle_deg, side).turned
            aim = Aim(left, planned.top_px, angle_deg, highest_px, unit_px)
            resting = self.hand.resting(turned, view, aim, self.hand.starts(turned, view, aim))
            least, action = self._surest(build, stone, angle_deg, side, resting, least)
            surest = action or surest
            if not least:
                break
        return surest

    def _surest(
        self, build: Build, stone: Stone, angle_deg: float, side: Side,
        resting: Sequence[Resting], least: float,
    ) -> tuple[float, Candidate | None]:  # fmt: skip
        """Compare the cheapest places after which the wall stands.

        Return one of them, and in which share of the trials something falls there: the best where
        nothing does, else that of the least share, if it is below `least`.
        """
        surest: tuple[float, Candidate | None] = least, None
        places, seats = list(enumerate(resting[: self.laying.judged])), self.yard.workshop.seats
        while places:
            rated = self._rated(build, stone, places)
            places = places[len(rated) :]
            self.troubles.extend(trouble(one.loaded) for one in rated)
            # What stands is asked of the best of them first: most often it does.
            for one in sorted(rated, key=attrgetter("cost")):
                if one.cost == math.inf:
                    break
                sturdy = self.evaluator.sturdily(build, one.blocks)
                self.troubles.append(trouble(one.loaded, sturdy) - trouble(one.loaded))
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
                    return surest
        return surest

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
