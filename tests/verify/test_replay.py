from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.placement import Placement
from drystone.model.plan import StoneStep
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.poses import PoseBook
from drystone.verify.replay import place_stone, rebuild_wall, replay_plan
from tests.strategies import repeatable, stones
from tests.verify.examples import L_STONE, example


@pytest.mark.parametrize(
    ("scale", "px_per_m"), [(1.0, None), (1.0, 137.0), (0.5, None), (0.5, 211.3)]
)
def test_wall_is_rebuilt_to_the_pixel(scale, px_per_m):
    made = example(scale, px_per_m)
    found = rebuild_wall(made.plan, made.stones)
    np.testing.assert_array_equal(found.labels, made.wall.labels)
    assert found.site == made.wall.site
    assert [p.side for p in found.placements] == [p.side for p in made.wall.placements]
    assert [w.id for w in found.wedges] == [w.id for w in made.wall.wedges]


def test_l_stone_turned_by_90_degrees_is_not_mirrored():
    made = example()
    wall = rebuild_wall(made.plan, made.stones)
    mask = next(p.posed.mask for p in wall.placements if p.stone_id == L_STONE)
    np.testing.assert_array_equal(mask, np.rot90(made.stones.by_id(L_STONE).mask))


@repeatable(80)
@given(
    stones(stone_id=6, max_px=12),
    st.sampled_from([0.0, 90.0, -37.0, 12.3, 179.0]),
    st.sampled_from([1.0, 0.7, 0.3]),
    st.sampled_from([None, 437.0, 1e-3]),
)
def test_pose_of_a_plan_is_the_pose_of_the_planner(stone, angle_deg, scale, px_per_m):
    site = Site(40, 30, scale, px_per_m)
    placed = Placement(PoseBook(scale).pose(stone, angle_deg), 7, 11, "right", 2)
    x, y = placed.centroid(site.height_px)
    unit = site.units_per_px
    step = StoneStep(1, 6, placed.posed.angle_deg, stone.centroid, (x * unit, y * unit), "right",
                     1, 2, {}, None, None, None)  # fmt: skip
    found = place_stone(step, StoneSet((stone,)), site)
    np.testing.assert_array_equal(found.posed.mask, placed.posed.mask)
    assert (found.row, found.col, found.side, found.rotation_moves) == (7, 11, "right", 2)
    assert found.posed.anchor == placed.posed.anchor


def test_wall_size_in_metres_does_not_depend_on_rounding():
    made = example()
    for width in range(1, 400, 2):
        plan = replace(made.plan, width=width / 437.0, length_unit="m", px_per_m=437.0,
                       height=30 / 437.0, working_scale=0.5, steps=())  # fmt: skip
        assert replay_plan(plan, made.stones).site.width_px == (width + 1) // 2


def test_pieces_that_overlap_stay_in_the_replay_and_the_wall_ends_before():
    made = example()
    second = made.plan.stone_steps[1]
    x, y = second.centroid
    moved = replace(second, centroid=(x - 25, y))
    steps = [moved if step is second else step for step in made.plan.steps]
    replay = replay_plan(replace(made.plan, steps=tuple(steps)), made.stones)
    assert replay.broken_at == 2
    assert [problem.code for problem in replay.problems] == ["E221"]
    assert "80 working px" in replay.problems[0].message
    assert [p.stone_id for p in replay.wall.placements] == [3]
    assert len(replay.pieces) == 6
