"""The planner against one that does everything anew for every candidate."""

import numpy as np
import pytest

from drystone.generate import RubbleSettings, rubble_stones
from drystone.model.site import Site
from drystone.search.plan_wall import plan_wall
from tests.naive.planner import SlowPlanner

SMALL = RubbleSettings(count=10, width_px=100, height_px=36, courses=2)


def test_the_plan_is_that_of_the_slow_planner():
    seed = 7
    stones = rubble_stones(SMALL, np.random.default_rng(seed))
    result = plan_wall(stones, 100, 36, scale=1.0, seed=seed, method="paper")
    slow = SlowPlanner(stones, Site(100, 36), seed)
    slow.plan()
    assert len(slow.built) == len(result.wall.groups) >= 9
    # Stones are turned and wedged in these walls.
    assert result.wall.wedges
    assert any(at.rotation_moves for at in result.wall.placements)
    for tried, group in zip(slow.built, result.wall.groups, strict=True):
        at, expected = group.placement, tried.placement
        assert (at.stone_id, at.posed.angle_deg, at.row, at.col) == (
            expected.stone_id,
            expected.posed.angle_deg,
            expected.row,
            expected.col,
        )
        assert [w.id for w in group.wedges] == [w.id for w in tried.wedges]
    np.testing.assert_array_equal(result.wall.labels, slow.labels)
    for step, tried in zip(result.plan.stone_steps, slow.built, strict=True):
        assert step.indices == pytest.approx(tried.action.indices.as_dict(), abs=1e-9)
    alphas = [s for s in result.plan.steps if s.alpha_left is not None]
    found = [(step.alpha_left, step.alpha_right) for step in alphas]
    assert found == [pytest.approx(tried.alphas, abs=1e-9) for tried in slow.built]
