"""Walls built again as measured: the order, which stones are elsewhere, and which are outside."""

import pytest

from drystone.errors import InputError
from drystone.model.site import Site
from drystone.planner.measured import MeasuredPose
from drystone.planner.planner import Planner
from tests.planner.scenes import blocks, finish, greedy, ids

BOTH = pytest.mark.parametrize(
    "settings", [greedy(), greedy({"geometry": "raster"})], ids=["exact", "raster"]
)


def at(spots):
    return {i: MeasuredPose(x, y, 0.0) for i, (x, y) in spots.items()}


def wall(settings, spots, sizes):
    """A planner whose plan has blocks where they are asked for."""
    one = Planner(blocks({1: (20, 10), 2: (20, 10), **sizes}), Site(60, 60), settings=settings)
    assert one.observe(at(spots)).stands
    assert ids(one) == list(spots)
    return one


def now(one):
    """Where the planner has its stones."""
    height_px = one.workshop.site.height_px
    return at({p.stone_id: p.centroid(height_px) for p in one.build.wall.placements})


LOWER, UPPER = (30.0, 5.0), (30.0, 15.0)
"""Two blocks, 10 px high, one on the other."""


@BOTH
@pytest.mark.parametrize(
    ("planned", "third", "measured", "order"),
    [
        # Without what is put under it the second hangs in the air, or falls to where the third is.
        ((LOWER, UPPER), (20, 10), ((30.0, 5.0), (30.0, 25.0), (30.0, 15.0)), [1, 3, 2]),
        ((LOWER, UPPER), (20, 3), ((30.0, 5.0), (30.0, 18.0), (30.0, 11.5)), [1, 3, 2]),
        # A prop keeps the stone above where it was measured.
        (((24.0, 5.0), (24.0, 15.0)), (10, 10), ((24.0, 5.0), (12.0, 15.0), (7.0, 5.0)), [1, 3, 2]),
        # What is put on top comes after those that were planned, though it lies lower.
        ((LOWER, UPPER), (20, 10), (LOWER, UPPER, (50.0, 5.0)), [1, 2, 3]),
    ],
)
def test_a_stone_that_was_put_there_is_built_in_its_turn(settings, planned, third, measured, order):
    one = wall(settings, dict(enumerate(planned, 1)), {3: third})
    seen = one.observe(at(dict(enumerate(measured, 1))))
    assert (seen.stands, seen.notices, seen.added) == (True, (), (3,))
    assert seen.largest_moved_px < 0.5
    assert ids(one) == order
    assert all(action.stands for action in one.build.actions)
    assert ids(finish(one))[:3] == order


@BOTH
def test_no_order_makes_room_for_two_stones_in_one_place(settings):
    one = wall(settings, {1: LOWER, 2: UPPER}, {3: (20, 10)})
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
    one = wall(settings, {1: LOWER, 2: UPPER}, {})
    seen = one.observe(at({1: (30.3, 5.2), 2: (29.8, 15.9)}))
    assert (seen.stands, seen.notices) == (True, ())
    assert 0.0 < seen.largest_moved_px < 1.4


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
        assert one.observe(at({1: LOWER, 2: UPPER})).stands
        assert ids(one) == [1, 2]
    else:
        with pytest.raises(InputError, match="E198 observe: stone 2"):
            one.observe(at({1: LOWER, 2: UPPER}))


def test_a_stone_longer_than_the_wall_is_not_in_it():
    settings = greedy().updated({"skip_too_large": True})
    one = Planner(blocks({1: (20, 10), 2: (46, 10)}), Site(45, 40), settings=settings)
    with pytest.raises(InputError, match="E198 observe: stone 2"):
        one.observe({2: MeasuredPose(22.0, 5.0, 0.0)})


def test_the_nearest_place_where_the_wall_stands_is_taken():
    # A beam on a post.  A block as heavy as the beam tips it where its centroid is further from
    # the middle than the post is wide: 1800 (d - 15) > 1800 * 15.
    one = Planner(
        blocks({1: (30, 60), 2: (120, 15), 3: (30, 60)}), Site(200, 140), settings=greedy()
    )
    below = {1: (100.0, 30.0), 2: (100.0, 67.5)}
    seen = one.observe(at({**below, 3: (133.0, 105.0)}))
    assert (seen.stands, seen.added) == (True, (1, 2, 3))
    assert 120.0 < now(one)[3].x < 130.0
    # Much further out there is no such place near it.
    far = one.observe(at({**below, 3: (150.0, 105.0)}))
    assert not far.stands
    assert "stones 3." in far.notices[0].message
    assert now(one)[3].x == pytest.approx(150.0, abs=0.5)
