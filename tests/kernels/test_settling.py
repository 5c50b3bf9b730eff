"""Letting stones go: how that ends, what rules do, scenes with a known end, and random heaps."""

import math
from bisect import bisect
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq, linprog

from drystone.kernels.polygons import (
    Points,
    Polygons,
    area_and_centroid,
    no_polygons,
    polygon_edges,
)
from drystone.kernels.seidel import solve
from drystone.kernels.settling import SettlingRules, Status, rest_margin, settle
from tests.naive.settling import Pose, contacts, distances, overlap_area, placed, unbalanced
from tests.polygons import box_about as box
from tests.polygons import centred, convex, random_polygon
from tests.polygons import moved as at
from tests.strategies import repeatable

MU = 0.58
WIDTH = 160.0
STONES = 25
seeds = st.integers(0, 2**32 - 1)


class Drop(NamedTuple):
    """A stone that is let go."""

    outline: Points
    pose: Pose
    around: Polygons
    rules: SettlingRules

    def settled(self):
        edges = polygon_edges(self.outline)
        return settle(self.outline, edges, self.pose, self.around, WIDTH, self.rules)


def rules(size, **changes):
    """Those of exact settling, with lengths by a stone's size."""
    usual = SettlingRules(
        lean=0.3,
        stop=-1.0,
        mu=0.58,
        clearance=0.01,
        tolerance=0.1,
        corner=0.3,
        near=0.04 * size,
        far=0.08 * size,
        turn=math.radians(40.0),
        shift=2.0 * size,
        gain=4e-6 * size,
        overlap=0.5,
        steep=-1.0,
        beyond=0.0,
        sticks=False,
        turns=True,
        steps=200,
    )
    return usual._replace(**changes)


WAYS = (
    {},
    {"lean": 0.0},
    {"lean": 0.0, "stop": 0.2},
    {"lean": 0.0, "stop": 0.2, "sticks": True},
    {"turns": False},
)
"""Ways of settling: pushed aside, frictionless, as soon as it rests, rolling, without turning."""


def random_outline(rng):
    """Convex, concave, with many corners, a thin sliver, or one that is bent."""
    kind, size = int(rng.integers(5)), float(rng.uniform(8.0, 50.0))
    if kind == 0:
        return centred(convex(random_polygon(rng, int(rng.integers(4, 20)), size)))
    if kind == 1:
        return box(size, 2.0 * float(rng.uniform(0.5, 2.0)))
    if kind == 2:
        a, b, bend = size / 2.0, float(rng.uniform(1.0, 3.0)), float(rng.uniform(-0.5, 0.5)) * size
        return centred(
            np.array([[-a, 0.0], [0.0, bend], [a, 0.0], [a, b], [0.0, bend + b], [-a, b]])
        )
    return centred(random_polygon(rng, int(rng.integers(3, 9) if kind == 3 else 30), size))


def drops(seed, count):
    """Stones let go one after the other; those that rest stay."""
    rng = np.random.default_rng(seed)
    around = no_polygons()
    for _ in range(count):
        outline = placed(random_outline(rng), (0.0, 0.0, float(rng.uniform(-3.0, 3.0))))
        size = math.sqrt(area_and_centroid(outline)[0])
        (left, low), (right, _) = outline.min(axis=0), outline.max(axis=0)
        x = float(rng.uniform(0.1 - left, WIDTH - right - 0.1))
        under = (around.boxes[:, 0] < x + right) & (around.boxes[:, 2] > x + left)
        top = float(around.boxes[under, 3].max(initial=0.0))
        way = WAYS[int(rng.integers(len(WAYS)))]
        drop = Drop(outline, (x, top - float(low) + 0.05, 0.0), around, rules(size, **way))
        found = drop.settled()
        yield drop, found
        if found.status == Status.RESTS:
            around = around.added([placed(outline, found[1:4])])


BRICK = box(20.0, 10.0)


def let_go(outline, pose, others=(), width=200.0, size=15.0, **changes):
    around = no_polygons().added(list(others))
    return settle(outline, polygon_edges(outline), pose, around, width, rules(size, **changes))


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
    # Held by the two ends alone it would not rest.
    wedged = let_go(BRICK, (10.01, 30.0, 0.0), width=20.02, steps=1, lean=0.0)
    assert wedged.status == Status.UNFINISHED
    # A ladder against an end slides however steep it is, since it cannot push off.
    ladder = box(40.0, 1.0)
    angle = math.radians(80.0)
    x, y = (float(-placed(ladder, (0.0, 0.0, angle))[:, k].min() + 0.01) for k in (0, 1))
    assert let_go(ladder, (x, y, angle), steps=1, stop=0.0).margin == -1.0


def test_statuses():
    low = at(BRICK, 50.0, 5.01)
    # Straight down: steps grow from .6 to 1.2 on the way.
    found = let_go(BRICK, (50.0, 30.0, 0.0), lean=0.0)
    assert (found.status, found.x, found.angle) == (Status.RESTS, 50.0, 0.0)
    assert 20 <= found.steps <= 28
    # What is not a number does not rest.
    for pose in ((math.nan, 9.0, 0.0), (50.0, math.nan, 0.0), (50.0, 9.0, math.nan)):
        assert let_go(BRICK, pose).status != Status.RESTS
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
    assert (found.status, found.margin) == (Status.FALLS, -1.0)
    # Over another, and only a little.
    assert let_go(BRICK, (55.0, 12.0, 0.0), [low]).status == Status.OVERLAPS
    assert let_go(BRICK, (50.0, 5.0, 0.0), [low]).status == Status.OVERLAPS
    found = let_go(BRICK, (52.0, 14.7, 0.0), [low], lean=0.0)
    assert found.status == Status.RESTS
    assert found[1:4] == pytest.approx((52.0, 15.02, 0.0), abs=1e-6)
    # Over another, although no corner is near.
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


def margin(outline, x, y, others=(), mu=MU):
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
    # Any number of corners may stand between those that bear.
    many = np.vstack([slab[:3], [(20.0 - k / 3.0, 5.0) for k in range(1, 120)], slab[3:]])
    piers = [at(cube, x, 5.0) for x in (40.0, 60.0)]
    assert margin(many, 50.0, 15.05, piers) == margin(slab, 50.0, 15.05, piers) > 0.0
    # Corners that pass each other carry nothing although faces would part them.
    low = [at(cube, 24.8, 5.0), at(cube, 74.0, 5.0)]
    assert margin(slab, 50.0, 15.05, low) == -1.0
    assert margin(slab, 49.82, 15.05, low) > 0.0


@pytest.mark.parametrize("mu", [0.0, -0.5, math.nan])
def test_without_friction_there_is_no_margin(mu):
    with pytest.raises(ValueError, match="mu must be positive"):
        margin(BRICK, 50.0, 5.02, mu=mu)
    with pytest.raises(ValueError, match="mu must be positive"):
        let_go(BRICK, (50.0, 9.0, 0.0), mu=mu)


def exactly(outline, pose, others, size, width=400.0, **changes):
    """Let go without slack: scenes with a known end, told to a millionth of the stone's size."""
    close = {"clearance": 1e-9 * size, "tolerance": 1e-7 * size, "corner": 1e-7 * size}
    near = {"overlap": 0.01 * size, "gain": 1e-12 * size, "turn": math.radians(60.0), "steps": 400}
    how = {"lean": 0.0, **close, **near, **changes}
    return let_go(outline, pose, others, width, size, **how)


@pytest.mark.parametrize("side", [-1, 1])
def test_a_corbel_carries_itself_up_to_half_its_length(side):
    low = [at(BRICK, 50.0, 5.0)]
    inside = exactly(BRICK, (50.0 + side * 9.999, 16.0, 0.0), low, 20.0)
    assert inside.status == Status.RESTS
    assert inside[1:4] == pytest.approx((50.0 + side * 9.999, 15.0, 0.0), abs=2e-5)
    # Gravity may lean by what is left of the support over the height of its centroid.
    assert inside.margin == pytest.approx(0.001 / 5.0 / MU, abs=1e-6)
    outside = exactly(BRICK, (50.0 + side * 10.001, 16.0, 0.0), low, 20.0, turn=0.1)
    assert outside.status == Status.FAR
    assert math.copysign(1.0, outside.angle) == -side


def leaning(thickness, angle):
    """A ladder 40 long that touches the ground and, on its right, a post; and those two points."""
    ladder = box(40.0, thickness)
    c, s = math.cos(angle), math.sin(angle)
    corners = ladder @ np.array([[c, s], [-s, c]])
    x, y = 100.0 - 4e-8 - corners[:, 0].max(), 4e-8 - corners[:, 1].min()
    foot = corners[int(np.argmin(corners[:, 1]))] + (x, y)
    head = corners[int(np.argmax(corners[:, 0]))] + (x, y)
    return ladder, (float(x), float(y), angle), foot, head


POST = at(box(10.0, 80.0), 105.0, 40.0)


@pytest.mark.parametrize("thickness", [4e-5, 5.0])
def test_a_ladder_rests_from_the_angle_on_where_lines_of_force_meet(thickness):
    def spare(angle):
        """Where both cones of friction cross the vertical through the centroid."""
        _, (x, _, _), foot, head = leaning(thickness, angle)
        return head[1] + MU * (head[0] - x) - abs(x - foot[0]) / MU

    def rests(angle):
        ladder, pose, _, _ = leaning(thickness, angle)
        found = exactly(ladder, pose, [POST], 40.0, stop=0.0, steps=1)
        return found.status == Status.RESTS and found.steps == 0

    assert rests(1.4)
    begins = bisect(range(1_400_000_000), False, 300_000_000, key=lambda n: rests(1e-9 * n))
    expected = brentq(spare, 0.3, 1.2, xtol=1e-13)
    assert 1e-9 * begins == pytest.approx(expected, abs=1e-6)
    if thickness < 1e-4:  # as thin as the clearance allows, it is that of the textbook
        assert expected == pytest.approx(math.atan((1.0 - MU**2) / (2.0 * MU)), abs=2e-6)


def test_a_ladder_without_friction_slides_until_it_lies():
    ladder, pose, _, _ = leaning(2.0, 1.1)
    found = exactly(ladder, pose, [POST], 40.0, turn=9.0, shift=400.0)
    assert found.status == Status.RESTS
    assert (found.y, found.angle) == pytest.approx((1.0, 0.0), abs=4e-5)
    stopped = exactly(ladder, pose, [POST], 40.0, stop=0.0)
    assert stopped[:4] == (Status.RESTS, *pose)


@repeatable(25)
@given(seeds)
def test_settled_stones_lie_over_nothing_and_rest(seed):
    rested = 0
    for drop, found in drops(seed, STONES):
        # They are let go where nothing is, and nothing can come of that but a free pose.
        assert found.status != Status.OVERLAPS
        corners = placed(drop.outline, found[1:4])
        apart = min(distances(corners, drop.around, WIDTH))
        assert apart >= drop.rules.clearance / 2 - 1e-9
        assert found.gap <= apart + 1e-9 or found.gap > drop.rules.tolerance
        assert overlap_area(corners, drop.around) == 0.0
        if found.status == Status.RESTS:
            rested += 1
            assert found.margin == pytest.approx(
                rest_margin(corners, found[1:3], drop.around, WIDTH, 0.58, 0.1), abs=1e-6
            )
        if found.status not in (Status.RESTS, Status.FALLS):
            continue
        # Forces at the contacts carry the weight of what rests, and of nothing else.
        sure, doubtful = contacts(corners, drop.around, drop.rules.tolerance)
        arm = float(np.hypot(*drop.outline.T).max())
        left = unbalanced(sum(doubtful, tuple(sure)), found[1:3], arm, drop.rules.mu)
        if found.status == Status.RESTS:
            assert left <= 2e-6
        elif not doubtful:
            assert left > 0.5e-6
    assert rested >= 3


@pytest.mark.parametrize(
    ("seed", "number", "times"),
    [(0, 2, 1), (0, 10, 4), (5, 15, 1), (12, 14, 1), (52, 2, 4)],
)
def test_every_step_goes_down_to_a_free_pose(seed, number, times):
    """Stones whose moves come too near, gain nothing in the end, or cross others."""
    drop, _ = list(drops(seed, number + 1))[number]
    near, far = times * drop.rules.near, times * drop.rules.far
    energy = math.inf
    for steps in range(1, 25):
        rules = drop.rules._replace(near=near, far=far, steps=steps)
        found = drop._replace(rules=rules).settled()
        assert found.status != Status.OVERLAPS
        assert found.gap >= rules.clearance / 2
        assert found.y + rules.lean * found.x <= energy
        energy = found.y + rules.lean * found.x


@st.composite
def programs(draw):
    """Rows of unit normals; tight, loose, doubled, opposite, or through one point."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(0, 24))
    rows = rng.normal(size=(count, 4))
    rows[:, :3] /= np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
    kind = draw(st.sampled_from(["any", "feasible", "through 0", "slabs", "flat"]))
    if kind in ("feasible", "flat"):
        rows[:, 3] = np.abs(rows[:, 3])
    if kind == "through 0":
        rows[:, 3] = 0.0
    if kind == "slabs":
        other = -rows * [1, 1, 1, rng.choice([1.0, -1.0, 0.5])]
        rows = np.vstack([rows, other, rows])
    if kind == "flat":
        rows[:, 2] = 0.0
    gain = rng.normal(size=3) if draw(st.booleans()) else np.array([-0.3, -1.0, 0.0])
    return np.ascontiguousarray(rows), gain, rng.uniform(0.0, 3.0, 3) * rng.integers(0, 2, 3) + 0.1


def test_gains_what_scipy_gains():
    seen = set()

    @repeatable(200)
    @given(programs())
    def check(program):
        rows, gain, most = program
        found = solve(rows, gain, most)
        expected = linprog(
            -gain, rows[:, :3], rows[:, 3], bounds=list(zip(-most, most, strict=True))
        )
        feasible = expected.status == 0
        seen.add(feasible)
        assert feasible == (found is not None)
        if found is not None:
            x = np.array(found)
            assert (rows[:, :3] @ x <= rows[:, 3] + 1e-7).all()
            assert (np.abs(x) <= most + 1e-7).all()
            assert gain @ x == pytest.approx(-expected.fun, abs=1e-6)

    check()
    assert seen == {True, False}


def test_where_nothing_is_gained_nothing_moves():
    down, most = np.array([0.0, -1.0, 0.0]), np.full(3, 5.0)
    assert solve(np.zeros((0, 4)), down, most) == (0.0, -5.0, 0.0)
    assert solve(np.zeros((0, 4)), np.array([1e-13, -1.0, -1e-13]), most) == (0.0, -5.0, 0.0)
    # A flat support, and rounding in what is gained along it.
    flat = np.array([[0.0, -1.0, 0.5, 1.0], [0.0, -1.0, -0.5, 1.0], [1e-17, -1.0, 0.2, 1.0]])
    assert solve(flat, down, most) == pytest.approx((0.0, -1.0, 0.0), abs=1e-12)
    # The smallest move that keeps off from a side.
    aside = np.vstack([flat, [-1.0, 0.0, 0.0, -2.0]])
    assert solve(aside, down, most) == pytest.approx((2.0, -1.0, 0.0), abs=1e-12)
    for sign in (1.0, -1.0):
        both = np.array([[0.0, -1.0, 0.0, 1.0], [-sign, 0.0, 0.0, -2.0], [0.0, 0.0, -sign, -1.0]])
        assert solve(both, down, most) == pytest.approx((2.0 * sign, -1.0, sign), abs=1e-12)
