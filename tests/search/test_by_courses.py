"""Walls that are planned course by course and laid, and what is changed of them and others."""

from collections import Counter
from dataclasses import replace
from functools import partial, partialmethod

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.planner.evaluate import Evaluator
from drystone.planner.planner import Planner
from drystone.planner.search_settings import SearchSettings
from drystone.planner.workshop import Workshop
from drystone.search.by_courses import newly_planned, relaid, replanned
from drystone.search.chain import recreated, without
from drystone.search.goal import FoundWall
from drystone.search.mason import lay
from drystone.search.operators import NEW, OPERATORS, RECREATED, RELAID, REPLANNED, Credits, shares
from drystone.search.packed import PackedWall, found_again
from drystone.search.ruin import RUINS, joint, taken_down, with_all_above
from drystone.search.yard import Yard
from drystone.statics.incremental import IncrementalResult
from tests.planner import scenes
from tests.planner.scenes import RUBBLE_SITE, blocks, greedy, rubble


def rng(seed):
    return np.random.default_rng(seed)


def yard_of(site=RUBBLE_SITE, **changes):
    settings = greedy({"search": {"budget": 2}, **changes})
    return Yard(Workshop.prepare(rubble(), site, settings), settings)


@pytest.fixture(scope="module")
def yard():
    return yard_of()


@pytest.fixture(scope="module")
def planned(yard):
    # Not the cheapest plan of all, which would only be found again.
    return newly_planned(yard, rng(14))


def poses(found):
    """Stones, angles and corners in the order of placement."""
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


def test_a_plan_is_laid_and_the_rest_goes_on_top(planned, yard):
    check(planned, yard)
    assert planned.figures.stones >= 6
    again, *others = (newly_planned(yard, rng(seed)) for seed in (14, 3, 4))
    assert poses(again) == poses(planned)
    assert any(other is not None and poses(other) != poses(planned) for other in others)
    begun = yard.planner()
    begun.build = planned.build
    scenes.proven(scenes.result_of(begun), yard.workshop.stones)


@pytest.mark.parametrize("change", [replanned, relaid])
def test_lower_courses_stay(change, planned, yard, monkeypatch):
    begun = []

    def spied(plan, start, *rest):
        begun.append(len(start.actions))
        return lay(plan, start, *rest)

    monkeypatch.setattr("drystone.search.by_courses.lay", spied)
    ends, changed = planned.courses.ends, set[int]()
    for seed in range(4):
        new = change(planned, yard, rng(seed))
        check(new, yard)
        same = [a == b for a, b in zip(poses(new), poses(planned), strict=False)]
        count = same.index(False) if False in same else len(same)
        # How many stay is what is drawn first.
        kept = int(rng(seed).integers(len(ends) - 1))
        assert begun.pop() == ends[kept] <= count
        if poses(new) != poses(planned):
            changed.add(kept)
    assert changed - {0}


def test_it_goes_through_a_message(planned, yard):
    packed = PackedWall.of(planned)
    again = found_again(packed, yard)
    assert poses(again) == poses(planned)
    assert (again.courses, again.merit) == (planned.courses, planned.merit)
    # What does not stand as it stood is an error, not another wall.
    with pytest.raises(ValueError, match="do not stand"):
        found_again(packed, yard_of(mu=0.01))


@pytest.mark.parametrize("change", [newly_planned, relaid, recreated])
def test_every_solve_that_failed_is_counted(change, planned, yard, monkeypatch):
    """While a plan is laid, while steps are taken again, and while stones are added."""
    solved = []

    def gives_up(solve, *arguments):
        loaded = solve(*arguments)
        failed = len(solved) % 3 == 2
        solved.append(failed)
        return replace(loaded, grown=IncrementalResult(scenes.gave_up())) if failed else loaded

    fails = partial(gives_up, Evaluator.loaded)
    monkeypatch.setattr(Evaluator, "loaded", partialmethod(fails))
    known = () if change is newly_planned else (planned,)
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
    stones = blocks(dict.fromkeys(range(1, 6), (20, 10)))
    pile = scenes.finish(Planner(stones, Site(20, 300), settings=greedy())).build
    *lower, highest = (p.stone_id for p in pile.wall.placements)
    draws = [joint(pile, 1, rng(seed)) for seed in range(40)]
    assert set().union(*draws) == {*lower, highest}
    assert draws.count(frozenset({highest})) < 20
    low = scenes.finish(Planner(stones, Site(20, 30), settings=greedy())).build
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
