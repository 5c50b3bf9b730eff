"""Course plans laid on outlines: as planned where that is possible, and the truth where not."""

import math
from dataclasses import replace
from itertools import chain
from types import SimpleNamespace

import numpy as np
import pytest
import shapely

from drystone import Planner, Site, lateral_resistance
from drystone.kernels.polygons import turn
from drystone.kernels.profiles import hanging
from drystone.kernels.raster import wrap_deg
from drystone.planner.evaluate import Evaluator, Loaded
from drystone.planner.search_settings import LayingSettings
from drystone.planner.seats import Seats
from drystone.planner.views import Views
from drystone.planner.workshop import Workshop
from drystone.search.courses import CoursePlan, PlannedStone
from drystone.search.letting_go import Aim, Hand
from drystone.search.mason import lay
from drystone.search.yard import Yard
from drystone.settle.rest import Turned
from drystone.settle.wedge import wedged
from drystone.statics.incremental import IncrementalResult
from drystone.statics.model import Block, RigidBlockModel
from tests.planner import scenes
from tests.planner.scenes import blocks


class Plot:
    """A yard, and course plans for it."""

    def __init__(self, stones, site, changes=None):
        settings = scenes.greedy(changes)
        self.yard = Yard(Workshop.prepare(stones, site, settings), settings)

    def planned(self, stone_id, left, bottom, side="left", angle=0.0, top=None):
        outlines, stones = self.yard.workshop.outlines, self.yard.workshop.stones
        corners = turn(outlines.outline(stones.by_id(stone_id)), angle)
        low, high = corners.min(axis=0), corners.max(axis=0)
        y = bottom - low[1]
        return PlannedStone(
            stone_id, angle, side, left - low[0], y, left, left + high[0] - low[0],
            y + high[1] if top is None else top,
        )  # fmt: skip

    def lay(self, *courses, laying=None):
        plan = CoursePlan(tuple(map(tuple, courses)), 0.0)
        states, _ = lay(plan, self.yard.planner().build, self.yard, laying)
        return SimpleNamespace(plan=plan, states=states, build=states[-1])


def turns(laid):
    """Return by how much each stone is turned from its plan; None for those that are not laid."""
    posed = {p.stone_id: p.posed.angle_deg for p in laid.build.wall.placements}

    def turn_of(stone):
        if stone.stone_id in posed:
            return 180 * round(abs(wrap_deg(posed[stone.stone_id] - stone.angle_deg)) / 180)
        return None

    return [[turn_of(stone) for stone in course] for course in laid.plan.courses]


def boxes(laid):
    return {
        block: [*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist()]
        for block, corners in laid.build.wall.exact.blocks
    }


BRICKS = {1: (20, 10), 2: (20, 10), 3: (20, 10), 4: (10, 10), 5: (20, 10), 6: (20, 10), 7: (10, 10)}
"""A course of three stones, and one of two with a half at each end."""


def bricks(width=60, height=20):
    # Errors are not asked: what closes a course of bricks has no room to spare.
    return Plot(blocks(BRICKS), Site(width, height), {"settle": {"trials": 0}})


def lay_bond(plot):
    place = plot.planned
    return plot.lay(
        [place(1, 0, 0), place(2, 20, 0), place(3, 40, 0, "right")],
        [place(4, 0, 10), place(5, 10, 10), place(7, 50, 10, "right"), place(6, 30, 10, "right")],
    )


def test_bricks_lie_as_planned():
    laid = lay_bond(bricks())
    assert turns(laid) == [[0] * 3, [0] * 4]
    for one in chain(*laid.plan.courses):
        box = boxes(laid)[one.stone_id]
        assert box[0] == pytest.approx(one.left_px, abs=0.3)
        assert box[2] == pytest.approx(one.right_px, abs=0.3)
        assert box[3] == pytest.approx(one.top_px, abs=0.05)
    assert [len(state.actions) for state in laid.states] == [0, 3, 7]
    assert [action.side for action in laid.build.actions] == [
        *("left", "left", "right", "left", "left", "right", "right")
    ]
    assert all(action.proposal.trial_angle_deg == 0.0 for action in laid.build.actions)
    # What would stand out above the wall is not laid.
    assert turns(lay_bond(bricks(height=19))) == [[0] * 3, [None] * 4]


def test_a_stone_is_pushed_to_its_neighbour_from_either_side():
    # One stone less, or which stones are pushed against each other depends on the side.
    plot = bricks(64)
    # The plan leaves 2 px between them; the stone comes to rest against the first.
    sides = {"left": (0, 22), "right": (44, 22)}
    left, right = (
        boxes(plot.lay([plot.planned(k, x, 0, side) for k, x in enumerate(lefts, 1)]))
        for side, lefts in sides.items()
    )
    assert left[2][0] - left[1][2] < 0.1
    for stone_id, box in left.items():
        mirrored = [64 - box[2], box[1], 64 - box[0], box[3]]
        assert right[stone_id] == pytest.approx(mirrored, abs=1e-5)


def test_a_course_closes_up_where_a_stone_is_left_out():
    plot = bricks()
    low = plot.planned(1, 0, 0, top=2)
    laid = plot.lay([low, plot.planned(2, 20, 0), plot.planned(3, 40, 0)])
    assert turns(laid) == [[None, 0, 0]]
    assert boxes(laid)[2][0] == pytest.approx(0.0, abs=0.3)
    assert boxes(laid)[3][0] == pytest.approx(20.0, abs=0.3)


OVERHANG = {1: (22, 10), 2: (40, 10), 3: (50, 20), 4: (28, 20), 5: (10, 10)}
"""A support, a stone that stands out over it, stones that would tip it over, a narrow support."""


def test_what_cannot_be_laid_is_left_out():
    plot = Plot(blocks(OVERHANG), Site(50, 40), {"settle": {"trials": 0}})
    place = plot.planned
    walls = [
        # Without room; far beside the only stone that could carry it; and too much of a load.
        ([place(4, 0, 0), place(1, 28, 0), place(5, 40, 0, "right")],),
        ([place(5, 0, 0)], [place(2, 0, 10)]),
        ([place(1, 0, 0)], [place(2, 0, 10)], [place(3, 0, 20)]),
    ]
    for courses in walls:
        laid = plot.lay(*courses)
        told = [*chain(*turns(laid))]
        assert told == [0] * (len(told) - 1) + [None]
        assert len(laid.build.actions) == len(boxes(laid)) == len(told) - 1
    again = plot.lay([place(1, 0, 0)], [place(1, 25, 0)])
    assert len(again.build.actions) == 1
    assert boxes(again)[1][0] == pytest.approx(0.0, abs=0.3)


def test_what_cannot_be_laid_in_its_turn_is_laid_elsewhere_in_its_course():
    plot = Plot(blocks(OVERHANG), Site(50, 40), {"settle": {"margin": 0.2, "trials": 0}})
    laid = plot.lay(
        [plot.planned(1, 0, 0)], [plot.planned(2, 0, 10)], [plot.planned(4, 22, 20)],
        laying=LayingSettings(reach=0.05),
    )  # fmt: skip
    assert turns(laid) == [[0], [0], [0]]
    assert boxes(laid)[4][0] < 15.0
    assert laid.build.actions[-1].side == "left"
    # From the left the first place that comes to mind is at the end that tips over.
    laid = plot.lay(
        [plot.planned(1, 28, 0, "right")], [plot.planned(2, 10, 10, "right")],
        [plot.planned(4, 10, 20)], laying=LayingSettings(reach=0.05, starts=1),
    )  # fmt: skip
    assert turns(laid) == [[0], [0], [0]]
    assert laid.build.actions[-1].side == "right"
    assert boxes(laid)[4][2] == pytest.approx(50.0, abs=0.3)


TIP = np.array([[abs(x - 11.5) <= 12 - row for x in range(24)] for row in range(12)])
"""A triangle on its tip."""

FALLING = RigidBlockModel((), (), 0.0).with_added((Block(9, 1.0, (0.0, 5.0)),), ())
"""Nothing is below its block."""

FALLEN = Loaded(FALLING, IncrementalResult(lateral_resistance(FALLING)))


def test_of_places_that_do_not_stand_sturdily_the_next_best_is_taken(monkeypatch):
    sturdily, asked = Evaluator.sturdily, []

    def not_at_once(this, build, blocks):
        asked.append(float(blocks[0][1][:, 0].min()))
        return FALLEN if len(asked) == 1 else sturdily(this, build, blocks)

    monkeypatch.setattr(Evaluator, "sturdily", not_at_once)
    plot = bricks()
    many = LayingSettings(apart=0.1, enough=9)
    laid = plot.lay([plot.planned(1, 10, 0)], laying=many)
    assert turns(laid) == [[0]]
    assert len(asked) == 2
    assert boxes(laid)[1][0] == pytest.approx(asked[1])
    assert asked[0] != pytest.approx(asked[1], abs=1.0)


@pytest.mark.parametrize(
    ("shares", "taken", "turned"),
    [
        ([0.0], 0, 0),
        ([0.5, 0.0], 1, 0),
        ([0.5, 0.2, 0.3], 1, 0),
        ([None, 0.6], 1, 0),
        ([0.9, 0.9, 0.9, 0.9, 0.9, 0.1], 5, 180),
        ([None] * 99, None, None),
    ],
)
def test_of_places_that_stand_the_one_that_falls_least_is_taken(monkeypatch, shares, taken, turned):
    asked = []

    def falls(_, group, wall, least):
        assert not wall.groups
        asked.append(float(group.placement.exact.corners[:, 0].min()))
        share = shares[len(asked) - 1] if len(asked) <= len(shares) else 0.7
        return share if share is not None and share < least else None

    monkeypatch.setattr(Seats, "falls", falls)
    plot = bricks()
    laid = plot.lay([plot.planned(1, 10, 0)], laying=LayingSettings(apart=0.1, enough=4))
    assert turns(laid) == [[turned]]
    if taken is None:
        assert not laid.build.actions
    else:
        assert boxes(laid)[1][0] == pytest.approx(asked[taken])
    if shares[-1] == 0.0:  # what is sure is taken at once
        assert len(asked) == len(shares)


def test_a_stone_on_its_tip_is_turned_by_half():
    plot = Plot(scenes.stones_of_masks({1: np.ones((12, 24), bool), 2: TIP}), Site(60, 30))
    laid = plot.lay([plot.planned(1, 0, 0), plot.planned(2, 24, 0)])
    assert turns(laid) == [[0, 180]]
    angle = laid.build.actions[1].stabilised.placement.posed.angle_deg
    assert abs(angle) == pytest.approx(180.0, abs=1.0)
    half = plot.lay([plot.planned(1, 0, 0), plot.planned(2, 24, 0, angle=-180.0)])
    assert turns(half) == [[0, 0]]


def test_a_stone_that_does_not_rest_is_wedged():
    stones, site = blocks({1: (10, 10), 2: (10, 8), 3: (30, 10)}), Site(38, 30)
    for method, turned, wedges in (("wedge", 0, [(3, 4)]), ("none", None, [])):
        plot = Plot(stones, site, {"stabilise": {"method": method}, "settle": {"trials": 0}})
        laid = plot.lay([plot.planned(1, 0, 0), plot.planned(2, 20, 0)], [plot.planned(3, 0, 10)])
        assert turns(laid)[1] == [turned]
        assert [(wedge.under, wedge.id) for wedge in laid.build.wall.wedges] == wedges


def test_a_stone_goes_where_the_wall_resists_more():
    settings = {"settle": {"trials": 0}}
    plot = Plot(blocks({1: (22, 10), 2: (40, 10), 3: (12, 10)}), Site(50, 40), settings)
    nothing = dict.fromkeys(("width", "top", "turn", "rest"), 0.0)
    free = LayingSettings(starts=30, enough=99, reach=3.0, **nothing, judged=30)
    courses = [plot.planned(1, 0, 0)], [plot.planned(2, 0, 10)], [plot.planned(3, 28, 20, "right")]
    walls = [
        plot.lay(*courses, laying=replace(free, llc=llc, analysed=analysed))
        for llc, analysed in ((0.0, 30), (1.0, 30), (1.0, 1))
    ]
    assert [turns(wall)[2] for wall in walls] == [[0]] * 3
    cheapest, strongest, first = (wall.build.actions[-1] for wall in walls)
    assert strongest.indices.LLC > 1.2 * cheapest.indices.LLC
    # Further in over what carries it.
    assert boxes(walls[1])[3][2] < boxes(walls[0])[3][2] - 1.0
    assert first.resistance.value == cheapest.resistance.value


class Drop:
    """A stone of some rubble over four others."""

    def __init__(self, side, laying, seed=1):
        settings = scenes.greedy({"settle": {"margin": 0.2}})
        one = scenes.finish(Planner(scenes.rubble(seed), scenes.RUBBLE_SITE, settings=settings), 4)
        yard, outlines = Yard.of(one), one.build.wall.outlines
        self.view = Views(100.0).of(outlines.polygons, side, 0.58, 100, 1.0)
        stone = next(s for s in one.workshop.stones if s.id not in dict(outlines.blocks))
        outline = one.workshop.outlines.outline(stone)
        self.stone = Turned.of(outline, 0.0, side, stone.area_px**0.5)
        self.hung = hanging(self.stone.corners, 1.0)
        self.unit_px = one.workshop.stock.mean_height_px
        self.hand = Hand(laying, yard.settings.settle, yard.workshop.limits, "both")

    def lifts(self):
        """Where the stone first touches, column by column."""
        tops, bottoms = self.view.profile.tops.tolist(), self.hung.bottoms.tolist()
        places = range(len(tops) - len(bottoms) + 1)
        return [max(tops[at + k] - b for k, b in enumerate(bottoms)) for at in places]

    def starts(self, left, top):
        return self.hand.starts(self.stone, self.view, Aim(left, top, 0.0, 1e9, self.unit_px))

    def resting(self, left, top, starts=None, highest=1e9):
        starts = self.starts(left, top) if starts is None else starts
        aim = Aim(left, top, 0.0, highest, self.unit_px)
        return self.hand.resting(self.stone, self.view, aim, starts)


def spots(resting):
    return [(one.repose.settled.x_px, one.repose.settled.y_px) for one in resting]


def starts_column_by_column(drop, left, top):
    """On which columns a stone is let go, and how high; wherever that is, or about its place."""
    settings, hung, unit, size = drop.hand.settings, drop.hung, drop.unit_px, drop.stone.size_px
    costs, lifts = {}, [lift + 0.02 for lift in drop.lifts()]
    for at, lift in enumerate(lifts):
        inside = at + hung.right - hung.left <= 100.25
        near = left is None or abs(at - left) <= math.ceil(settings.reach * size)
        if inside and near and lift + hung.top <= top + settings.astray * unit:
            # A left end may be up to a quarter of a height further left than its place.
            lost = 0.0 if left is None else max(0.0, at - left, left - 0.25 * unit - at)
            costs[at] = abs(lift + hung.top - top) + settings.width * lost
    apart, found = size * (settings.spread if left is None else settings.apart), []
    for at in sorted(costs, key=costs.get):
        if all(abs(at - other) >= apart for other in found):
            found.append(at)
    return [(at - hung.left, pytest.approx(lifts[at])) for at in found[: settings.starts]]


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("astray", [0.3, 2.0])
@pytest.mark.parametrize("starts", [4, 100])
@pytest.mark.parametrize("apart", [0.0, 0.1])
def test_stones_are_let_go_where_they_first_touch_the_cheapest_place_first(
    side, astray, starts, apart
):
    drop = Drop(
        side, LayingSettings(starts=starts, apart=apart, spread=4 * apart, reach=0.4, astray=astray)
    )
    lowest, unit, counts = min(drop.lifts()) + drop.hung.top, drop.unit_px, set()
    for left in (30.0, None):
        for top in np.linspace(lowest - 0.4 * unit, lowest + 1.2 * unit, 17).tolist():
            found = drop.starts(left, top)
            assert found == starts_column_by_column(drop, left, top)
            counts.add(len(found))
    assert max(counts) > 1
    assert (0 in counts) == (astray < 0.4)


@pytest.mark.parametrize("name", ["top", "width", "turn", "rest"])
def test_where_a_stone_rests_costs_what_the_settings_say(name):
    plain = LayingSettings(top=0.0, width=0.0, turn=0.0, rest=0.0, astray=5.0, enough=99)
    drop = Drop("right", replace(plain, **{name: 1.0}))
    resting = drop.resting(20.0, 25.0)
    assert resting
    assert [one.cost for one in resting] == sorted(one.cost for one in resting)
    for one in resting:
        box = shapely.Polygon(one.repose.settled.corners).bounds
        aside = 80.0 - box[2]
        expected = {
            "top": abs(box[3] - 25.0) / drop.unit_px,
            "width": max(0.0, aside, -aside - 0.25 * drop.unit_px) / drop.unit_px,
            "turn": abs(one.repose.angle_deg) / 10.0,
            "rest": max(0.0, 1.0 - one.repose.margin),
        }
        assert one.cost == pytest.approx(expected[name], abs=1e-9)
    alike = {
        (*map(round, at), r.repose.angle_deg) for at, r in zip(spots(resting), resting, strict=True)
    }
    assert len(alike) == len(resting)


def test_a_stone_is_let_go_until_it_rests_in_enough_places():
    drop = Drop("left", LayingSettings(astray=5.0, apart=0.2, enough=99))
    starts = drop.starts(None, 25.0)
    of_starts = [{*spots(drop.resting(None, 25.0, starts[: k + 1]))} for k in range(len(starts))]
    assert len(of_starts[-1]) > len(of_starts[0]) >= 1
    for enough in range(1, len(of_starts[-1]) + 1):
        drop.hand = replace(drop.hand, settings=replace(drop.hand.settings, enough=enough))
        first = next(found for found in of_starts if len(found) >= enough)
        assert {*spots(drop.resting(None, 25.0, starts))} == first


def test_a_stone_is_wedged_at_the_cheapest_place_first():
    drop = Drop("left", LayingSettings(astray=5.0, apart=0.1, starts=9), seed=9)
    hand = replace(drop.hand, method="wedge", settle=replace(drop.hand.settle, margin=1.4))
    drop.hand = hand = replace(hand, limits=replace(hand.limits, rest=0.05))
    found, scene = drop.resting(None, 25.0), drop.view.scene
    starts = drop.starts(None, 25.0)
    one_by_one = [wedged(drop.stone, scene, at, hand.settle, hand.limits) for at in starts]
    expected = {
        (round(one[0].settled.x_px), round(one[0].settled.y_px)): one[1].tobytes()
        for one in reversed(one_by_one)
        if one is not None
    }
    assert len(found) == len(expected) > 1
    assert [one.cost for one in found] == sorted(one.cost for one in found)
    for one in found:
        settled = one.repose.settled
        top = float(settled.corners[:, 1].max())
        unsure = hand.settings.rest * max(0.0, 1.0 - one.repose.margin)
        assert one.cost == pytest.approx(abs(top - 25.0) / drop.unit_px + 0.2 + unsure)
        assert one.wedge.tobytes() == expected[round(settled.x_px), round(settled.y_px)]


def test_a_stone_that_rests_above_the_wall_or_far_from_its_top_does_not_count():
    drop = Drop("left", LayingSettings(astray=5.0, enough=99))
    starts = drop.starts(None, 25.0)
    every = drop.resting(None, 25.0, starts)
    tops = sorted(one.repose.settled.corners[:, 1].max() for one in every)
    lower = float(tops[len(tops) // 2])
    assert 0 < len(drop.resting(None, 25.0, starts, highest=lower)) < len(tops)
    drop.hand = replace(drop.hand, settings=replace(drop.hand.settings, astray=0.01))
    found = drop.resting(None, lower, starts)
    assert 0 < len(found) < len(tops)
    for one in found:
        assert one.repose.settled.corners[:, 1].max() == pytest.approx(lower, abs=0.2)
