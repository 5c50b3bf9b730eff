"""Walls that a search keeps beside the best, pinned stones, and a given order."""

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.planner.planner import Planner
from drystone.search.anytime import Progress
from drystone.search.archive import archived
from drystone.search.chain import recreated
from drystone.search.found import Found
from drystone.search.plan_wall import plan_wall
from drystone.verify.check import check_plan
from tests.planner.scenes import RUBBLE_SITE, blocks, finish, greedy, rubble
from tests.search.test_anytime import SMALL, first, same, searched


def kept(progress: Progress) -> list[tuple[float, object]]:
    return [
        (wall.merit, [(g.stone_id, g.angle_deg, g.side) for g in wall.groups])
        for wall in progress.kept
    ]


def test_the_walls_that_are_kept_depend_on_the_budget_alone() -> None:
    one, two = searched(first(7, seed=4)), searched(first(7, seed=4), jobs=2)
    assert [kept(a) for a in one] == [kept(b) for b in two]
    for part in one[2:-1]:
        assert kept(searched(first(part.walls, seed=4))[-1]) == kept(part)


def test_the_best_is_among_them_and_none_beats_another() -> None:
    found = searched(first(12, seed=4))
    assert max(len(progress.kept) for progress in found) > 1
    for progress in found:
        assert same(progress.kept[0], progress.best)
        assert archived((), progress.kept) == progress.kept


def test_what_is_kept_becomes_plans_that_hold() -> None:
    settings = greedy({"search": {"budget": 12, **SMALL}})
    result = plan_wall(rubble(), 100, 36, scale=1.0, seed=4, settings=settings, choice=True)
    assert len(result.choice) > 1
    assert result.choice[0].plan == result.plan
    for one in result.choice:
        report = check_plan(one.plan, rubble(), wall_labels=one.wall.labels)
        assert report.problems == ()
    assert plan_wall(rubble(), 100, 36, scale=1.0, seed=4, settings=greedy()).choice == ()


def ids(wall: Wall) -> list[int]:
    return [placement.stone_id for placement in wall.placements]


def test_a_search_finds_a_wall_with_what_is_pinned() -> None:
    free = plan_wall(rubble(), 60, 36, scale=1.0, seed=1, settings=greedy())
    pin = [stone.id for stone in rubble() if stone.id not in ids(free.wall)][:2]
    assert len(pin) == 2
    settings = greedy({"pin": pin, "search": {"budget": 6, **SMALL}})
    result = plan_wall(rubble(), 60, 36, scale=1.0, seed=1, settings=settings)
    assert set(pin) <= set(ids(result.wall))
    assert result.notices == ()


def test_a_full_wall_is_incomplete_without_a_pinned_stone() -> None:
    settings = greedy({"geometry": "raster"})
    large = blocks({**dict.fromkeys(range(1, 7), (20, 10)), 7: (90, 90)})
    pinned = settings.updated({"pin": [7], "skip_too_large": True})
    without = settings.updated({"skip_too_large": True})
    assert plan_wall(large, 60, 20, scale=1.0, settings=without).status == "complete"
    result = plan_wall(large, 60, 20, scale=1.0, settings=pinned)
    assert (result.status, result.metrics.F_SF) == ("incomplete", 1.0)
    assert result.shortfall == "stones that are pinned are missing"
    assert [notice.code for notice in result.notices] == ["W120"]
    planner = finish(Planner(large, Site(60, 20), settings=pinned))
    found = Found.of(planner)
    assert found.figures is not None
    assert found.figures.missing == 1


def test_in_a_given_order_the_last_stones_are_built_again() -> None:
    settings = greedy({"order": "given", "search": {"budget": 2}})
    planner = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))
    found, rng = Found.of(planner), np.random.default_rng(0)
    count = len(planner.build.actions)
    most = round(settings.search.largest * count)
    before = [action.stone_id for action in planner.build.actions]
    walls = set()
    for _ in range(8):
        again = recreated(found, planner.workshop, planner.settings, rng)
        after = [action.stone_id for action in again.build.actions]
        assert after[: count - most] == before[: count - most]
        walls.add(again.build.wall.labels.tobytes())
    assert walls - {planner.build.wall.labels.tobytes()}


def test_a_missing_pinned_stone_makes_a_wall_incomplete() -> None:
    settings = greedy({"skip_too_large": True, "pin": [1, 2, 3, 4, 5, 6, 7, 8]})
    result = plan_wall(rubble(), 60, 20, scale=1.0, seed=1, settings=settings)
    missing = sorted({1, 2, 3, 4, 5, 6, 7, 8} - set(ids(result.wall)))
    assert missing
    assert result.status == "incomplete"
    (notice,) = [n for n in result.notices if n.code == "W120"]
    assert ", ".join(map(str, missing)) in notice.message


def test_a_search_keeps_a_given_order() -> None:
    settings = greedy({"order": "given", "search": {"budget": 12, **SMALL}})
    planner = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))
    found = searched(planner)
    assert found[-1].best.merit > found[0].best.merit
    for wall in (wall for progress in found for wall in (progress.best, *progress.kept)):
        order = [group.stone_id for group in wall.groups]
        assert order == sorted(order)
        assert wall.courses is None


def test_the_bound_is_the_area_of_what_may_be_used() -> None:
    stones = rubble()
    area = sum(stone.area_px for stone in stones)
    free = plan_wall(stones, 100, 36, scale=0.7, settings=greedy())
    assert free.F_SF_bound == pytest.approx(area / 3600)
    assert free.metrics.F_SF <= free.F_SF_bound
    without = plan_wall(stones, 100, 36, scale=0.7, settings=greedy({"ban": [3]}))
    assert without.F_SF_bound == pytest.approx((area - stones.by_id(3).area_px) / 3600)
    assert without.metrics.F_SF <= without.F_SF_bound
    assert plan_wall(stones, 60, 30, scale=0.7, settings=greedy()).F_SF_bound == 1.0
