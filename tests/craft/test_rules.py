"""Every rule on walls drawn by hand: bonds, shapes, seats, with one planted fault each."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drystone.craft import CraftSettings, Masonry
from drystone.craft.bond import bond_faults
from drystone.kernels.polygons import turn
from tests.craft.walls import (
    both,
    box,
    courses,
    find,
    mirrored,
    open_joints,
    running_bond,
    stack_bond,
)
from tests.polygons import moved

BOND = ("running_joints", "cross_joints", "one_over_two", "laps")
COURSE = st.lists(st.sampled_from([1.0, 1.25, 1.5, 1.75, 2.0]), min_size=3, max_size=6)


@pytest.mark.parametrize("wall", both(stack_bond()), ids=["polygons", "labels"])
def test_a_stack_bond_breaks_every_rule_of_bond(wall):
    found = find("running_joints", wall)
    assert (found.number, found.verdict) == (5.0, "broken")
    column = [set(range(1 + k, 21, 4)) for k in range(4)]
    assert [set(case.stones) for case in found.cases] == [
        column[k] | column[k + 1] for k in (0, 1, 2)
    ]
    assert found.figures["longest joint, mean stone heights"] == pytest.approx(5.0, abs=0.05)
    assert found.figures["joints through three or more"] == 3.0
    assert found.figures["share of the length of all upright joints"] == 1.0
    found = find("cross_joints", wall)
    assert (found.number, found.verdict) == (6.0, "broken")
    fours = sorted(case.stones for case in found.cases)
    assert fours == [(k, k + 1, k + 4, k + 5) for k in range(1, 17) if k % 4]
    found = find("one_over_two", wall)
    assert (found.number, found.verdict) == (0.0, "broken")
    inner = [k for k in range(5, 21) if k % 4 in (2, 3)]
    assert sorted(case.stones for case in found.cases) == [(k, k - 4) for k in inner]
    assert found.figures["share of the stones that carry that carry two or more"] == 0.0
    assert find("laps", wall).verdict == "not judged"
    # 3 joints go 4 courses on, 12 points, 8 of 20 bricks between the ends on one, no lap at all.
    assert bond_faults(wall) == pytest.approx((12 + 12 + 8) / 20)


SEATS = ("seats", "towers", "voids")
SHAPES = ("on_end", "big_low", "level_beds", "inward_edges", "level_top", "flush_ends")


@pytest.mark.parametrize("wall", both(running_bond(4)), ids=["polygons", "labels"])
def test_a_running_bond_keeps_every_rule(wall):
    assert find("running_joints", wall).number == 1.0
    assert find("cross_joints", wall).number == 0.0
    over = find("one_over_two", wall)
    assert (over.number, over.cases) == (1.0, ())
    assert over.figures["share of the stones that carry that carry two or more"] == 1.0
    lapped = find("laps", wall)
    assert (lapped.number, lapped.verdict) == (0.0, "good")
    assert lapped.figures["mean lap"] == pytest.approx(0.5, abs=0.02)
    assert bond_faults(wall) == bond_faults(Masonry({})) == 0.0
    opened = Masonry(open_joints(running_bond(), 0.1))
    for rule, bricks in (*product(SHAPES + SEATS, [wall]), *product(SEATS, [opened])):
        found = find(rule, bricks)
        assert (found.verdict, found.cases) == ("good", ()), rule
        assert found.number == 0.0 or rule not in SEATS, rule
    assert find("big_low", wall).number == pytest.approx(1.0, abs=0.01)
    assert find("level_top", wall).number == find("flush_ends", wall).number == 0.0


TALL = {1: box(0, 0, 2, 2), 2: box(2, 0, 2, 1), 3: box(2, 1, 2, 1), 4: box(0, 2, 4, 1)}
HIGHER = {1: box(0, 0, 2, 1.5), 2: box(2, 0, 2, 1), 3: box(0, 1.5, 2, 1.5), 4: box(2, 1, 2, 2)}
NEAR, FAR = (courses([[2.0, 2.0], [2.0 + step, 2.0 - step]]) for step in (0.1, 0.25))
SLAB = {1: box(0, 0, 2, 1), 2: box(2, 0, 2, 1), 3: box(0, 1, 4, 0.08),
        4: box(0, 1.08, 2, 1), 5: box(2, 1.08, 2, 1)}  # fmt: skip


@pytest.mark.parametrize(("loops", "running", "crosses"), [
    # Heights that differ on both sides are a T, not a plus.
    (TALL, 1.0, 0.0), (HIGHER, 2.0, 0.0),
    # A step smaller than the offset ends no joint, a slab across it does.
    (NEAR, 2.0, 2.5), (FAR, 1.0, 0.0), (SLAB, 1.0, 0.0),
])  # fmt: skip
def test_where_a_joint_runs_on(loops, running, crosses):
    found = find("running_joints", Masonry(loops))
    assert (found.number, find("cross_joints", Masonry(loops)).number) == (running, crosses)
    if loops is TALL:
        longest = found.figures["longest joint, mean stone heights"]
        assert longest == pytest.approx(2.0 / 1.25, abs=0.1)
    if loops is NEAR:
        strict = Masonry(loops, settings=CraftSettings(offset=0.05))
        assert find("running_joints", strict).number == 1.0


def test_open_joints_of_a_tracing_change_nothing_but_stones_far_apart_have_none():
    for loops in (stack_bond(), running_bond()):
        tight, drawn = Masonry(loops), Masonry(open_joints(loops, 0.12))
        for rule in BOND:
            one, other = find(rule, tight), find(rule, drawn)
            assert one.number == other.number
            assert [case.stones for case in one.cases] == [case.stones for case in other.cases]
    wall = Masonry(open_joints(stack_bond(), 0.9))
    assert find("running_joints", wall).verdict == "not judged"
    assert find("one_over_two", wall).cases[0].words == "rests on no stone"
    # A wedge is part of the bed.
    loops = {1: box(0, 0, 2, 1), 2: box(2, 0, 2, 1), 3: box(1, 1.4, 2, 1)}
    wedges = {8: box(1.2, 1, 0.5, 0.4), 9: box(2.3, 1, 0.5, 0.4)}
    assert Masonry(loops).supports[3] == ()
    wall = Masonry(loops | wedges, wedge_ids={8, 9})
    assert [one[0] for one in wall.supports[3]] == [1, 2]
    assert set(wall.stones) == {1, 2, 3}


def test_a_slot_as_wide_as_a_small_stone_is_a_joint_through_all_its_courses():
    for gap, number in ((0.3, 3.0), (0.6, 3.0), (0.9, None)):
        sides = {2 * k + 1: box(0, k, 2, 1) for k in range(3)}
        sides |= {2 * k + 2: box(2 + gap, k, 2, 1) for k in range(3)}
        assert find("running_joints", Masonry(sides)).number == number


@settings(max_examples=12)
@given(st.lists(COURSE, min_size=2, max_size=4))
def test_coursed_walls_against_sums_of_widths(widths):
    """Joints by exact positions, laps by intervals: no lines, no outlines."""
    loops = courses(widths)
    ids = np.split(np.arange(1, len(loops) + 1), np.cumsum([len(w) for w in widths])[:-1])
    at = [np.cumsum(course)[:-1].tolist() for course in widths]
    runs = dict.fromkeys(at[0], 1)
    longest, crosses = 1, 0
    for upper in at[1:]:
        crosses += sum(x in runs for x in upper)
        runs = {x: runs.get(x, 0) + 1 for x in upper}
        longest = max(longest, *runs.values())
    wall = Masonry(loops)
    for rule in BOND:
        one, other = find(rule, wall), find(rule, Masonry(mirrored(loops)))
        assert one.number == pytest.approx(other.number)
        assert {frozenset(case.stones) for case in one.cases} == {
            frozenset(case.stones) for case in other.cases
        }
    assert find("running_joints", wall).number == longest
    assert len(find("cross_joints", wall).cases) == crosses
    expected = {}
    for level in range(1, len(widths)):
        below = [(i, loops[i][0, 0], loops[i][1, 0]) for i in ids[level - 1].tolist()]
        for i in ids[level].tolist():
            x0, x1 = loops[i][0, 0], loops[i][1, 0]
            under = [j for j, a, b in below if min(b, x1) - max(a, x0) > 0.1 * (x1 - x0)]
            assert [one[0] for one in wall.supports[i]] == under
            for left, right in pairwise(under):
                x = loops[left][1, 0]
                expected[i, left, right] = min(x - x0, x1 - x) / (x1 - x0)
    laps = find("laps", wall)
    short = {case.stones: case.value for case in laps.cases}
    assert not short or laps.verdict != "good"
    clearly = {key for key, lap in expected.items() if lap < 0.23}
    assert clearly <= set(short) <= {key for key, lap in expected.items() if lap < 0.27}
    assert all(value == pytest.approx(expected[key], abs=0.03) for key, value in short.items())


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


def test_a_triangle_stands_on_end_wherever_it_is_drawn():
    """Its three smallest rectangles are equal: the least elongated one counts."""
    triangle = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 5.0]])
    for loop in (triangle, triangle * 1e3, triangle * 1e20, triangle + 1e7, [5, 0] - triangle):
        assert find("on_end", Masonry({1: loop})).cases[0].value == pytest.approx(2.5, rel=1e-6)


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


FOOT = {1: box(0, 0, 2, 1), 2: box(2.6, 0, 2, 1)}
"""Two bricks with a gap between."""

KITE = np.array([[0.0, 0.0], [0.8, 1.0], [0.0, 1.2], [-0.8, 1.0]])
"""A stone with a point below."""


def wall(**stones):
    """The foot and stones named by letters, from 3 on."""
    return Masonry(FOOT | dict(enumerate(stones.values(), 3)))


def said(rule, masonry):
    finding = find(rule, masonry)
    return finding.number, [(case.stones, case.words) for case in finding.cases]


@pytest.mark.parametrize(("stone", "words"), [
    (moved(KITE, 1.0, 1.0), "rests on a point, 0.05 of its size wide"),
    # Down in the gap, between steep sides.
    (moved(KITE, 2.3, 0.63), "hangs between its neighbours, on no seat"),
    (box(3.9, 1, 2, 1), "its middle is 0.20 of its size beyond its seat"),
    (box(3.65, 1, 2, 1), "its middle is 0.03 of its size beyond its seat"),
    (box(3.5, 1, 2, 1), "its middle is only 0.06 of its size within its seat"),
    (box(3.2, 1, 2, 1), None),
    (box(1.3, 1, 2, 1), None),  # over the gap, on both
])  # fmt: skip
def test_a_stone_shall_sit(stone, words):
    number, cases = said("seats", wall(stone=stone))
    assert (number, [w for _, w in cases]) == ((0.0, []) if words is None else (1.0, [words]))


def test_small_stones_shall_not_make_a_tower():
    chips = [box(0.3, 1 + 0.3 * k, 0.5, 0.3) for k in range(3)]
    tower = said("towers", wall(a=chips[0], b=chips[1], c=chips[2]))
    assert tower == (3.0, [((3, 4, 5), "3 small stones on each other")])
    # Chips beside each other, or with a stone between, are no tower; nor is one that leans on a
    # large stone too.
    beside = wall(a=chips[0], b=chips[0] + [0.6, 0], c=box(0, 1.3, 2, 1), d=chips[0] + [0, 1.3])
    assert said("towers", beside) == (1.0, [])
    step = wall(a=chips[0], b=box(0.9, 1, 2, 0.3), c=box(0.5, 1.3, 0.7, 0.3))
    assert said("towers", step) == (1.0, [])


def test_no_corner_shall_hang_over_a_void():
    """The second brick reaches a third of its width out over its neighbour and the gap."""
    number, cases = said("voids", wall(stone=box(-0.7, 1, 2, 1)))
    assert number == pytest.approx(1 / 3)
    assert cases == [((3,), "nothing under its left corner, 0.35 of its width")]
    assert said("voids", wall(stone=box(-0.4, 1, 2, 1))) == (0.0, [])
    for hung in (box(-0.4, 1.9, 2, 1), box(-3.0, 1, 2, 1)):
        assert said("voids", wall(stone=hung))[1] == [((3,), "hangs, with nothing under it")]
    # A gap between two stones is under no corner, and a wedge fills.
    assert said("voids", wall(stone=box(1.3, 1, 2, 1))) == (0.0, [])
    loops = FOOT | {3: box(-0.7, 1, 2, 1), 9: box(-0.6, 0, 0.5, 1)}
    assert said("voids", Masonry(loops, wedge_ids={9}))[1] == []


def test_a_wedge_shall_be_a_chip():
    slope = np.array([[0.2, 1.0], [1.2, 1.5], [1.2, 1.6], [0.2, 1.6]])
    below = {1: np.array([[0.0, 0], [2.0, 0], [2.0, 1.9], [0.0, 0.9]]), 3: box(0, 1.9, 2, 1)}
    loops = below | {7: moved(slope, 0, 0.02)}
    number, cases = said("wedge_sizes", Masonry(loops, wedge_ids={7}))
    assert number == pytest.approx(0.35 / 2)
    assert cases == [((7, 3), "the wedge is 0.18 of the stone on it, on a slope of 27°")]
    chip = below | {7: box(0.2, 1.7, 0.3, 0.15)}
    assert said("wedge_sizes", Masonry(chip, wedge_ids={7})) == (pytest.approx(0.0225), [])
    assert find("wedge_sizes", Masonry(loops)).verdict == "not judged"
