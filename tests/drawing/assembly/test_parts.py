"""Parts of plans against their pixels and the plan, and how they are held and brought."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import affinity

from drystone.drawing.export import robots
from tests.drawing.export.robot_plans import METRIC, PX_PER_M, THICKNESS_M, assembly, source_stones
from tests.polygons import box_of


@pytest.mark.parametrize("name", METRIC)
def test_pixels_of_a_stone_land_inside_its_outline(name):
    wall, stones = assembly(name), source_stones()
    # The outline of a plan on pixels is that of pixels of 2 source px.
    near_m = (0.7 if name.startswith("exact") else 2.5) / PX_PER_M
    for part in wall.stones:
        stone = stones.by_id(part.id)
        pick = wall.pick_pose(part)
        rows, cols = np.nonzero(stone.mask)
        x = stone.left_px + cols + 0.5
        y = stone.bottom_px + stone.mask.shape[0] - rows - 0.5
        photo = np.column_stack([x / PX_PER_M, y / PX_PER_M, 0 * x, 0 * x + 1])
        moved = wall.place_pose(part).matrix @ np.linalg.inv(pick.matrix) @ photo.T
        outline = shapely.Polygon(part.corners)
        points = shapely.points(moved[0], moved[2])
        assert shapely.distance(outline, points).max() < near_m
        assert outline.area * PX_PER_M**2 == pytest.approx(len(x), rel=0.06)


def test_the_grip_is_the_least_width_of_any_direction():
    for part in assembly("exact").parts:
        width, angle_deg = part.grip
        angles = np.radians(np.append(np.arange(0.0, 180.0, 0.25), angle_deg))
        across = np.stack([np.cos(angles), np.sin(angles)])
        widths = np.ptp(part.own_corners @ across, axis=0)
        assert widths[-1] == pytest.approx(width)
        assert widths.min() >= width - 1e-12
        assert 0.0 <= angle_deg < 180.0


def test_wedges_are_in_no_photo():
    wall = assembly("exact")
    (wedge,) = wall.wedges
    assert (wedge.kind, wedge.name, wedge.angle_deg) == ("wedge", "wedge_010", 0.0)
    assert wedge.under == 8
    with pytest.raises(TypeError, match="wedge_010 is in no image"):
        wall.source_corners(wedge)
    with pytest.raises(ValueError, match="read-only"):
        wedge.corners[0, 0] = 1.0


def test_stones_begin_above_everything_that_stands():
    wall = assembly("exact")
    top = 0.0
    for part in wall.parts:
        way = robots.place_approach(wall, part)
        pose = wall.place_pose(part)
        lift = np.array([*way["start"].values()]) - [pose.x_m, pose.y_m, pose.z_m]
        assert lift == pytest.approx(-way["stand_off_m"] * np.array([*way["direction"].values()]))
        if part.kind == "stone":
            assert tuple(way["direction"].values()) == (0.0, 0.0, -1.0)
            lowest = part.corners[:, 1].min() + lift[2]
            assert lowest == pytest.approx(max(top, part.corners[:, 1].min()) + 0.05)
        else:
            assert tuple(way["direction"].values()) == (0.0, 1.0, 0.0)
            assert way["start"]["y"] + THICKNESS_M / 2 == pytest.approx(-0.05)
        top = max(top, part.corners[:, 1].max())


@pytest.mark.parametrize("name", METRIC)
def test_what_is_in_the_way_down_is_what_small_steps_down_run_into(name):
    wall = assembly(name)
    found = []
    for part in wall.stones:
        outline = shapely.Polygon(part.corners)
        earlier = (p for p in wall.parts if p.step < part.step)
        there = shapely.union_all([shapely.Polygon(p.corners) for p in earlier])
        lift_m = robots.place_approach(wall, part)["stand_off_m"]
        widest = 0.0
        for lift in np.linspace(1e-6, lift_m, 60):
            for piece in shapely.get_parts(affinity.translate(outline, 0, lift) & there):
                left, _, right, _ = piece.bounds
                widest = max(widest, right - left)
        blocked = robots.blocked_m(wall, part)
        assert blocked >= widest - 1e-12
        found.append(blocked * PX_PER_M)
        if blocked * PX_PER_M > 0.01:
            assert widest > 0.0
    # Methods that lower stones from above leave no more than settling moves them by.
    assert max(found) < (1.0 if name == "exact" else 2.1)


@pytest.mark.parametrize("overlap_m", [0.0, 1e-12, -1e-12])
def test_what_a_stone_rests_on_is_not_in_its_way(overlap_m):
    wall = assembly("exact")
    first, second, *_ = wall.parts
    below = replace(first, corners=box_of(0.0, 0.0, 0.3, 0.1), centroid=(0.15, 0.05))
    for left, low, blocked in (
        (0.0, 0.1 - overlap_m, 0.0),
        (0.3 - overlap_m, 0.0, 0.0),
        (-0.2, -0.1, 0.1),
    ):
        corners, centroid = box_of(left, low, 0.3, 0.1), (left + 0.15, low + 0.05)
        part = replace(second, corners=corners, centroid=centroid)
        found = robots.blocked_m(replace(wall, parts=(below, part)), part)
        assert found == pytest.approx(blocked, abs=1e-11)
