"""Walls that the planner builds: courses, bridges, wedges and ids."""

import numpy as np
import pytest

from drystone.model.landscape import Landscape
from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.planner.evaluate import Evaluator
from drystone.planner.planner import Planner
from drystone.planner.profile import Profile
from drystone.planner.proposing import RasterProposer, StoneTrial
from drystone.planner.settings import PlannerSettings
from drystone.search.plan_result import mean_top
from drystone.search.plan_wall import plan_wall, working_scale
from drystone.verify import check_plan
from tests.planner.scenes import RUBBLE_SITE, blocks, bricks, greedy, rubble


def _longest_run(free):
    longest = run = 0
    for cell in free.tolist():
        run = run + 1 if cell else 0
        longest = max(longest, run)
    return longest


@pytest.mark.parametrize(
    ("stones", "site"),
    [
        (rubble(0, 10), RUBBLE_SITE),
        (rubble(1, 10), RUBBLE_SITE),
        (bricks(9, halves=2), Site(60, 40)),
    ],
    ids=["rubble 0", "rubble 1", "bricks"],
)
def test_the_default_finishes_the_first_course_before_the_second(stones, site):
    # DESIGN 4.4: when a stone is laid higher than the ground, no stone that is left would have
    # found room on the ground.
    planner = Planner(stones, site, settings=greedy())
    before, left, above = planner.build.wall.occupied, {stone.id for stone in stones}, 0
    for step in planner.steps():
        placement = step.action.stabilised.placement
        bottom = site.height_px - placement.row - placement.posed.height_px
        if bottom > 2:
            above += 1
            room = _longest_run(np.asarray(~before.any(axis=0)))
            narrowest = min(p.width_px for i in left for p in planner.workshop.poses(i))
            assert room < narrowest
        before = planner.build.wall.occupied
        left.remove(step.action.stone_id)
    assert above >= 4


def _scene(sizes, places, settings):
    """A planner with some blocks placed by their left and bottom edges, 60 px wide."""
    planner = Planner(blocks(sizes), Site(60, 40), settings=settings)
    workshop = planner.workshop
    wall = planner.build.wall
    for stone_id, (left, bottom) in places.items():
        posed = workshop.initial(stone_id)
        wall = wall.add(Placement(posed, 40 - bottom - posed.height_px, left))
    planner.restore(wall, {})
    return planner


def _candidate(planner, stone_id):
    workshop, settings, build = planner.workshop, planner.settings, planner.build
    proposer = RasterProposer(workshop, settings, build, Profile())
    view = Landscape.of(build.wall)
    proposal = proposer.stabilised(proposer.spotted(StoneTrial(workshop.poses(stone_id), view)))
    return Evaluator(settings, workshop.stock).judge(build, view, proposal)


@pytest.mark.parametrize(
    "settings", [PlannerSettings(), greedy({"geometry": "raster"})], ids=["paper", "best"]
)
def test_a_stone_bridges_two_pillars_without_a_wedge(settings):
    sizes = {1: (20, 20), 2: (20, 20), 3: (60, 8)}
    candidate = _candidate(_scene(sizes, {1: (0, 0), 2: (40, 0)}, settings), 3)
    placement = candidate.stabilised.placement
    assert (placement.row, placement.col, placement.rotation_moves) == (12, 0, 0)
    assert candidate.stabilised.wedges == ()
    assert candidate.resistance.stable
    assert candidate.resistance.value > 0.3


@pytest.mark.parametrize("ids", [(3, 5, 7), (70_000, 300, 5), (300, 1, 70_000)])
def test_wedges_are_numbered_after_the_largest_id(ids):
    """A slab that one pillar carries at its end, and a lower pillar does not reach."""
    high, low, slab = ids
    settings = PlannerSettings().updated({"stabilise": {"method": "wedge"}})
    sizes = {high: (20, 20), low: (20, 16), slab: (60, 8)}
    planner = _scene(sizes, {high: (0, 0), low: (40, 0)}, settings)
    build = planner.build.add(_candidate(planner, slab))
    wedges = build.wall.wedges
    assert [wedge.id for wedge in wedges] == [max(ids) + 1]
    assert wedges[0].under == ids[2]
    assert {int(label) for label in np.unique(build.wall.labels)} == {0, *ids, max(ids) + 1}
    assert build.actions[-1].resistance.stable


def test_the_result_in_one_call():
    stones = rubble()
    result = plan_wall(stones, 100, 36, scale=1.0, method="paper", seed=3)
    assert result.message == result.plan.stopped
    assert result.success == (result.status == "complete")
    assert (result.plan.method, result.plan.seed) == ("paper", 3)
    assert result.plan.settings == PlannerSettings().as_dict()
    assert result.metrics is result.plan.metrics
    assert set(result.clusters) == {stone.id for stone in stones}
    assert result.seconds > 0
    assert check_plan(result.plan, stones, wall_labels=result.wall.labels).ok


def test_what_is_incomplete(monkeypatch):
    # Half of the wall's height with all stones: not filled, and its top is too low.
    result = plan_wall(bricks(3), 60, 20, scale=1.0, method="paper")
    assert (result.status, result.message) == ("incomplete", "all stones placed")
    assert mean_top(result.wall) == pytest.approx(0.5)
    assert result.shortfall == (
        "the top is at 0.500 of the wall's height on average, less than 0.9"
    )
    # A wall that is as high as wanted is complete though it has gaps.
    tall = plan_wall(blocks({1: (58, 20)}), 60, 20, scale=1.0, method="paper")
    assert tall.metrics.F_SF < 0.99
    assert (tall.status, tall.success, tall.shortfall) == ("complete", True, "")
    # What is just too low does not read as high enough.
    monkeypatch.setattr("drystone.search.plan_result.mean_top", lambda _: 0.8999)
    result = plan_wall(bricks(3), 60, 20, scale=1.0, method="paper")
    assert "at 0.899 of the wall's height on average, less than 0.9" in result.shortfall


def test_the_working_resolution():
    assert working_scale(bricks()) == 1.0  # never finer than the source
    large = blocks({1: (160, 80), 2: (200, 80), 3: (240, 100)})
    assert working_scale(large) == 0.2  # 40 / 200
    plan = plan_wall(large, 640, 240, method="paper").plan
    assert plan.working_scale == 0.2
    assert (plan.width, plan.height) == (640.0, 240.0)
