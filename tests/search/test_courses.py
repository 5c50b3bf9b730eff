"""Planning course by course: every stone once, inside the wall, courses that bond."""

from itertools import chain, pairwise

import numpy as np
import pytest

from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.kernels.backend import describe
from drystone.kernels.courses import evaluate
from drystone.kernels.polygons import Points
from drystone.model.stone import Stone, StoneSet
from drystone.planner.course_settings import CourseSettings
from drystone.poses import PoseBook
from drystone.search import courses
from drystone.search.course_plan import CoursePlan, PlannedStone
from drystone.search.course_task import task_of
from drystone.search.courses import plan_courses, replan_courses, resumed
from drystone.search.laid_courses import LaidCourses, ground_of
from drystone.settle.rest import placed_outline
from tests.planner.scenes import blocks

TOLERANCE_PX = 0.35
QUICK = CourseSettings(evaluations=30)
"""Python looks at some 500 plans in a second."""

needs_compiled = pytest.mark.skipif(describe() == "Python", reason="kernels are not compiled here")


def bricks(count: int, halves: int = 0) -> StoneSet:
    """Bricks of 24 x 8 px."""
    return brick_stones(
        BrickSettings(count=count, halves=halves, height_px=8), np.random.default_rng(1)
    )


@pytest.fixture(scope="module")
def rubble() -> StoneSet:
    return rubble_stones(RubbleSettings(count=24), np.random.default_rng(3))


def outlines(plan: CoursePlan, stones: StoneSet) -> list[list[Points]]:
    """Where a plan's stones are."""
    return [
        [
            placed_outline(
                stones.by_id(stone.stone_id).outline_within(TOLERANCE_PX),
                stone.angle_deg,
                stone.x_px,
                stone.y_px,
            )
            for stone in course
        ]
        for course in plan.courses
    ]


def size_of(stones: StoneSet) -> tuple[float, float]:
    """A wall that most of the stones fill."""
    side = (0.8 * stones.total_area_px) ** 0.5
    return 1.6 * side, 0.8 * side


def test_a_plan_has_every_stone_at_most_once_inside_the_wall(rubble: StoneSet) -> None:
    width, height = size_of(rubble)
    book = PoseBook()
    plan = plan_courses(rubble.stones, width, height, 4.0, TOLERANCE_PX, QUICK, 1, book=book)
    assert plan is not None
    stones = [stone for course in plan.courses for stone in course]
    ids = [stone.stone_id for stone in stones]
    assert len(ids) == len(set(ids))
    assert set(ids) <= {stone.id for stone in rubble}
    assert len(ids) > len(rubble) // 2
    for stone, corners in zip(stones, chain(*outlines(plan, rubble)), strict=True):
        assert stone.angle_deg in book.angles(rubble.by_id(stone.stone_id), "quarter")
        assert corners[:, 0].min() == pytest.approx(stone.left_px)
        assert corners[:, 0].max() == pytest.approx(stone.right_px)
        # A unit is 1/8 px here.
        assert stone.left_px >= 0.0
        assert stone.right_px <= width + 0.125
        assert stone.top_px >= corners[:, 1].max() - 0.1 * (stone.right_px - stone.left_px)
    for course in plan.courses:
        left = [stone.left_px for stone in course if stone.side == "left"]
        right = [stone.left_px for stone in course if stone.side == "right"]
        assert left == sorted(left)
        assert right == sorted(right, reverse=True)
        assert [stone.side for stone in course] == ["left"] * len(left) + ["right"] * len(right)
        assert max(left, default=-np.inf) < min(right, default=np.inf)
    assert any(sum(stone.side == "right" for stone in course) > 1 for course in plan.courses)
    means = [np.mean([stone.y_px for stone in course]) for course in plan.courses]
    assert means == sorted(means)


def test_equal_seeds_give_equal_plans(rubble: StoneSet) -> None:
    def planned(seed: int) -> CoursePlan | None:
        return plan_courses(rubble.stones, *size_of(rubble), 4.0, TOLERANCE_PX, QUICK, seed)

    assert planned(5) == planned(5)
    assert planned(5) != planned(6)


def test_the_cost_is_that_of_the_plan(rubble: StoneSet) -> None:
    size = size_of(rubble)
    plan = plan_courses(rubble.stones, *size, 4.0, TOLERANCE_PX, QUICK, 2)
    task = task_of(rubble.stones, size, 4.0, TOLERANCE_PX, QUICK)
    assert plan is not None
    assert task is not None
    again = resumed(task, plan.courses)
    assert again is not None
    layout = evaluate(task.quarters.poses, again, task.ground, task.rules)
    assert layout.cost == plan.cost
    assert courses.placed(task, again, layout) == plan


@needs_compiled
def test_bricks_come_out_as_running_bond_with_level_courses() -> None:
    stones = bricks(14, halves=4)
    settings = CourseSettings(evaluations=3000)
    plan = plan_courses(stones.stones, 96.0, 32.0, 1.0, TOLERANCE_PX, settings, 1)
    assert plan is not None
    assert sum(len(course) for course in plan.courses) == 18
    assert len(plan.courses) == 4
    ends = []
    for row, course in enumerate(plan.courses):
        assert {round(stone.top_px, 2) for stone in course} == {8.0 * (row + 1)}
        assert min(stone.left_px for stone in course) == 0.0
        assert max(stone.right_px for stone in course) == 96.0
        ends.append([stone.right_px for stone in course if stone.right_px < 96.0])
    for below, above in pairwise(ends):
        assert min(abs(a - b) for a in above for b in below) == pytest.approx(12.0, abs=0.5)


@needs_compiled
@pytest.mark.parametrize("bricks_wide", [4, 4.5, 6, 7.5])
def test_whole_bricks_are_bonded_whether_they_fit_or_not(bricks_wide: float) -> None:
    """No head joint above another, though there are no halves; no end brick beside its bed."""
    stones, width = bricks(40), 24.0 * bricks_wide
    settings = CourseSettings(evaluations=1500)
    plan = plan_courses(stones.stones, width, 40.0, 1.0, TOLERANCE_PX, settings, 1)
    assert plan is not None
    assert len(plan.courses) == 5
    rows = [sorted((one.left_px, one.right_px) for one in course) for course in plan.courses]
    for below, above in pairwise(rows):
        for left, right in above:
            middle = (left + right) / 2
            assert below[0][0] < middle < below[-1][1]
    joints = [[0.5 * (a[1] + b[0]) for a, b in pairwise(row)] for row in rows]
    near = [
        min((abs(one - other) for other in below), default=99.0)
        for below, above in pairwise(joints)
        for one in above
    ]
    assert np.mean(np.array(near) >= 4.0) > 0.8


@needs_compiled
def test_a_wall_smaller_than_the_stock_is_filled_and_the_rest_left_out() -> None:
    stones = bricks(20)
    settings = CourseSettings(evaluations=500)
    plan = plan_courses(stones.stones, 72.0, 16.0, 1.0, TOLERANCE_PX, settings, 1)
    assert plan is not None
    assert max(stone.top_px for course in plan.courses for stone in course) <= 16.0
    # Three bricks fit a course; a bond leaves one out.
    assert [len(course) for course in plan.courses] in ([3, 3], [3, 2], [2, 3])


def test_stones_and_poses_that_do_not_fit_are_left_out() -> None:
    stones = bricks(6)
    large = Stone(7, np.ones((30, 90), bool))
    # Upright all are too high for this wall, and the large one is in any pose.
    plan = plan_courses((*stones, large), 80.0, 15.0, 1.0, TOLERANCE_PX, QUICK, 1)
    assert plan is not None
    used = [stone for course in plan.courses for stone in course]
    assert used
    assert all(stone.angle_deg in {0.0, -180.0, 180.0} for stone in used)
    assert 7 not in {stone.stone_id for stone in used}


@pytest.mark.parametrize("size", [(5.0, 100.0), (100.0, 5.0)])
def test_no_plan_without_a_stone_that_fits(size: tuple[float, float]) -> None:
    assert plan_courses(bricks(2).stones, *size, 1.0, TOLERANCE_PX, QUICK, 1) is None
    assert plan_courses((), 100.0, 100.0, 1.0, TOLERANCE_PX, QUICK, 1) is None


@needs_compiled
def test_upper_courses_are_planned_again_on_what_was_laid() -> None:
    stones = bricks(14, halves=4)
    settings = CourseSettings(evaluations=3000)
    wall = (96.0, 32.0, 1.0, TOLERANCE_PX)
    first = plan_courses(stones.stones, *wall, settings, 1)
    assert first is not None
    laid = LaidCourses.of(outlines(first, stones)[:2], 96.0, 1.0)
    assert np.unique(laid.tops_px).tolist() == pytest.approx([16.0], abs=0.01)
    there = {stone.stone_id for course in first.courses[:2] for stone in course}
    left = [stone for stone in stones if stone.id not in there]
    second = replan_courses(first, 2, left, *wall, settings=settings, seed=9, laid=laid)
    assert second is not None
    assert second.courses[:2] == first.courses[:2]
    upper = [stone for course in second.courses[2:] for stone in course]
    assert sorted(stone.stone_id for stone in upper) == sorted(stone.id for stone in left)
    assert min(stone.y_px for stone in upper) == pytest.approx(20.0, abs=0.05)
    below = [stone.right_px for stone in first.courses[1] if stone.right_px < 96.0]
    above = [stone.right_px for stone in second.courses[2] if stone.right_px < 96.0]
    assert min(abs(a - b) for a in above for b in below) == pytest.approx(12.0, abs=0.5)


def test_planning_again_without_upper_courses_starts_anew(rubble: StoneSet) -> None:
    wall = (*size_of(rubble), 4.0, TOLERANCE_PX)
    plan = plan_courses(rubble.stones, *wall, QUICK, 1)
    assert plan is not None
    laid = LaidCourses.of(outlines(plan, rubble)[:1], wall[0], 4.0)
    there = {stone.stone_id for stone in plan.courses[0]}
    left = [stone for stone in rubble if stone.id not in there]
    start = CoursePlan(plan.courses[:1], 0.0)
    again = replan_courses(start, 1, left, *wall, settings=QUICK, seed=1, laid=laid)
    assert again is not None
    assert len(again.courses) > 1
    assert replan_courses(plan, 1, [], *wall, settings=QUICK, seed=1, laid=laid) is None


def test_what_is_laid_has_joints_beds_and_ways() -> None:
    def block(left: float, bottom: float, right: float, top: float) -> Points:
        return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])

    first = [block(50.0, 0.0, 100.0, 12.0), block(2.0, 0.0, 48.0, 10.0)]
    second = [block(0.0, 10.0, 30.0, 20.0)]
    laid = LaidCourses.of([first, second, []], 100.0, 2.0)
    ground = ground_of(laid, (100.0, 60.0), 1.0)
    unit = 16
    assert ground.tops[[0, 40, 49, 70]].tolist() == [20 * unit, 10 * unit, 0, 12 * unit]
    assert ground.joints.tolist() == [[0, 0], [30 * unit, 100 * unit]]
    assert ground.beds.tolist() == [[10 * unit, 12 * unit, 2 * unit], [20 * unit, 20 * unit, 0]]
    # From the first start, at 19 px: to the left end, or to the head joint below what is free.
    assert ground.ways[0, 0] == (19 - 2) * unit
    assert ground.ways[1, 0] == (48 - 19) * unit
    assert (ground.width, ground.height) == (100 * unit, 60 * unit)
    with pytest.raises(ValueError, match="columns"):
        ground_of(LaidCourses(np.zeros(7)), (100.0, 60.0), 1.0)


def test_stones_too_wide_lying_are_planned_upright() -> None:
    long = Stone(1, np.ones((10, 60), bool))
    task = task_of((long, Stone(2, np.ones((9, 12), bool))), (20.0, 80.0), 1.0, 0.35, QUICK)
    assert task is not None
    assert task.quarters.angles_deg == ((90.0, -90.0) * 2, (0.0, 90.0, -180.0, -90.0))
    plan = plan_courses((long,), 20.0, 80.0, 1.0, TOLERANCE_PX, QUICK, 1)
    assert plan is not None
    assert plan.courses[0][0].angle_deg in (90.0, -90.0)


@pytest.mark.parametrize("seed", range(3))
def test_no_plan_has_more_courses_than_it_may(seed: int) -> None:
    """Half of the stones are slabs: the median stone is high, and few courses are allowed."""
    stones = blocks({k: (390, 4) if k <= 40 else (36, 36) for k in range(1, 82)})
    plan = plan_courses(
        list(stones), 400, 700, 2.0, 0.5, CourseSettings(evaluations=20), seed, book=PoseBook()
    )
    assert plan is not None


def test_a_plan_of_more_courses_than_are_allowed_now_is_cut() -> None:
    stones = blocks(dict.fromkeys(range(1, 21), (36, 36)))
    task = task_of(list(stones), (400.0, 80.0), 2.0, 0.5, CourseSettings())
    assert task is not None
    angles = dict(zip((s.id for s in task.quarters.stones), task.quarters.angles_deg, strict=True))
    single = [
        (PlannedStone(i, angles[i][0], "left", 18.0, 18.0, 0.0, 36.0, 36.0),) for i in range(1, 21)
    ]
    start = resumed(task, single)
    assert start is not None
    assert start.sizes.tolist() == [1] * task.rules.courses
    assert task.rules.courses < 20
    assert sorted(start.order.tolist()) == list(range(20))
