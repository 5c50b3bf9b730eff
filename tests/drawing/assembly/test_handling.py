"""Grasps and approaches against geometry of other libraries and by hand."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import affinity

from drystone.drawing.assembly import handling
from tests.drawing.export.robot_plans import PX_PER_M, THICKNESS_M, assembly


def test_stones_begin_above_everything_that_stands() -> None:
    wall = assembly("exact")
    top = 0.0
    for part in wall.parts:
        way = handling.place_approach(wall, part)
        pose = wall.place_pose(part)
        lift = np.array(way.start) - [pose.x_m, pose.y_m, pose.z_m]
        assert lift == pytest.approx(-way.stand_off_m * np.array(way.direction))
        if part.kind == "stone":
            assert way.direction == (0.0, 0.0, -1.0)
            lowest = part.corners[:, 1].min() + lift[2]
            assert lowest == pytest.approx(max(top, part.corners[:, 1].min()) + 0.05)
        else:
            assert way.direction == (0.0, 1.0, 0.0)
            assert way.start[1] + THICKNESS_M / 2 == pytest.approx(-0.05)
        top = max(top, part.corners[:, 1].max())


def test_a_tool_comes_to_the_photo_from_above_all_stones() -> None:
    wall = assembly("raster")
    for part in wall.stones:
        way, pose = handling.pick_approach(wall, part), wall.pick_pose(part)
        assert way is not None
        assert pose is not None
        assert way.direction == (0.0, 0.0, -1.0)
        assert way.start == pytest.approx((pose.x_m, pose.y_m, 1.5 * THICKNESS_M + 0.05))


@pytest.mark.parametrize("name", ["exact", "raster"])
def test_what_is_in_the_way_down_is_what_small_steps_down_run_into(name: str) -> None:
    wall = assembly(name)
    found = []
    for part in wall.stones:
        outline = shapely.Polygon(part.corners)
        there = shapely.union_all([shapely.Polygon(p.corners)
                                   for p in wall.parts if p.step < part.step])  # fmt: skip
        lift_m = handling.place_approach(wall, part).stand_off_m
        widest = 0.0
        for lift in np.linspace(1e-6, lift_m, 60):
            for piece in shapely.get_parts(affinity.translate(outline, 0, lift) & there):
                left, _, right, _ = piece.bounds
                widest = max(widest, right - left)
        blocked = handling.blocked_m(wall, part)
        assert blocked >= widest - 1e-12
        found.append(blocked * PX_PER_M)
        if blocked * PX_PER_M > 0.01:
            assert widest > 0.0
    # Methods that lower stones from above leave no more than settling moves them by.
    assert max(found) < (1.0 if name == "exact" else 2.1)


def test_a_stone_under_another_one_cannot_be_lowered() -> None:
    wall = assembly("exact")
    (wedge,) = wall.wedges
    above = wall.part(wedge.under or 0)
    late = handling.Part(wall.parts[-1].plan_step, wedge.corners, wedge.centroid)
    overlap = shapely.Polygon(above.corners).bounds
    left, right = late.corners[:, 0].min(), late.corners[:, 0].max()
    covered = min(right, overlap[2]) - max(left, overlap[0])
    assert covered > 0.0
    assert handling.blocked_m(wall, late) >= covered - 1e-9


@pytest.mark.parametrize("overlap_m", [0.0, 1e-12, -1e-12])
def test_what_a_stone_rests_on_is_not_in_its_way(overlap_m: float) -> None:
    wall = assembly("exact")
    first, second, *_ = wall.parts
    box = np.array([[0.0, 0.0], [0.3, 0.0], [0.3, 0.1], [0.0, 0.1]])
    below = replace(first, corners=box, centroid=(0.15, 0.05))
    above = replace(second, corners=box + np.array([0.0, 0.1 - overlap_m]), centroid=(0.15, 0.15))
    beside = replace(second, corners=box + np.array([0.3 - overlap_m, 0.0]), centroid=(0.45, 0.05))
    for part in (above, beside):
        pair = replace(wall, parts=(below, part))
        assert handling.blocked_m(pair, part) == pytest.approx(0.0, abs=1e-11)
    under = replace(second, corners=box - np.array([0.2, 0.1]), centroid=(-0.05, -0.05))
    assert handling.blocked_m(replace(wall, parts=(below, under)), under) == pytest.approx(0.1)
