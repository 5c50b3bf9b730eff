"""Walls of pixels that are planned course by course."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.lowering import skyline
from drystone.model.site import Site
from drystone.search.course_plan import CoursePlan
from drystone.search.course_settings import CourseSettings
from drystone.search.laid_courses import LaidCourses
from drystone.search.laying import lay
from drystone.search.pixel_courses import (
    pixel_extent,
    pixel_quarters,
    plan_pixel_courses,
    replan_pixel_courses,
)
from drystone.search.pixel_outlines import placed_outline
from tests.planner.scenes import blocks, bricks, rubble
from tests.search.pixel_yards import PixelYard, pixel_boxes, statuses

QUICK = CourseSettings(evaluations=300)


def _planned(yard: PixelYard, seed: int = 1, settings: CourseSettings = QUICK) -> CoursePlan:
    plan = plan_pixel_courses(yard.workshop, settings, seed)
    assert plan is not None
    return plan


@pytest.mark.parametrize("scale", [1.0, 0.3])
def test_stones_are_as_wide_and_as_high_as_their_pixels(scale: float) -> None:
    yard = PixelYard(rubble(3, 6), Site.from_source(200, 70, scale))
    column_px = 0.5 / scale
    quarters = pixel_quarters(list(yard.stones), yard.workshop, column_px)
    assert quarters is not None
    for number, stone in enumerate(quarters.stones):
        for turn, angle in enumerate(quarters.angles_deg[number]):
            posed, pose = yard.workshop.book.pose(stone, angle), 4 * number + turn
            columns = slice(*quarters.poses.first[pose : pose + 2])
            size = quarters.poses.width[pose], quarters.poses.height[pose]
            assert size == (32 * posed.width_px, 32 * posed.height_px)
            lows = posed.height_px - 1 - posed.bottom
            assert quarters.poses.bottoms[columns].tolist() == np.repeat(32 * lows, 2).tolist()
            highs = posed.height_px - posed.top
            assert quarters.poses.tops[columns].tolist() == np.repeat(32 * highs, 2).tolist()


def test_a_plan_of_bricks_is_laid_as_planned() -> None:
    yard = PixelYard(bricks(6), Site(60, 20))
    plan = _planned(yard, settings=CourseSettings(evaluations=1500))
    laid = lay(plan, yard.empty(), yard.workshop, yard.settings)
    assert {status for course in statuses(laid) for status in course} == {"as planned"}
    assert len(laid.build.actions) == 6
    boxes = pixel_boxes(laid)
    for stone in laid.laid:
        assert boxes[stone.stone_id][0] == pytest.approx(stone.left_px, abs=1.0)
        assert boxes[stone.stone_id][3] == pytest.approx(stone.top_px, abs=1.0)


def test_equal_seeds_give_equal_plans_inside_the_wall() -> None:
    yard = PixelYard(rubble(2, 8), Site.from_source(110, 60, 0.5))
    plan = _planned(yard)
    assert plan == _planned(yard)
    assert any(plan != _planned(yard, seed) for seed in (2, 3))
    width, _ = pixel_extent(yard.site)
    stones = [stone for course in plan.courses for stone in course]
    assert len({stone.stone_id for stone in stones}) == len(stones) > 4
    for stone in stones:
        assert stone.left_px >= -1e-9
        assert stone.right_px <= width + 1e-9


def test_upper_courses_are_planned_on_what_is_laid() -> None:
    yard = PixelYard(rubble(2, 10), Site(100, 60))
    plan = _planned(yard)
    laid = lay(replace(plan, courses=plan.courses[:1]), yard.empty(), yard.workshop, yard.settings)
    build = laid.build
    outlines = [placed_outline(p, yard.site.height_px) for p in build.wall.placements]
    left = yard.workshop.remaining(build)
    known = LaidCourses.of([outlines], 100.0, 1.0)
    again = replan_pixel_courses(plan, 1, left, yard.workshop, QUICK, 5, laid=known)
    assert again is not None
    assert again.courses[:1] == plan.courses[:1]
    above = [stone for course in again.courses[1:] for stone in course]
    assert above
    assert {stone.stone_id for stone in above} <= set(left)
    ground = 60 - skyline(build.wall.occupied)
    for stone in again.courses[1]:
        under = ground[int(stone.left_px) : int(stone.right_px)].max()
        assert stone.top_px > under


def test_nothing_is_planned_where_nothing_fits() -> None:
    yard = PixelYard(blocks({1: (30, 30)}), Site(20, 20), {"skip_too_large": True})
    assert plan_pixel_courses(yard.workshop, QUICK, 0) is None
    known, plan = LaidCourses.of([], 20.0, 1.0), CoursePlan((), 0.0)
    assert replan_pixel_courses(plan, 0, [1], yard.workshop, QUICK, 0, laid=known) is None
