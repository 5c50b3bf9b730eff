"""Planning course by course: plans, the walls laid by them, and what is changed of walls."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from drystone import Planner, Site, Stone
from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.kernels.backend import describe
from drystone.kernels.courses import evaluate
from drystone.planner.evaluate import Evaluator
from drystone.planner.search_settings import CourseSettings, SearchSettings
from drystone.planner.workshop import Workshop
from drystone.poses import PoseBook
from drystone.search import by_courses
from drystone.search.by_courses import newly_planned, relaid, replanned
from drystone.search.chain import recreated, without
from drystone.search.course_task import ground_of, task_of
from drystone.search.courses import CoursePlan, PlannedStone, placed, plan_courses, resumed
from drystone.search.goal import FoundWall
from drystone.search.operators import NEW, OPERATORS, RECREATED, RELAID, REPLANNED, Credits, shares
from drystone.search.packed import PackedWall, found_again
from drystone.search.ruin import RUINS, joint, taken_down, with_all_above
from drystone.search.yard import Yard
from drystone.settle.rest import settled_at
from drystone.statics.incremental import IncrementalResult
from tests.planner import scenes
from tests.polygons import box
from tests.statics.walls import gave_up

TOLERANCE_PX = 0.35
QUICK = CourseSettings(evaluations=30)
"""Python looks at some 500 plans in a second."""

RUBBLE = rubble_stones(RubbleSettings(count=24), np.random.default_rng(3))

needs_compiled = pytest.mark.skipif(describe() == "Python", reason="kernels are not compiled here")


def bricks(count, halves=0):
    """Bricks of 24 x 8 px."""
    size = BrickSettings(count=count, halves=halves, height_px=8)
    return brick_stones(size, np.random.default_rng(1))


def task(stones, size, cell_px=1.0, settings=QUICK, **options):
    return task_of(stones, size, cell_px, TOLERANCE_PX, settings, **options)


def outline_of(stones, planned):
    outline = stones.by_id(planned.stone_id).outline_within(TOLERANCE_PX)
    return settled_at(outline, planned.angle_deg, planned.x_px, planned.y_px).corners


def wall_for(stones, share):
    """A wall of a share of the stones' area, twice as wide as high."""
    side = (0.5 * share * stones.total_area_px) ** 0.5
    return 2.0 * side, side


SIZE = wall_for(RUBBLE, 1.024)


def test_equal_seeds_give_equal_plans_with_every_stone_at_most_once_inside_the_wall():
    book = PoseBook()
    one = task(RUBBLE.stones, SIZE, 4.0, book=book)
    plan = plan_courses(one, 1)
    assert plan_courses(one, 1) == plan != plan_courses(one, 6)
    again = resumed(one, plan.courses)
    assert placed(one, again, evaluate(one.poses, again, one.ground, one.rules)) == plan
    stones = [stone for course in plan.courses for stone in course]
    ids = [stone.stone_id for stone in stones]
    assert len(ids) == len(set(ids)) > len(RUBBLE) // 2
    for stone in stones:
        corners = outline_of(RUBBLE, stone)
        assert stone.angle_deg in book.angles(RUBBLE.by_id(stone.stone_id), "quarter")
        assert corners[:, 0].min() == pytest.approx(stone.left_px)
        assert corners[:, 0].max() == pytest.approx(stone.right_px)
        # A unit is 1/8 px here.
        assert stone.left_px >= 0.0
        assert stone.right_px <= SIZE[0] + 0.125
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


@needs_compiled
def test_bricks_come_out_as_running_bond_and_again_on_what_was_laid():
    stones = bricks(14, halves=4)
    wall, settings = (96.0, 32.0), CourseSettings(evaluations=3000)
    first = plan_courses(task(stones.stones, wall, settings=settings), 1)
    laid = [[outline_of(stones, one) for one in course] for course in first.courses[:2]]
    there = {stone.stone_id for course in first.courses[:2] for stone in course}
    left = [stone for stone in stones if stone.id not in there]
    upper = task(left, wall, settings=settings, laid=laid)
    assert np.unique(upper.ground.tops).tolist() == [16 * 32]
    second = plan_courses(upper, 9, begun=first, keep=2)
    assert second.courses[:2] == first.courses[:2]
    for plan in (first, second):
        assert sorted(one.stone_id for course in plan.courses for one in course) == [*range(1, 19)]
        ends = []
        for row, course in enumerate(plan.courses):
            assert {round(stone.top_px, 1) for stone in course} == {8.0 * (row + 1)}
            assert min(stone.left_px for stone in course) == 0.0
            assert max(stone.right_px for stone in course) == 96.0
            ends.append([stone.right_px for stone in course if stone.right_px < 96.0])
        assert len(ends) == 4
        for below, above in pairwise(ends):
            assert min(abs(a - b) for a in above for b in below) == pytest.approx(12.0, abs=0.5)


@needs_compiled
@pytest.mark.parametrize("bricks_wide", [4, 4.5, 7.5])
def test_whole_bricks_are_bonded_whether_they_fit_or_not(bricks_wide):
    """No head joint above another, though there are no halves; no end brick beside its bed."""
    size = (24.0 * bricks_wide, 40.0)
    plan = plan_courses(task(bricks(40).stones, size, settings=CourseSettings(evaluations=1500)), 1)
    # The rest is left out.
    assert len(plan.courses) == 5
    assert max(stone.top_px for course in plan.courses for stone in course) <= 40.0
    rows = [sorted((one.left_px, one.right_px) for one in course) for course in plan.courses]
    for below, above in pairwise(rows):
        assert all(below[0][0] < sum(ends) / 2 < below[-1][1] for ends in above)
    joints = [[0.5 * (a[1] + b[0]) for a, b in pairwise(row)] for row in rows]
    near = [
        min((abs(one - other) for other in below), default=99.0)
        for below, above in pairwise(joints)
        for one in above
    ]
    assert np.mean(np.array(near) >= 4.0) > 0.8


def test_stones_and_poses_that_do_not_fit_are_left_out():
    large = Stone(7, np.ones((30, 90), bool))
    # Upright all are too high for this wall, and the large one is in any pose.
    plan = plan_courses(task((*bricks(6), large), (80.0, 15.0)), 1)
    used = [stone for course in plan.courses for stone in course]
    assert used
    assert all(stone.angle_deg in {0.0, -180.0, 180.0} for stone in used)
    assert 7 not in {stone.stone_id for stone in used}
    long = Stone(1, np.ones((10, 60), bool))
    upright = task((long, Stone(2, np.ones((9, 12), bool))), (20.0, 80.0))
    assert upright.angles_deg == ((90.0, -90.0) * 2, (0.0, 90.0, -180.0, -90.0))
    for size in ((5.0, 100.0), (100.0, 5.0)):
        assert task_of(bricks(2).stones, size, 1.0, TOLERANCE_PX, QUICK) is None
    assert task_of((), (100.0, 100.0), 1.0, TOLERANCE_PX, QUICK) is None


def test_planning_again_without_upper_courses_starts_anew():
    plan = plan_courses(task(RUBBLE.stones, SIZE, 4.0), 1)
    there = {one.stone_id: outline_of(RUBBLE, one) for one in plan.courses[0]}
    left = [stone for stone in RUBBLE if stone.id not in there]
    upper, start = (
        task(left, SIZE, 4.0, laid=[[*there.values()]]),
        CoursePlan(plan.courses[:1], 0.0),
    )
    assert len(plan_courses(upper, 1, begun=start, keep=1).courses) > 1


def test_what_is_laid_has_joints_beds_and_ways():
    first = [box(50.0, 0.0, 100.0, 12.0), box(2.0, 0.0, 48.0, 10.0)]
    second = [box(0.0, 10.0, 30.0, 20.0)]
    ground = ground_of([first, second, []], (100.0, 60.0), 1.0)
    unit = 16
    assert ground.tops[[0, 40, 49, 70]].tolist() == [20 * unit, 10 * unit, 0, 12 * unit]
    assert ground.joints.tolist() == [[0, 0], [30 * unit, 100 * unit]]
    assert ground.beds.tolist() == [[10 * unit, 12 * unit, 2 * unit], [20 * unit, 20 * unit, 0]]
    # From the first start, at 19 px: to the left end, or to the head joint below what is free.
    assert ground.ways[0, 0] == (19 - 2) * unit
    assert ground.ways[1, 0] == (48 - 19) * unit
    assert (ground.width, ground.height) == (100 * unit, 60 * unit)


def test_no_plan_has_more_courses_than_it_may():
    """Half of the stones are slabs: the median stone is high, and few courses are allowed."""
    slabs = scenes.blocks({k: (390, 4) if k <= 40 else (36, 36) for k in range(1, 82)})
    many = task(list(slabs), (400.0, 700.0), 2.0, CourseSettings(evaluations=20))
    assert 0 < len(plan_courses(many, 0).courses) <= many.rules.courses < 81
    # Nor where one of more courses is gone on from.
    one = task(list(scenes.blocks(dict.fromkeys(range(1, 21), (36, 36)))), (400.0, 80.0), 2.0)
    angles = dict(zip((s.id for s in one.stones), one.angles_deg, strict=True))
    single = [
        (PlannedStone(i, angles[i][0], "left", 18.0, 18.0, 0.0, 36.0, 36.0),) for i in range(1, 21)
    ]
    start = resumed(one, single)
    assert start.sizes.tolist() == [1] * one.rules.courses
    assert one.rules.courses < 20
    assert sorted(start.order.tolist()) == list(range(20))


def chosen(share):
    return task(RUBBLE.stones, wall_for(RUBBLE, share), 4.0, CourseSettings())


def test_a_stock_that_is_about_enough_changes_nothing_until_a_part_is_laid():
    for share in (0.7, 1.0, 1.5):
        one = chosen(share)
        assert one.choosing(()).rules == one.rules
    assert one.taken == 24
    one = chosen(0.8)
    tops = np.full_like(one.ground.tops, round(0.3 * one.ground.height))
    later = replace(one, ground=one.ground._replace(tops=tops))
    assert later.choosing(()).rules != later.rules
    # With plenty, standing out is worse than being left out.
    one = chosen(0.25)
    weights, changed = one.rules.weights, one.choosing(()).rules.weights
    assert one.taken == pytest.approx(0.25 * 24, abs=2)
    share = one.taken / 24
    assert (changed.across, changed.down) == (weights.across * share, weights.down * share)
    assert changed.left_out < weights.left_out
    assert changed.high > max(2.0 * changed.left_out * one.poses.area.mean(), 2.0 * weights.high)


def test_pinned_stones_are_left_out_last():
    few = task(RUBBLE.stones, wall_for(RUBBLE, 0.3), 4.0)

    def ids(pinned):
        plan = plan_courses(few, 1, pinned=pinned)
        return {stone.stone_id for course in plan.courses for stone in course}

    free = ids([])
    assert len(free) < 16
    left = sorted({stone.id for stone in RUBBLE} - free)[:3]
    assert set(left) <= ids(left)


rng = np.random.default_rng


def yard_of(site=scenes.RUBBLE_SITE, **changes):
    settings = scenes.greedy({"search": {"budget": 2}, **changes})
    return Yard(Workshop.prepare(scenes.rubble(), site, settings), settings)


@pytest.fixture(scope="module")
def yard():
    return yard_of()


@pytest.fixture(scope="module")
def first_plan(yard):
    # Not the cheapest plan of all, which would only be found again.
    return newly_planned(yard, rng(5))


def poses(found):
    placed = [(p, p.settled) for p in found.build.wall.placements if p.settled]
    return [(p.stone_id, p.posed.angle_deg, at.corners.tobytes()) for p, at in placed]


def check(found, yard):
    """The wall stands at every step, and the ends of its courses are those of its steps."""
    courses, build = found.courses, found.build
    assert courses.ends[0] == 0
    assert list(courses.ends) == sorted(courses.ends)
    assert courses.ends[-1] <= len(build.actions)
    assert len(courses.ends) == len(courses.plan.courses) + 1
    stones = [stone.stone_id for course in courses.plan.courses for stone in course]
    assert len(set(stones)) == len(stones)
    assert len(build.states()) == len(build.actions) + 1
    assert all(a.sturdy and a.resistance.stable for a in build.actions)
    placed = [p.stone_id for p in build.wall.placements]
    assert len(set(placed)) == len(placed)
    measured = FoundWall.measured(build, yard)
    assert (measured.figures, measured.merit) == (found.figures, found.merit)


def test_a_plan_is_laid_and_the_rest_goes_on_top(first_plan, yard):
    check(first_plan, yard)
    assert first_plan.figures.stones >= 6
    again, *others = (newly_planned(yard, rng(seed)) for seed in (5, 3, 4))
    assert poses(again) == poses(first_plan)
    assert any(other is not None and poses(other) != poses(first_plan) for other in others)
    begun = yard.planner()
    begun.build = first_plan.build
    scenes.proven(scenes.result_of(begun), yard.workshop.stones)


@pytest.mark.parametrize("change", [replanned, relaid])
def test_lower_courses_stay(change, first_plan, yard, monkeypatch):
    begun = scenes.watched(monkeypatch, by_courses, "lay")
    ends, changed = first_plan.courses.ends, set[int]()
    for seed in range(6):
        new = change(first_plan, yard, rng(seed))
        check(new, yard)
        same = [a == b for a, b in zip(poses(new), poses(first_plan), strict=False)]
        count = same.index(False) if False in same else len(same)
        # How many stay is what is drawn first.
        kept = int(rng(seed).integers(len(ends) - 1))
        (_, start, *_), _ = begun.pop()
        assert len(start.actions) == ends[kept] <= count
        if poses(new) != poses(first_plan):
            changed.add(kept)
    assert changed - {0}


def test_it_goes_through_a_message(first_plan, yard):
    packed = PackedWall.of(first_plan)
    again = found_again(packed, yard)
    assert poses(again) == poses(first_plan)
    assert (again.courses, again.merit) == (first_plan.courses, first_plan.merit)
    # What does not stand as it stood is an error, not another wall.
    with pytest.raises(ValueError, match="do not stand"):
        found_again(packed, yard_of(mu=0.01))


@pytest.mark.parametrize("change", [newly_planned, relaid, recreated])
def test_every_solve_that_failed_is_counted(change, first_plan, yard, monkeypatch):
    """While a plan is laid, while steps are taken again, and while stones are added."""
    solved, solve = [], Evaluator.loaded

    def gives_up(*arguments):
        loaded = solve(*arguments)
        solved.append(len(solved) % 3 == 2)
        return replace(loaded, grown=IncrementalResult(gave_up())) if solved[-1] else loaded

    monkeypatch.setattr(Evaluator, "loaded", gives_up)
    known = () if change is newly_planned else (first_plan,)
    found = change(*known, yard, rng(5))
    assert found.solves.failed == sum(solved) > 0


@pytest.fixture(scope="module")
def free(yard):
    """A wall that was not planned."""
    return scenes.finish(yard.planner(1)).build


@pytest.mark.parametrize("ruin", RUINS)
def test_what_rests_on_what_is_taken_down_goes_too(ruin, free):
    settings, sizes = SearchSettings(largest=0.5), set()
    placed = {p.stone_id for p in free.wall.placements}
    resting = [
        (one.other, one.block) if one.normal[1] > 0 else (one.block, one.other)
        for one in free.model.interfaces
        if {one.block, one.other} <= placed and abs(one.normal[1]) > 0.5
    ]
    for seed in range(12):
        gone = taken_down(free, ruin, settings, rng(seed))
        sizes.add(len(gone))
        assert gone
        assert gone <= placed
        assert all(high in gone for low, high in resting if low in gone)
        assert taken_down(free, ruin, settings, rng(seed)) == gone
    assert len(sizes) > 1


def test_joint_paths_are_those_of_the_wall_not_of_the_air_above_it():
    stones = scenes.blocks(dict.fromkeys(range(1, 6), (20, 10)))
    pile = scenes.finish(Planner(stones, Site(20, 300), settings=scenes.greedy())).build
    *lower, highest = (p.stone_id for p in pile.wall.placements)
    draws = [joint(pile, 1, rng(seed)) for seed in range(40)]
    assert set().union(*draws) == {*lower, highest}
    assert draws.count(frozenset({highest})) < 20
    low = scenes.finish(Planner(stones, Site(20, 30), settings=scenes.greedy())).build
    first, second, third = (p.stone_id for p in low.wall.placements)
    assert with_all_above(low, frozenset({first})) == {first, second, third}
    assert with_all_above(low, frozenset({second})) == {second, third}


def test_what_stays_is_where_it_was(free, yard):
    first = free.wall.placements[0].stone_id
    gone = with_all_above(free, frozenset({first}))
    left = without(free, gone, yard).build
    before = {p.stone_id: p for p in free.wall.placements}
    assert gone.isdisjoint(p.stone_id for p in left.wall.placements)
    for p in left.wall.placements:
        was = before[p.stone_id]
        assert p.posed.angle_deg == was.posed.angle_deg
        assert (p.exact.corners == was.exact.corners).all()
    assert all(a.resistance.stable and a.sturdy for a in left.actions)
    assert without(free, frozenset(), yard).build is free


def drawn(known, *, planned):
    draws, usual = rng(0), shares(planned=planned, polish=0.2)
    return Counter(known.drawn(usual, draws) for _ in range(2000))


def used(operator, times, helped):
    known = Credits()
    for k in range(times):
        known = known.after(operator, helped=k < helped)
    return known


def test_what_has_helped_is_drawn_more_often_and_nothing_is_given_up():
    known = used(RELAID, 30, 12) + used(RECREATED, 30, 0)
    assert dict(zip(OPERATORS, known.uses, strict=True)) == {
        RECREATED: 30, RELAID: 30, REPLANNED: 0, NEW: 0,
    }  # fmt: skip
    assert known.helped[OPERATORS.index(RELAID)] == sum(known.helped) == 12
    counts, before = drawn(known, planned=True), drawn(Credits(), planned=True)
    # Before anything is known they are drawn by their shares.
    usual = shares(planned=True, polish=0.2)
    for operator, share in zip(OPERATORS, usual, strict=True):
        assert abs(before[operator] / 2000 - share / sum(usual)) < 0.04
    assert counts[RELAID] > 1.5 * before[RELAID]
    assert 0 < counts[RECREATED] < 0.3 * before[RECREATED]
    assert min(counts[REPLANNED], counts[NEW]) > 0
    # A wall without a plan is only built up again.
    assert set(drawn(used(RECREATED, 50, 0), planned=False)) == {RECREATED}
