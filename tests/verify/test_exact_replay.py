"""Walls of outlines are built again from the input stones and the plan alone."""

import json
from dataclasses import replace

import numpy as np
import pytest

from drystone.errors import PlanError
from drystone.generate import PolygonSettings, polygon_stones
from drystone.io.plan_json import plan_from_json, plan_to_json
from drystone.model.placement import Placement
from drystone.model.plan import Plan
from drystone.model.stone import StoneSet
from drystone.model.wall import Wall
from drystone.planner.settings import method_settings
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import plan_wall
from drystone.verify.check import check_plan
from drystone.verify.replay import rebuild_wall, replay_plan
from tests.verify.exact_examples import exact_example
from tests.verify.examples import SLAB, WEDGE
from tests.verify.tampering import changed, moved, reshaped

ROUNDING_PX = 1e-9
"""Of lengths that were in metres."""


def stone_set() -> StoneSet:
    settings = PolygonSettings(count=8, width_px=44, height_px=28)
    return polygon_stones(settings, np.random.default_rng(4))


def planned(
    stones: StoneSet,
    px_per_m: float | None,
    built: Wall | None = None,
    rounds: int = 1,
    heights: dict[int, float] | None = None,
) -> PlanResult:
    settings = method_settings("best").updated(
        {"geometry": "exact", "search": {"budget": rounds + 1}}
    )
    how = {"seed": 3, "settings": settings, "scale": 0.5, "px_per_m": px_per_m}
    return plan_wall(stones, 160, 90, built=built, course_heights_px=heights, **how)


def read_again(plan: Plan) -> Plan:
    return plan_from_json(json.loads(json.dumps(plan_to_json(plan))))


@pytest.fixture(scope="module")
def made() -> tuple[PlanResult, StoneSet]:
    stones = stone_set()
    return planned(stones, 437.0), stones


def raster_part(placement: Placement) -> tuple[object, ...]:
    """What has no lengths in units of the plan."""
    posed = placement.posed
    pixels = posed.mask.shape, posed.mask.tobytes(), placement.row, placement.col
    said = placement.stone_id, posed.angle_deg, placement.side, placement.rotation_moves
    return *said, *pixels


def test_wall_of_the_planner_is_rebuilt_and_its_plan_passes(
    made: tuple[PlanResult, StoneSet],
) -> None:
    result, stones = made
    report = check_plan(read_again(result.plan), stones, wall_labels=result.wall.labels)
    assert (report.problems, report.overlap_depth) == ((), 0.0)
    found = rebuild_wall(read_again(result.plan), stones)
    np.testing.assert_array_equal(found.labels, result.wall.labels)
    assert len(found.placements) == len(result.wall.placements) >= 5
    for mine, its in zip(found.placements, result.wall.placements, strict=True):
        assert raster_part(mine) == raster_part(its)
        rounding = ROUNDING_PX
        np.testing.assert_allclose(mine.exact.corners, its.exact.corners, rtol=0, atol=rounding)
        assert mine.exact.x_px == pytest.approx(its.exact.x_px, rel=0, abs=rounding)
        np.testing.assert_allclose(mine.posed.anchor, its.posed.anchor, rtol=0, atol=rounding)


def test_going_on_from_a_partial_plan_gives_the_same_plan() -> None:
    stones, stones_built = stone_set(), 4
    whole = planned(stones, None, rounds=0)
    steps = whole.plan.steps[:stones_built]
    built = rebuild_wall(read_again(replace(whole.plan, steps=steps)), stones)
    heights = {
        step.stone: step.course_height * 0.5
        for step in whole.plan.stone_steps[:stones_built]
        if step.course_height is not None
    }
    again = planned(stones, None, built, rounds=0, heights=heights)
    assert json.dumps(plan_to_json(again.plan)) == json.dumps(plan_to_json(whole.plan))
    assert again.wall.labels.tobytes() == whole.wall.labels.tobytes()


@pytest.mark.parametrize(
    ("scale", "px_per_m"), [(1.0, None), (1.0, 137.0), (0.5, None), (0.5, 211.3)]
)
def test_wall_with_a_wedge_is_rebuilt(scale: float, px_per_m: float | None) -> None:
    example = exact_example(scale, px_per_m)
    found = rebuild_wall(read_again(example.plan), example.stones)
    np.testing.assert_array_equal(found.labels, example.wall.labels)
    (mine,), (its,) = found.wedges, example.wall.wedges
    assert (mine.id, mine.under, mine.row, mine.col) == (WEDGE, SLAB, its.row, its.col)
    np.testing.assert_array_equal(mine.mask, its.mask)
    assert mine.corners is not None
    np.testing.assert_allclose(mine.corners, its.corners, rtol=0, atol=ROUNDING_PX)


def test_wall_that_cannot_be_built_is_refused_with_the_step() -> None:
    example = exact_example()
    others = StoneSet(tuple(stone for stone in example.stones if stone.id != SLAB))
    with pytest.raises(PlanError, match="E212") as caught:
        rebuild_wall(example.plan, others)
    assert caught.value.where == "step 3"
    unknown = replace(example.plan, settings={**example.plan.settings, "wings": 2})
    with pytest.raises(PlanError, match="E217") as caught:
        rebuild_wall(unknown, example.stones)
    assert caught.value.where == "settings"


def test_pieces_that_overlap_stay_in_the_replay_and_the_wall_ends_before() -> None:
    example = exact_example()
    replay = replay_plan(moved(example.plan, 5, -25, 0), example.stones)
    assert replay.broken_at == 2
    assert [p.code for p in replay.problems if p.step == 2] == ["E221"]
    assert [p.stone_id for p in replay.wall.placements] == [3]
    assert len(replay.pieces) == 6
    assert 5 in replay.labels
    # A stone hidden in another has no pixel.
    replay = replay_plan(moved(example.plan, 300, 4 - 74, 4), example.stones)
    assert [p.code for p in replay.problems] == ["E221"]
    assert replay.pieces[-1].item is None


@pytest.mark.parametrize(
    ("right", "expected"), [(84.48, []), (84.52, []), (84.78, []), (84.8, ["E220"])]
)
def test_the_outline_decides_whether_a_stone_is_in_the_wall(
    right: float, expected: list[str]
) -> None:
    # A wall of 84.49 px has 84 columns; a stone may fill half of the next one, and .3 px more.
    example = exact_example()
    plan = moved(replace(example.plan, width=84.49), 300, right - 84, 0)
    assert [p.code for p in replay_plan(plan, example.stones).problems] == expected


def test_wedge_may_fill_no_pixel_and_is_a_block_nevertheless() -> None:
    example = exact_example(scale=0.1, count=3)
    assert WEDGE not in example.wall.labels
    replay = replay_plan(read_again(example.plan), example.stones)
    assert replay.problems == ()
    np.testing.assert_array_equal(replay.labels, example.wall.labels)
    (wedge,) = replay.wall.wedges
    assert wedge.mask.size == 0
    report = check_plan(example.plan, example.stones, wall_labels=example.wall.labels)
    # What a wedge may be does not depend on the working px.
    assert report.problems == ()


def test_wedge_of_huge_size_is_refused_before_it_is_drawn() -> None:
    example = exact_example()
    replay = replay_plan(reshaped(example.plan, lambda w: w * 1e12), example.stones)
    assert [p.code for p in replay.problems] == ["E220"]
    replay = replay_plan(changed(example.plan, 3, centroid=(1e300, 10.0)), example.stones)
    assert [p.code for p in replay.problems] == ["E220"]
