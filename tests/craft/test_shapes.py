"""Stones on end, big stones low, level beds, inward edges, top and ends: one planted fault each."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drystone.craft import Masonry
from drystone.kernels.raster import turn
from drystone.metrics.frame import frame_wall
from drystone.metrics.shape import flush_deviation, level_deviation
from tests.craft.walls import PX, both, box, courses, find, open_joints, painted, running_bond

SEATS = ("seats", "towers", "voids")
SHAPES = ("on_end", "big_low", "level_beds", "inward_edges", "level_top", "flush_ends")


@pytest.mark.parametrize("wall", both(running_bond(4)), ids=["polygons", "labels"])
def test_a_wall_of_bricks_keeps_them_all(wall):
    opened = Masonry(open_joints(running_bond(), 0.1))
    for rule, bricks in (*product(SHAPES + SEATS, [wall]), *product(SEATS, [opened])):
        found = find(rule, bricks)
        assert (found.verdict, found.cases) == ("good", ()), rule
        assert found.number == 0.0 or rule not in SEATS, rule
    assert find("big_low", wall).number == pytest.approx(1.0, abs=0.01)
    assert find("level_top", wall).number == find("flush_ends", wall).number == 0.0


def test_the_one_post_is_named():
    left = courses([[2.0, 2.0], [2.0, 2.0]])
    right = {i + 10: loop + np.array([5, 0]) for i, loop in left.items()}
    for wall in both(left | right | {9: box(4, 0, 1, 2)}):
        found = find("on_end", wall)
        assert [case.stones for case in found.cases] == [(9,)]
        assert (found.number, found.verdict) == (pytest.approx(1 / 9), "fair")
        assert found.cases[0].value == pytest.approx(2.0, abs=0.01)
    # About as long as high: it has no longer side.
    assert find("on_end", Masonry({1: box(0, 0, 1.0, 1.15)})).cases == ()


@settings(max_examples=40)
@given(st.floats(-89.0, 89.0), st.floats(1.3, 4.0))
def test_a_turned_stone_stands_on_end_beyond_45_degrees(angle, length):
    loop = turn(box(-length / 2, -0.5, length, 1.0), angle)
    found = find("on_end", Masonry({1: loop}))
    if abs(abs(angle) - 45.0) > 0.01:
        assert bool(found.cases) == (abs(angle) > 45.0)


def test_a_big_stone_above_mid_height_is_named():
    loops = courses([[2.0] * 4, [2.0] * 4]) | {20: box(0, 2, 4, 2), 21: box(4, 2, 2, 1)}
    found = find("big_low", Masonry(loops))
    assert [case.stones for case in found.cases] == [(20,)]
    # Mid-height is y = 2: eight bricks of 2 below, one of 8 and one of 2 above.
    assert found.number == pytest.approx(5.0 / 2.0)
    assert found.verdict == "broken"
    upside_down = {i: loop * [1, -1] + [0, 4] for i, loop in loops.items()}
    turned = find("big_low", Masonry(upside_down))
    assert (turned.number, turned.cases) == (pytest.approx(2.0 / 5.0), ())


@pytest.mark.parametrize("angle", [5.0, -20.0])
def test_the_slope_of_a_bed_is_its_angle(angle):
    rise = 2.0 * np.tan(np.radians(angle))
    lower = np.array([[2, 0], [4, 0], [4, 1 + rise], [2, 1]])
    upper = np.array([[2, 1], [4, 1 + rise], [4, 3], [2, 3]])
    loops = {1: box(0, 0, 2, 1), 2: lower, 3: box(4, 0, 2, 1), 4: upper}
    found = find("level_beds", Masonry(loops))
    # Two of eight edges, all of one width.
    assert found.number == pytest.approx(abs(angle) / 4.0, abs=1e-6)
    named = {(case.stones, case.words) for case in found.cases}
    side = "left" if angle > 0 else "right"
    steep = {((2,), f"upper edge falls to the {side} by 20°"),
             ((4,), f"lower edge falls to the {side} by 20°")}  # fmt: skip
    assert named == (steep if abs(angle) > 15 else set())


@pytest.mark.parametrize("outward", [True, False])
def test_an_end_that_slopes_outwards_is_named(outward):
    loops = courses([[2.0, 2.0, 2.0]]) | {10: box(2, 1, 2, 1), 11: box(4, 1, 2, 1)}
    low, high = (0.4, 1.0) if outward else (1.0, 0.4)
    loops[9] = np.array([[0, 1], [2, 1], [2, 1 + high], [0, 1 + low]])
    found = find("inward_edges", Masonry(loops))
    assert found.number == pytest.approx(-0.3 if outward else 0.0, abs=1e-6)
    assert found.verdict == ("broken" if outward else "good")
    slope = -0.3 if outward else 0.3
    assert found.figures["mean inward slope"] == pytest.approx(slope / 4, abs=1e-6)
    assert [case.stones for case in found.cases] == [(9,)] * outward
    for case in found.cases:
        assert "at the left end" in case.words
        assert case.value == pytest.approx(0.3, abs=1e-6)


def test_a_tower_and_a_gap_in_the_top_are_named_but_no_open_joint():
    tower = courses([[2.0] * 4]) | {9: box(2, 1, 2, 1)}
    found = find("level_top", Masonry(tower))
    # A quarter is 1 higher: mean |deviation| = 2 * 1/4 * 3/4.
    assert (found.number, found.verdict) == (pytest.approx(0.375), "broken")
    assert [case.stones for case in found.cases] == [(9,)]
    loops = {1: box(0, 0, 2, 1), 2: box(2.1, 0, 2, 1), 3: box(4.2, 0, 2, 1)}
    assert find("level_top", Masonry(loops)).number == 0.0
    wide = {i: loop + np.array([0.4 * i, 0]) for i, loop in loops.items()}
    assert find("level_top", Masonry(wide)).number > 0.1


def test_a_recessed_brick_at_an_end_is_named_and_nothing_else():
    loops = courses([[2.0] * 4, [2.0] * 4, [2.0] * 4])
    loops[5] = box(1.0, 1, 1.0, 1)
    found = find("flush_ends", Masonry(loops))
    # One of six ends is 1 short; the mean width is 23/12.
    assert found.number == pytest.approx(1.0 / 6.0 / (23.0 / 12.0), rel=0.03)
    assert [case.stones for case in found.cases] == [(5,)]
    assert "left end" in found.cases[0].words
    # An uneven top is no ragged end, nor is a bed that is open but for a knob of stone 9.
    loops = courses([[2.0] * 4]) | {10: box(0, 1.05, 2, 1), 11: box(6, 1.05, 2, 1)}
    loops[9] = np.array([[3.0, 1.05], [3.1, 1.0], [3.2, 1.05], [6, 1.05], [6, 2.55], [2, 2.55],
                         [2, 1.05]])  # fmt: skip
    found = find("flush_ends", Masonry(loops))
    assert (found.number, found.cases) == (0.0, ())


def test_without_open_joints_top_and_ends_are_those_of_measure():
    loops = courses([[2.0, 3.0, 2.0], [1.0, 4.0, 1.5], [3.0, 3.0]])
    loops |= {20: box(0, 3, 2.5, 1), 21: box(2.5, 3, 2.0, 0.25)}
    labels, wall = painted(loops), Masonry(loops)
    frame = frame_wall(labels)
    heights = [np.ptp(loop[:, 1]) * PX for loop in loops.values()]
    widths = [np.ptp(loop[:, 0]) * PX for loop in loops.values()]
    level = level_deviation(frame.labels, float(np.mean(heights)))
    flush = flush_deviation(frame, float(np.mean(widths)))
    assert find("level_top", wall).number == pytest.approx(level, abs=0.01)
    assert find("flush_ends", wall).number == pytest.approx(flush, abs=0.01)
