"""Walls built again as measured: the order, which stones are elsewhere, and which are outside."""

import pytest

from drystone.errors import InputError
from drystone.model.site import Site
from drystone.planner.measured import MeasuredPose
from drystone.planner.planner import Planner
from tests.planner.scenes import blocks, greedy

BOTH = pytest.mark.parametrize(
    "settings", [greedy(), greedy({"geometry": "raster"})], ids=["exact", "raster"]
)


def at(spots):
    return {i: MeasuredPose(x, y, 0.0) for i, (x, y) in spots.items()}


def wall(settings, spots, sizes):
    """A planner whose plan has blocks where they are asked for."""
    one = Planner(blocks({1: (20, 10), 2: (20, 10), **sizes}), Site(60, 60), settings=settings)
    assert one.observe(at(spots)).stands
    assert [action.stone_id for action in one.build.actions] == list(spots)
    return one


def now(one):
    """Where the planner has its stones."""
    spots = {p.stone_id: p.centroid(60) for p in one.build.wall.placements}
    return at(spots)


def order(one):
    return [action.stone_id for action in one.build.actions]


@BOTH
@pytest.mark.parametrize("height", [10, 3])
def test_a_stone_put_under_a_planned_one_is_built_before_it(settings, height):
    one = wall(settings, {1: (30.0, 5.0), 2: (30.0, 15.0)}, {3: (20, height)})
    # Without what is under it the second hangs in the air, or falls to where the third is.
    seen = one.observe(at({1: (30.0, 5.0), 2: (30.0, 15.0 + height), 3: (30.0, 10.0 + height / 2)}))
    assert (seen.stands, seen.notices, seen.added) == (True, (), (3,))
    assert order(one) == [1, 3, 2]
    assert all(action.stands for action in one.build.actions)


@BOTH
def test_a_prop_keeps_the_stone_above_where_it_was_measured(settings):
    one = wall(settings, {1: (24.0, 5.0), 2: (24.0, 15.0)}, {3: (10, 10)})
    seen = one.observe(at({1: (24.0, 5.0), 2: (12.0, 15.0), 3: (7.0, 5.0)}))
    assert (seen.stands, seen.notices) == (True, ())
    assert seen.largest_moved_px < 0.5
    assert order(one) == [1, 3, 2]


@BOTH
def test_stones_put_on_top_come_after_those_that_were_planned(settings):
    one = wall(settings, {1: (30.0, 5.0), 2: (30.0, 15.0)}, {3: (20, 10)})
    # Though it lies lower than the second.
    seen = one.observe(at({1: (30.0, 5.0), 2: (30.0, 15.0), 3: (50.0, 5.0)}))
    assert (seen.stands, seen.notices) == (True, ())
    assert order(one) == [1, 2, 3]


@BOTH
def test_no_order_makes_room_for_two_stones_in_one_place(settings):
    one = wall(settings, {1: (30.0, 5.0), 2: (30.0, 15.0)}, {3: (20, 10)})
    before = one.build
    with pytest.raises(InputError, match="E198 observe: stone 3"):
        one.observe(at({1: (30.0, 5.0), 2: (30.0, 15.0), 3: (30.0, 14.0)}))
    assert one.build is before


def test_a_stone_that_would_fall_from_where_it_was_planned_is_named():
    one = wall(greedy(), {1: (12.0, 5.0), 2: (12.0, 15.0)}, {})
    planned = now(one)[2]
    seen = one.observe({**at({1: (24.0, 5.0)}), 2: planned})
    # It would fall off the first; the nearest place where it does not is taken, and said to be.
    assert seen.stands
    assert now(one)[2].x - planned.x == pytest.approx(seen.largest_moved_px, abs=0.01)
    assert 2.0 < seen.largest_moved_px < 3.5
    (notice,) = seen.notices
    assert notice.code == "W127"
    assert "stones 2 are taken" in notice.message


def test_a_stone_that_would_fall_and_has_no_better_place_is_taken_over_as_it_is():
    one = wall(greedy({"geometry": "raster"}), {1: (12.0, 5.0), 2: (12.0, 15.0)}, {})
    planned = now(one)[2]
    seen = one.observe({**at({1: (27.0, 5.0)}), 2: planned})
    assert not seen.stands
    assert [notice.code for notice in seen.notices] == ["W124"]
    assert now(one)[2] == planned


@BOTH
def test_small_moves_are_not_worth_a_word(settings):
    one = wall(settings, {1: (30.0, 5.0), 2: (30.0, 15.0)}, {})
    seen = one.observe(at({1: (30.3, 5.2), 2: (29.8, 15.9)}))
    assert (seen.stands, seen.notices) == (True, ())
    assert 0.0 < seen.largest_moved_px < 1.4


LOWER, UPPER = MeasuredPose(30.0, 5.0, 0.0), MeasuredPose(30.0, 15.0, 0.0)
"""Two blocks, 10 px high, one on the other."""


@pytest.mark.parametrize(
    ("height_px", "scale", "inside"),
    [
        (19.7, 1.0, True), (19.55, 1.0, True), (19.2, 0.5, True),
        (19.4, 1.0, False), (16.0, 1.0, False), (18.4, 0.5, False),
    ],
)  # fmt: skip
def test_half_a_working_px_above_the_top_is_in_the_wall_and_more_is_not(height_px, scale, inside):
    site = Site.from_source(60.0, height_px, scale)
    one = Planner(blocks({1: (20, 10), 2: (20, 10)}), site, settings=greedy())
    if inside:
        assert one.observe({1: LOWER, 2: UPPER}).stands
        assert order(one) == [1, 2]
    else:
        with pytest.raises(InputError, match="E198 observe: stone 2"):
            one.observe({1: LOWER, 2: UPPER})


def test_a_stone_longer_than_the_wall_is_not_in_it():
    settings = greedy().updated({"skip_too_large": True})
    one = Planner(blocks({1: (20, 10), 2: (46, 10)}), Site(45, 40), settings=settings)
    with pytest.raises(InputError, match="E198 observe: stone 2"):
        one.observe({2: MeasuredPose(22.0, 5.0, 0.0)})
