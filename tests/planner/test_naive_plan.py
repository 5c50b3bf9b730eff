"""The planner against one that does everything anew for every candidate."""

import numpy as np
import pytest
from hypothesis import given

from drystone.contacts.blocks import model_from_labels
from drystone.generate import RubbleSettings, rubble_stones
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.search.plan_wall import plan_wall
from drystone.statics.limit import lateral_resistance
from tests.naive import placement as naive
from tests.naive.planner import SlowPlanner
from tests.naive.statics import alphas_by_linprog
from tests.statics import walls
from tests.strategies import posed_on_walls, repeatable

SMALL = RubbleSettings(count=10, width_px=100, height_px=36, courses=2)


@pytest.mark.parametrize("seed", [5, 7])
def test_the_plan_is_that_of_the_slow_planner(seed: int) -> None:
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
    alphas = [s for s in result.plan.steps if s.alpha_left is not None]
    found = [(step.alpha_left, step.alpha_right) for step in alphas]
    assert found == [pytest.approx(tried.alphas, abs=1e-9) for tried in slow.built]


def test_the_slow_planner_can_be_stopped() -> None:
    stones = rubble_stones(SMALL, np.random.default_rng(1))
    assert len(SlowPlanner(stones, Site(100, 36), 1).plan(at_most=2)) == 2


@repeatable(40)
@given(scene=posed_on_walls())
def test_positions_by_convolution_are_those_of_the_loops(
    scene: tuple[Wall, PosedStone, int, int],
) -> None:
    wall, posed, _, _ = scene
    expected = naive.resting_positions(wall.occupied, posed.mask)
    for areas in (naive.areas_by_convolution, naive.areas_by_fft):
        assert naive.resting_by_areas(wall.occupied, posed.mask, areas) == expected


@repeatable(40)
@given(scene=posed_on_walls())
def test_eq12_on_images_is_that_of_the_loops(scene: tuple[Wall, PosedStone, int, int]) -> None:
    wall, posed, row, col = scene
    args = wall.occupied, posed.mask, posed.anchor[0], (row, col), 0.7
    assert naive.eq12_on_images(*args) == pytest.approx(naive.eq12(*args), abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_linprog_agrees_with_the_limit_analysis(seed: int) -> None:
    for labels in (walls.coursed(seed, 3, 70, 3), walls.irregular(seed, 10, 60, 40)):
        model = model_from_labels(labels).model
        both = lateral_resistance(model)
        found = alphas_by_linprog(model)
        assert (found is not None) == both.stable
        if found is not None:
            assert found == pytest.approx((both.left.alpha, both.right.alpha), abs=1e-9)
