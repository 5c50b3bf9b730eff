"""Letting single stones go: how that ends, and what rules do."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import mirrored_polygon, no_polygons, polygon_edges
from drystone.kernels.settling import Status, rest_margin, settle
from tests.kernels.heaps import WIDTH, drops, rules
from tests.naive.settling import placed
from tests.polygons import box_about as box
from tests.polygons import centred
from tests.polygons import moved as at
from tests.strategies import repeatable

BRICK = box(20.0, 10.0)


def let_go(outline, pose, others=(), width=200.0, **changes):
    around = no_polygons().added(list(others))
    return settle(outline, polygon_edges(outline), pose, around, width, rules(15.0, **changes))


def test_it_does_not_move_aside_without_a_reason():
    found = let_go(BRICK, (50.0, 30.0, 0.0), lean=0.0)
    assert (found.x, found.angle) == (50.0, 0.0)
    # Steps grow from .6 to 1.2 on the way.
    assert 20 <= found.steps <= 28


def test_what_overlaps_comes_apart_or_is_soon_given_up():
    how = {"lean": 0.0, "near": 0.1, "far": 0.4, "overlap": 0.8}
    for room, status, steps in ((20.5, Status.RESTS, 30), (19.6, Status.OVERLAPS, 12)):
        beside = [at(box(20.0, 40.0), x, 10.0) for x in (40.0, 60.0 + room)]
        found = let_go(BRICK, (60.2 + room - 19.6, 5.1, 0.0), beside, **how)
        assert found.status == status
        assert found.steps <= steps


def test_ends_of_the_wall_block_but_carry_nothing():
    found = let_go(BRICK, (12.0, 12.0, 0.0))
    assert found.status == Status.RESTS
    assert found.x == pytest.approx(10.01, abs=1e-6)
    assert found.touching == 2
    # Held by the two ends alone it would not rest.
    wedged = let_go(BRICK, (10.01, 30.0, 0.0), width=20.02, steps=1, lean=0.0)
    assert wedged.status == Status.UNFINISHED
    assert wedged.touching == 0
    # A ladder against an end slides however steep it is, since it cannot push off.
    ladder = box(40.0, 1.0)
    angle = math.radians(80.0)
    x, y = (float(-placed(ladder, (0.0, 0.0, angle))[:, k].min() + 0.01) for k in (0, 1))
    assert let_go(ladder, (x, y, angle), steps=1, stop=0.0).margin == -1.0


def test_statuses():
    low = at(BRICK, 50.0, 5.01)
    # Gone too far aside, or turned too far.
    assert let_go(BRICK, (61.0, 20.0, 0.0), [low], turn=0.3).status == Status.FAR
    assert let_go(BRICK, (120.0, 20.0, 0.3), turn=0.1).status == Status.FAR
    assert let_go(BRICK, (120.0, 6.0, 0.0), shift=0.5).status == Status.FAR
    # Not there yet.
    far_above = let_go(BRICK, (50.0, 150.0, 0.0), steps=5)
    assert (far_above.status, far_above.steps) == (Status.UNFINISHED, 5)
    # On a corner with nothing beside it, it may not turn.
    tip = np.array([[50.0, 20.0], [40.0, 0.0], [60.0, 0.0]])
    found = let_go(BRICK, (52.0, 30.0, 0.0), [tip], turns=False, lean=0.0)
    assert (found.status, found.margin, found.touching) == (Status.FALLS, -1.0, 1)
    # Over another, and only a little.
    assert let_go(BRICK, (55.0, 12.0, 0.0), [low]).status == Status.OVERLAPS
    assert let_go(BRICK, (50.0, 5.0, 0.0), [low]).status == Status.OVERLAPS
    found = let_go(BRICK, (52.0, 14.7, 0.0), [low], lean=0.0)
    assert found.status == Status.RESTS
    assert found[1:4] == pytest.approx((52.0, 15.02, 0.0), abs=1e-6)


def test_a_bar_across_another_overlaps_although_no_corner_is_near():
    lying, standing = box(60.0, 2.0), at(box(2.0, 60.0), 50.0, 31.0)
    found = let_go(lying, (50.0, 31.0, 0.0), [standing], lean=0.0)
    assert found.status == Status.OVERLAPS
    inside = let_go(box(4.0, 4.0), (50.0, 50.0, 0.0), [at(box(60.0, 60.0), 50.0, 50.0)])
    assert inside.status == Status.OVERLAPS


def test_it_stops_where_it_rests_firmly_enough():
    slope = np.array([[0.0, 0.0], [100.0, 0.0], [0.0, 30.0]])
    down = math.atan2(-30.0, 100.0)
    x, y = 40.0, 18.0 + 5.03 / math.cos(down)
    freely = let_go(BRICK, (x, y, down), [slope], lean=0.0)
    assert freely.status == Status.FAR
    stopped = let_go(BRICK, (x, y, down), [slope], lean=0.0, stop=0.0)
    assert (stopped.status, stopped.steps) == (Status.RESTS, 0)
    # What friction leaves when the slope is taken off it.
    left = math.tan(math.atan(0.58) - math.atan(0.3)) / 0.58
    assert stopped.margin == pytest.approx(left, abs=1e-9)
    for stop, status in ((left - 1e-6, Status.RESTS), (left + 1e-6, Status.FAR)):
        assert let_go(BRICK, (x, y, down), [slope], lean=0.0, stop=stop).status == status


def test_what_sticks_rolls_about_its_supporting_corner():
    low = at(BRICK, 50.0, 5.01)
    corner = np.array([60.0, 10.01])
    start = (61.0, 15.0101, 0.0)
    how = {"lean": 0.0, "turn": 0.3, "clearance": 1e-4, "corner": 1e-3}
    for sticks in (True, False):
        found = let_go(BRICK, start, [low], sticks=sticks, **how)
        assert found.status == Status.FAR
        # Where the corner was on the brick, and where it is now.
        there = placed(np.array([[-1.0, -5.0], [0.0, 0.0], [0.0, 1.0]]), found[1:4])[0]
        assert (math.dist(there, corner) < 0.3) == sticks


def test_of_two_supports_the_one_nearer_to_the_centroid_sticks():
    # An arm on the left lies higher up: rolling about the one moves the other aside.
    arm = np.array([[-6, -5], [10, -5], [10, 5], [-10, 5], [-10, 3], [-6, 3]], dtype=np.float64)
    stone = centred(arm)
    x, y = stone[1] - arm[1]
    supports = [at(box(4.0, 5.0), 46.0 + x, 12.49 + y), at(box(2.0, 4.0), 41.0 + x, 20.99 + y)]
    found = let_go(stone, (50.0, 20.0, 0.0), supports, lean=0.0, sticks=True, steps=1, corner=0.01)
    assert found.angle < -0.01
    # Where the stone stood on them, before and after.
    for away, sticks in ((at(stone, 4.0, 0.0)[0], True), (at(stone, 2.0, 0.0)[4], False)):
        moved = found.x + math.cos(found.angle) * away[0] - math.sin(found.angle) * away[1]
        assert (abs(moved - (50.0 + away[0])) < 0.02) == sticks


def margin(outline, x, y, others=(), mu=0.58):
    """That of an outline somewhere in a wall 200 wide."""
    around = no_polygons().added(list(others))
    return rest_margin(at(outline, x, y), (x, y), around, 200.0, mu, 0.1)


def test_margins_are_those_of_statics():
    # A pillar tips, a slab slides.
    slab, cube = box(40.0, 10.0), box(10.0, 10.0)
    assert margin(box(10.0, 40.0), 50.0, 20.0) == pytest.approx(0.25 / 0.58)
    assert margin(slab, 50.0, 5.0) == pytest.approx(1.0)
    # Held by a stone on either side it can only rise.
    assert margin(slab, 50.0, 5.0, [at(cube, 24.95, 5.0), at(cube, 75.05, 5.0)]) > 1.0
    assert margin(slab, 50.0, 5.2) == -1.0
    # Corners that pass each other carry nothing although faces would part them.
    low = [at(cube, 24.8, 5.0), at(cube, 74.0, 5.0)]
    assert margin(slab, 50.0, 15.05, low) == -1.0
    assert margin(slab, 49.82, 15.05, low) > 0.0


@repeatable(15)
@given(st.integers(0, 2**32 - 1))
def test_mirrored_scenes_settle_to_mirror_images(seed):
    for drop, found in drops(seed, 10):
        if drop.rules.lean or found.status != Status.RESTS:
            continue
        size = drop.rules.near / 0.04
        outline = mirrored_polygon(drop.outline, 0.0)
        pose = (WIDTH - drop.pose[0], drop.pose[1], 0.0)
        image = drop._replace(outline=outline, pose=pose, around=drop.around.mirrored(WIDTH))
        seen = image.settled()
        mirrored = (WIDTH - seen.x, seen.y, -seen.angle)
        assert mirrored == pytest.approx(found[1:4], abs=1e-6 * size)


def test_what_is_not_a_number_does_not_rest():
    for pose in ((math.nan, 9.0, 0.0), (50.0, math.nan, 0.0), (50.0, 9.0, math.nan)):
        assert let_go(BRICK, pose).status != Status.RESTS


@pytest.mark.parametrize("mu", [0.0, -0.5, math.nan])
def test_without_friction_there_is_no_margin(mu):
    with pytest.raises(ValueError, match="mu must be positive"):
        margin(BRICK, 50.0, 5.02, mu=mu)
    with pytest.raises(ValueError, match="mu must be positive"):
        let_go(BRICK, (50.0, 9.0, 0.0), mu=mu)
