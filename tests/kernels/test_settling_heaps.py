"""Stones let go over heaps of others: whatever rests lies over nothing, and truly rests."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.settling import Status, rest_margin
from tests.kernels.heaps import WIDTH, drops
from tests.naive.settling import best_nearby, contacts, distances, overlap_area, placed, unbalanced
from tests.strategies import repeatable

STONES = 25
seeds = st.integers(0, 2**32 - 1)


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
        if found.status in (Status.RESTS, Status.FALLS):
            agrees_with_forces(drop, found)
    assert rested >= 3


def agrees_with_forces(drop, found):
    """Forces at the contacts carry the weight of what rests, and of nothing else."""
    corners = placed(drop.outline, found[1:4])
    sure, doubtful = contacts(corners, drop.around, drop.rules.tolerance)
    arm = float(np.hypot(*drop.outline.T).max())
    more = [contact for pair in doubtful for contact in pair]
    left = unbalanced(sure + more, found[1:3], arm, drop.rules.mu)
    if found.status == Status.RESTS:
        assert left <= 2e-6
    elif not doubtful:
        assert left > 0.5e-6


@repeatable(6)
@given(seeds)
def test_no_small_motion_goes_down_from_where_nothing_is_gained(seed):
    for drop, found in drops(seed, 8):
        rules = drop.rules
        if found.status not in (Status.RESTS, Status.FALLS) or rules.stop >= 0 or not rules.turns:
            continue
        size = rules.near / 0.04
        outline, pose = drop.outline, found[1:4]
        down = best_nearby(outline, pose, drop.around, WIDTH, rules.lean, rules.clearance)
        assert down <= 1e-6 * size, (drop, found)


@repeatable(4)
@given(seeds)
def test_steps_pass_through_nothing(seed):
    for drop, _ in drops(seed, STONES):
        rules = drop.rules._replace(steps=1, near=drop.rules.far, stop=-1.0)
        size = drop.rules.near / 0.04
        others = shapely.union_all(
            [shapely.Polygon(drop.around.polygon(i)) for i in range(len(drop.around))]
        )
        pose = drop.pose
        for _ in range(12):
            after = drop._replace(pose=pose, rules=rules).settled()[1:4]
            if after == pose:
                break
            assert after[1] + rules.lean * after[0] < pose[1] + rules.lean * pose[0]
            for share in (0.2, 0.4, 0.6, 0.8):
                between = tuple(np.array(pose) + share * np.subtract(after, pose))
                shape = shapely.Polygon(placed(drop.outline, between))
                # Turns bulge by at most the square of a radius over twice the arm.
                assert not shape.buffer(-0.02 * size).intersects(others)
                common = shape.intersection(others)
                assert common.area <= 0.02 * size * common.length + 1e-9
            pose = after


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


@pytest.mark.parametrize(("seed", "times"), [(5022, 4), (5030, 8)])
def test_steps_that_are_far_too_long_end_nowhere_else(seed, times):
    for drop, _ in drops(seed, STONES):
        near, far = times * drop.rules.near, times * drop.rules.far
        rules = drop.rules._replace(near=near, far=far, turn=9.0, shift=99.0)
        found = drop._replace(rules=rules).settled()
        assert found.status != Status.OVERLAPS
        assert overlap_area(placed(drop.outline, found[1:4]), drop.around) == 0.0
