"""Course plans laid on outlines: as planned where that is possible, and the truth where not."""

from dataclasses import replace
from itertools import chain

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.planner.evaluate import Evaluator, Loaded
from drystone.planner.search_settings import LayingSettings
from drystone.planner.seats import Seats
from drystone.statics.incremental import IncrementalResult
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Block, RigidBlockModel
from tests.planner.scenes import blocks, stones_of_masks
from tests.search.yards import Plot


def statuses(laid):
    return [[one.status for one in course] for course in laid.courses]


def corners_of(laid):
    return dict(laid.build.wall.exact.blocks)


def boxes(laid):
    return {
        block: [*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist()]
        for block, corners in corners_of(laid).items()
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
    assert statuses(laid) == [["as planned"] * 3, ["as planned"] * 4]
    stones = [one.stone for one in chain(*laid.courses)]
    assert [one.stone_id for one in stones] == [1, 2, 3, 4, 5, 7, 6]
    for one in stones:
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
    assert statuses(lay_bond(bricks(height=19))) == [["as planned"] * 3, ["no rest"] * 4]


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
    assert statuses(laid) == [["no place", "as planned", "as planned"]]
    assert boxes(laid)[2][0] == pytest.approx(0.0, abs=0.3)
    assert boxes(laid)[3][0] == pytest.approx(20.0, abs=0.3)


OVERHANG = {1: (22, 10), 2: (40, 10), 3: (50, 20), 4: (28, 20), 5: (10, 10)}
"""A support, a stone that stands out over it, stones that would tip it over, a narrow support."""


def test_what_cannot_be_laid_is_told():
    plot = Plot(blocks(OVERHANG), Site(50, 40))
    place = plot.planned
    walls = {
        # Without room; far beside the only stone that could carry it; and too much of a load.
        "no place": ([place(4, 0, 0), place(1, 28, 0), place(5, 40, 0, "right")],),
        "no rest": ([place(5, 0, 0)], [place(2, 0, 10)]),
        "falls": ([place(1, 0, 0)], [place(2, 0, 10)], [place(3, 0, 20)]),
    }
    for why, courses in walls.items():
        laid = plot.lay(*courses)
        told = [*chain(*statuses(laid))]
        assert told == ["as planned"] * (len(told) - 1) + [why]
        assert len(laid.build.actions) == len(corners_of(laid)) == len(told) - 1
    used = plot.lay([place(1, 0, 0)], [place(1, 25, 0)])
    assert statuses(used) == [["as planned"], ["used"]]


def test_what_cannot_be_laid_in_its_turn_is_laid_elsewhere_in_its_course():
    plot = Plot(blocks(OVERHANG), Site(50, 40), {"settle": {"margin": 0.2, "trials": 0}})
    laid = plot.lay(
        [plot.planned(1, 0, 0)], [plot.planned(2, 0, 10)], [plot.planned(4, 22, 20)],
        laying=LayingSettings(reach=0.05),
    )  # fmt: skip
    assert statuses(laid) == [["as planned"], ["as planned"], ["elsewhere"]]
    assert boxes(laid)[4][0] < 15.0
    # From the left the first place that comes to mind is at the end that tips over.
    laid = plot.lay(
        [plot.planned(1, 28, 0, "right")], [plot.planned(2, 10, 10, "right")],
        [plot.planned(4, 10, 20)], laying=LayingSettings(reach=0.05, starts=1),
    )  # fmt: skip
    assert statuses(laid) == [["as planned"], ["as planned"], ["elsewhere"]]
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
    assert statuses(laid) == [["as planned"]]
    assert len(asked) == 2
    assert boxes(laid)[1][0] == pytest.approx(asked[1])
    assert asked[0] != pytest.approx(asked[1], abs=1.0)


@pytest.mark.parametrize(
    ("shares", "taken", "status"),
    [
        ([0.0], 0, "as planned"),
        ([0.5, 0.0], 1, "as planned"),
        ([0.5, 0.2, 0.3], 1, "as planned"),
        ([None, 0.6], 1, "as planned"),
        ([0.9, 0.9, 0.9, 0.9, 0.9, 0.1], 5, "half turn"),
        ([None] * 99, None, "falls"),
    ],
)
def test_of_places_that_stand_the_one_that_falls_least_is_taken(monkeypatch, shares, taken, status):
    asked = []

    def falls(_, group, wall, least):
        assert not wall.groups
        asked.append(float(group.placement.exact.corners[:, 0].min()))
        share = shares[len(asked) - 1] if len(asked) <= len(shares) else 0.7
        return share if share is not None and share < least else None

    monkeypatch.setattr(Seats, "falls", falls)
    plot = bricks()
    laid = plot.lay([plot.planned(1, 10, 0)], laying=LayingSettings(apart=0.1, enough=4))
    assert statuses(laid) == [[status]]
    if taken is None:
        assert not laid.build.actions
    else:
        assert boxes(laid)[1][0] == pytest.approx(asked[taken])
    if shares[-1] == 0.0:  # what is sure is taken at once
        assert len(asked) == len(shares)


def test_a_stone_on_its_tip_is_turned_by_half():
    plot = Plot(stones_of_masks({1: np.ones((12, 24), bool), 2: TIP}), Site(60, 30))
    laid = plot.lay([plot.planned(1, 0, 0), plot.planned(2, 24, 0)])
    assert statuses(laid) == [["as planned", "half turn"]]
    angle = laid.build.actions[1].stabilised.placement.posed.angle_deg
    assert abs(angle) == pytest.approx(180.0, abs=1.0)
    half = plot.lay([plot.planned(1, 0, 0), plot.planned(2, 24, 0, angle=-180.0)])
    assert statuses(half) == [["as planned", "as planned"]]


def test_a_stone_that_does_not_rest_is_wedged():
    stones, site = blocks({1: (10, 10), 2: (10, 8), 3: (30, 10)}), Site(38, 30)
    for method, status, wedges in (("wedge", "as planned", [(3, 4)]), ("none", "no rest", [])):
        plot = Plot(stones, site, {"stabilise": {"method": method}, "settle": {"trials": 0}})
        laid = plot.lay([plot.planned(1, 0, 0), plot.planned(2, 20, 0)], [plot.planned(3, 0, 10)])
        assert statuses(laid)[1] == [status]
        assert [(wedge.under, wedge.id) for wedge in laid.build.wall.wedges] == wedges


def test_a_stone_goes_where_the_wall_resists_more():
    settings = {"settle": {"trials": 0}}
    plot = Plot(blocks({1: (22, 10), 2: (40, 10), 3: (12, 10)}), Site(50, 40), settings)
    free = LayingSettings(
        starts=30, enough=99, reach=3.0, width=0.0, top=0.0, turn=0.0, rest=0.0, judged=30
    )
    below = [plot.planned(1, 0, 0)], [plot.planned(2, 0, 10)]
    walls = [
        plot.lay(*below, [plot.planned(3, 28, 20, "right")], laying=laying)
        for laying in (
            replace(free, llc=0.0, analysed=30),
            replace(free, llc=1.0, analysed=30),
            replace(free, llc=1.0, analysed=1),
        )
    ]
    assert [statuses(wall)[2] for wall in walls] == [["as planned"]] * 3
    cheapest, strongest, first = (wall.build.actions[-1] for wall in walls)
    assert (strongest.indices.LLC or 0.0) > 1.2 * (cheapest.indices.LLC or 0.0)
    # Further in over what carries it.
    assert boxes(walls[1])[3][2] < boxes(walls[0])[3][2] - 1.0
    assert first.resistance.value == cheapest.resistance.value
