"""Repairs of a wall: what falls or moves in it is laid elsewhere, wedged, or left open."""

import math
from collections import Counter
from dataclasses import replace

import pytest

from drystone import Planner, Site
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.search.goal import THOROUGH, FoundWall, Rehearsals, is_high
from drystone.search.processes import processes
from drystone.search.repair import AROUND, _better, _changes, repairs
from drystone.search.yard import Yard
from tests.planner import scenes


@pytest.fixture(scope="module")
def careless():
    return scenes.careless(0, Site.from_source(160, 100, 0.5))


@pytest.fixture(scope="module")
def wall(careless):
    """What it has built."""
    return FoundWall.of(careless).judged(Yard.of(careless), THOROUGH)


@pytest.fixture(scope="module")
def repaired(careless, wall):
    """Its repairs of one turn, and how often the clock was looked at."""
    clock = scenes.Ticks()
    return list(repairs(careless, wall, Deadline(math.inf, clock), turns=1)), clock.count


def test_stones_that_fall_in_rehearsals_are_taken_out_or_laid_elsewhere(careless, wall, repaired):
    # Stone 12 falls as it is laid, or when 2 is.
    assert wall.falls.first == Counter({12: 5, 4: 1})
    assert wall.falls.begins == Counter({2: 3, 12: 2, 4: 1})
    ((better,), _) = repaired
    often = Rehearsals(Yard.of(careless), 20, 99)
    share = often.falls(wall.build).share
    assert often.falls(better.build).share < 0.7 * share
    nothing = FoundWall.of(Planner(scenes.bricks(), Site(60, 20), settings=careless.settings))
    assert {one.build for one in repairs(careless, nothing)} == {nothing.build}


def test_stones_that_move_when_the_wall_fails_are_taken_out_or_laid_elsewhere():
    stones = scenes.blocks({1: (40, 12), 2: (40, 12), 3: (8, 24)})
    goal = {"fallen": 0.0, "filling": 1.0}  # strength counts for more than a small stone
    careless = {"settle": {"trials": 0}, "orientations": "sf"}
    settings = scenes.greedy({"search": {"budget": 2}, "goal": goal, **careless})
    planner = scenes.finish(Planner(stones, Site(42, 60), settings=settings))
    wall = FoundWall.of(planner).judged(Yard.of(planner), THOROUGH)
    assert wall.movers == (3,)  # the slender one on top
    assert wall.figures.F_LR_coulomb == pytest.approx(8 / 24 / 0.58, abs=0.03)
    (better,) = repairs(planner, wall, turns=1)
    assert scenes.ids(better) == [1, 2]
    assert better.figures.F_LR_coulomb == pytest.approx(1.0)


def told(walls):
    return [(wall.merit, scenes.ids(wall)) for wall in walls]


def test_processes_find_the_repairs_that_one_alone_finds(careless, wall, repaired):
    alone = told(repaired[0])
    assert alone[-1][0] > wall.merit
    with processes(2) as workers:
        assert told(repairs(careless, wall, turns=1, executor=workers)) == alone


def test_what_was_repaired_before_time_is_up_stays(careless, wall, repaired):
    whole, looks = repaired
    late = repairs(careless, wall, scenes.after_looks(looks + 5))
    assert told([next(late)]) == told(whole)
    with pytest.raises(TimeIsUp):
        next(late)
    with pytest.raises(TimeIsUp):
        next(repairs(careless, wall, scenes.after_looks(0)))


def test_other_stones_are_tried_after_a_turn_without_a_repair(wall):
    first, last = scenes.ids(wall)[:6], scenes.ids(wall)[-3:]
    tried = [_changes(wall, Counter(first), Counter(last), misses) for misses in range(3)]
    for misses, changes in enumerate(tried):
        alone = {one.stones for one in changes if not one.wedged}
        assert {frozenset([first[misses]]), frozenset([last[misses]])} < alone
        assert all(len(one.stones) == 1 for one in changes if one.wedged)
        around = [one.stones for one in changes if len(one.stones) == AROUND + misses]
        assert any(first[misses] in stones for stones in around)
    assert [sum(one.wedged for one in changes) for changes in tried] == [4, 2, 0]
    # Nothing falls or moves.
    assert _changes(replace(wall, movers=()), Counter(), Counter(), 0) == []


def test_a_repair_that_makes_a_complete_wall_too_low_must_gain_more(careless, wall):
    yard, rehearsals = Yard.of(careless), Rehearsals(Yard.of(careless), 4)
    low = FoundWall.measured(careless.build.states()[3], yard)
    assert is_high(wall.build.wall)
    assert not is_high(low.build.wall)
    merit = low.judged(yard, THOROUGH, rehearsals=rehearsals).merit

    def taken(best, gain):
        before = replace(best, merit=merit - gain)
        return len(_better(before, [low], THOROUGH, rehearsals, yard))

    assert [taken(wall, gain) for gain in (0.05, 0.3, 0.6)] == [0, 0, 1]
    assert [taken(low, gain) for gain in (0.05, 0.3, 0.6)] == [0, 1, 1]
