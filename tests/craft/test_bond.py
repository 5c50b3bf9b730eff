"""Running joints, cross joints, one over two, laps: walls of bricks."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drystone.craft import CraftSettings, Masonry
from drystone.craft.bond import bond_faults
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


@pytest.mark.parametrize("wall", both(running_bond()), ids=["polygons", "labels"])
def test_a_running_bond_keeps_every_rule_of_bond(wall):
    assert find("running_joints", wall).number == 1.0
    assert find("cross_joints", wall).number == 0.0
    over = find("one_over_two", wall)
    assert (over.number, over.cases) == (1.0, ())
    assert over.figures["share of the stones that carry that carry two or more"] == 1.0
    lapped = find("laps", wall)
    assert (lapped.number, lapped.verdict) == (0.0, "good")
    assert lapped.figures["mean lap"] == pytest.approx(0.5, abs=0.02)
    assert bond_faults(wall) == bond_faults(Masonry({})) == 0.0


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
    wall = Masonry(open_joints(stack_bond(), 0.4))
    assert find("running_joints", wall).verdict == "not judged"
    assert find("one_over_two", wall).cases[0].words == "rests on no stone"
    # A wedge is part of the bed.
    loops = {1: box(0, 0, 2, 1), 2: box(2, 0, 2, 1), 3: box(1, 1.4, 2, 1)}
    wedges = {8: box(1.2, 1, 0.5, 0.4), 9: box(2.3, 1, 0.5, 0.4)}
    assert Masonry(loops).supports[3] == ()
    wall = Masonry(loops | wedges, wedge_ids={8, 9})
    assert [one[0] for one in wall.supports[3]] == [1, 2]
    assert set(wall.stones) == {1, 2, 3}


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
