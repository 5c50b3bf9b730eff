"""How a search ends: its best wall with what still finds a place, and the others as found."""

import math
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from drystone import generate
from drystone.model.site import Site
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.events import INTERRUPTED, Stopped
from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from drystone.search.chain import _opened
from drystone.search.goal import FoundWall, Rehearsals
from drystone.search.packed import PackedWall
from drystone.search.plan_wall import plan_wall
from drystone.search.whole_search import (
    THOROUGH,
    as_found,
    repaired,
    run_to_end,
    stays_at_every_step,
    surest,
    with_the_rest,
)
from drystone.search.yard import Yard
from tests.planner import scenes
from tests.planner.scenes import ids

FEW = {"search": {"budget": 4, "passes": 4, "chains": 2, "share_every": 2}}


STONES = scenes.rubble(count=5)


def small_search():
    return plan_wall(STONES, 100, 36, scale=1.0, seed=2, settings=scenes.greedy(FEW), choice=True)


@pytest.fixture(scope="module")
def planner():
    """One that has built a whole wall, than which its search finds a better one."""
    settings = scenes.greedy({"search": {"budget": 3}, "goal": {"fallen": 0.0}})
    return scenes.finish(Planner(STONES, scenes.RUBBLE_SITE, seed=3, settings=settings))


@pytest.fixture(scope="module")
def found(planner):
    """The end of its search."""
    return run_to_end(planner)


def half_of(planner):
    """A wall on which there is room."""
    half = Planner(STONES, scenes.RUBBLE_SITE, settings=planner.settings)
    half.build = planner.build.states()[len(planner.build.actions) // 2]
    return PackedWall.of(FoundWall.of(half))


def test_stones_that_find_a_place_stay_where_that_is_better(planner):
    half = half_of(planner)
    before = [group.stone_id for group in half.groups]
    whole, stopped, _ = with_the_rest(planner, half)
    assert ids(whole)[: len(before)] == before
    assert len(ids(whole)) > len(before)
    assert stopped == whole.stopped
    left, why, interrupted = with_the_rest(planner, replace(half, merit=math.inf))
    assert not interrupted
    assert ids(left) == before
    assert why == Stopped("search", "the stones that are left do not make the wall better")


def test_stones_that_fall_in_rehearsals_are_taken_out_or_laid_elsewhere():
    careless = scenes.greedy({"search": {"budget": 2}, "settle": {"trials": 0}})
    site = Site.from_source(160, 100, 0.5)
    planner = scenes.finish(Planner(scenes.ROUNDED, site, seed=2, settings=careless))
    yard = Yard.of(planner)
    wall = FoundWall.of(planner).judged(yard, THOROUGH)
    assert wall.falls.first
    better = repaired(planner, wall, turns=1)
    often = Rehearsals(yard, 20, 99)
    share = often.falls(wall.build).share
    assert often.falls(better.build).share < 0.7 * share
    nothing = FoundWall.of(Planner(scenes.bricks(), Site(60, 20), settings=careless))
    assert repaired(planner, nothing).build is nothing.build


def test_stones_that_move_when_the_wall_fails_are_taken_out_or_laid_elsewhere():
    stones = scenes.blocks({1: (40, 12), 2: (40, 12), 3: (8, 24)})
    goal = {"fallen": 0.0, "filling": 1.0}  # strength counts for more than a small stone
    careless = {"settle": {"trials": 0}, "orientations": "sf"}
    settings = scenes.greedy({"search": {"budget": 2}, "goal": goal, **careless})
    planner = scenes.finish(Planner(stones, Site(42, 60), settings=settings))
    wall = FoundWall.of(planner).judged(Yard.of(planner), THOROUGH)
    assert wall.movers == (3,)  # the slender one on top
    assert wall.figures.F_LR_coulomb == pytest.approx(8 / 24 / 0.58, abs=0.03)
    better = repaired(planner, wall)
    assert ids(better) == [1, 2]
    assert better.figures.F_LR_coulomb == pytest.approx(1.0)


def test_a_wall_to_choose_is_as_it_was_found(planner):
    half = half_of(planner)
    found, why = as_found(planner, half)
    assert ids(found) == [group.stone_id for group in half.groups]
    assert why.reason == "search"
    filled = planner.settings.updated({"stop": {"filling": 0.1}})
    full = Planner(STONES, scenes.RUBBLE_SITE, settings=filled)
    assert as_found(full, half)[1] == Stopped("filled", "filling above 0.1")


@pytest.mark.parametrize("place", ["surest", "repaired", "with_the_rest"])
def test_an_interrupt_at_the_end_keeps_the_best_as_it_was_found(place, planner, found, monkeypatch):

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(f"drystone.search.whole_search.{place}", interrupt)
    cut = run_to_end(planner)
    assert (cut.stopped, cut.walls) == (INTERRUPTED, found.walls)
    best = max(found.kept, key=lambda wall: wall.merit)
    assert ids(cut.planner) == [group.stone_id for group in best.groups]


def test_a_repair_that_time_cuts_off_is_said(planner, found, monkeypatch):
    assert not found.cut

    def up(*_):
        raise TimeIsUp

    monkeypatch.setattr("drystone.search.whole_search.repaired", up)
    assert run_to_end(planner).cut


def test_time_that_is_up_at_the_end_loses_nothing(planner):
    half, clock = half_of(planner), scenes.Ticks()
    before = [group.stone_id for group in half.groups]
    whole, _, interrupted = with_the_rest(planner, half, Deadline(math.inf, clock))
    assert not interrupted
    placed = set()
    for share in (0.0, 0.5, 0.9):
        found, why, interrupted = with_the_rest(
            planner, half, scenes.after_looks(int(share * clock.count))
        )
        assert interrupted
        assert why.reason == "search"
        assert ids(found)[: len(before)] == before
        assert ids(whole)[: len(ids(found))] == ids(found)
        placed.add(len(ids(found)))
    assert len(placed) > 1
    # Nor is there time for stones that do not make the wall better.
    assert with_the_rest(planner, replace(half, merit=math.inf), scenes.after_looks(0))[2]
    with pytest.raises(TimeIsUp):
        as_found(planner, half, scenes.after_looks(0))


def test_of_walls_that_there_is_no_time_to_judge_the_first_is_taken(planner):
    half, clock = half_of(planner), scenes.Ticks()
    # Nobody knows yet that it carries less than it seems to.
    whole = PackedWall.of(FoundWall.of(planner))
    walls = [replace(half, merit=whole.merit + 2.0), replace(whole, merit=whole.merit + 1.0)]
    best, interrupted = surest(planner, walls, Deadline(math.inf, clock))
    assert (len(best.build.actions), interrupted) == (len(whole.groups), False)
    assert surest(planner, walls, scenes.after_looks(0)) == (None, True)
    # The half was judged, and the other one was not.
    judged, interrupted = surest(planner, walls, scenes.after_looks(clock.count - 1))
    assert (len(judged.build.actions), interrupted) == (len(half.groups), True)
    assert judged.merit < walls[0].merit


def test_walls_to_choose_that_there_is_no_time_for_are_left_out(monkeypatch):
    limits = iter([Deadline(), Deadline(), scenes.after_looks(0)])
    monkeypatch.setattr(Deadline, "after", lambda *_: next(limits))
    result = small_search()
    assert [one.plan for one in result.choice] == [result.plan]
    assert [notice.code for notice in result.notices] == ["W125"]
    assert result.metrics.F_LR is not None
    assert result.metrics.F_LR_coulomb is None


def test_an_interrupt_while_others_are_finished_keeps_the_best(monkeypatch):
    whole = small_search()
    assert len(whole.choice) > 1
    assert _opened.cache_info().currsize == 0  # nothing is kept in memory

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("drystone.search.plan_wall.as_found", interrupted)
    result = small_search()
    assert (result.status, result.plan.stopped) == ("interrupted", "interrupted")
    assert result.plan.steps == whole.plan.steps
    assert result.choice == ()


def score(result):
    m = result.metrics
    return (m.F_SF, m.F_AV or 0.0, -(m.F_AH or 0.0), m.F_LR or 0.0)


def test_none_of_the_walls_to_choose_is_better_than_another():
    """With the weights of the settings stones find a place that had none by those of a pass."""
    settings = generate.RubbleSettings(count=12)
    stones = generate.rubble_stones(settings, np.random.default_rng(14))
    area = sum(stone.area_px for stone in stones)
    width = (area * 1.6) ** 0.5 * 1.3
    search = {"budget": 5, "passes": 5, "chains": 2, "share_every": 2}
    more = {"skip_too_large": True, "search": search, "goal": {"fallen": 0.0}}
    few = method_settings("best").updated(more)
    result = plan_wall(
        stones, round(width), round(area * 1.25 / width), seed=14, settings=few, choice=True
    )
    assert len(result.choice) > 1
    assert result.choice[0].plan == result.plan
    for one, other in permutations(result.choice, 2):
        assert not all(a >= b for a, b in zip(score(one), score(other), strict=True))


def test_a_wall_that_falls_when_it_is_let_go_gives_way_to_one_that_stays(planner, monkeypatch):
    whole, half = PackedWall.of(FoundWall.of(planner)), half_of(planner)
    walls = sorted((whole, half), key=lambda wall: -wall.merit)
    best, _ = surest(planner, walls)
    assert stays_at_every_step(planner.build)
    lost = len(best.build.actions)

    def fall(model, *_):
        return len(model.blocks) == lost or None

    monkeypatch.setattr("drystone.search.whole_search.fall_of", fall)
    other, _ = surest(planner, walls)
    assert len(other.build.actions) != lost
    monkeypatch.setattr("drystone.search.whole_search.fall_of", lambda *_: True)
    again, _ = surest(planner, walls)
    assert again.merit == best.merit  # all fall
