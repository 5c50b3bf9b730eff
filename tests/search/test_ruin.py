"""What is taken down: never a stone without what rests on it."""

from collections.abc import Iterator

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.planner.build import Build
from drystone.planner.planner import Planner
from drystone.planner.search_settings import SearchSettings
from drystone.search.chain import without
from drystone.search.ruin import RUINS, taken_down, with_all_above
from tests.planner.scenes import RUBBLE_SITE, blocks, finish, greedy, rubble


@pytest.fixture(scope="module")
def planner() -> Planner:
    settings = greedy({"search": {"budget": 2}})
    return finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))


def resting_pairs(build: Build) -> Iterator[tuple[int, int]]:
    """Stones and those that rest on them, from the interfaces one by one."""
    stones = {p.stone_id for p in build.wall.placements}
    for one in build.model.interfaces:
        if {one.block, one.other} <= stones and abs(one.normal[1]) > 0.5:
            yield (one.other, one.block) if one.normal[1] > 0 else (one.block, one.other)


@pytest.mark.parametrize("name", RUINS)
def test_what_rests_on_it_goes_too(name: str, planner: Planner) -> None:
    settings = SearchSettings(largest=0.5)
    sizes = set()
    for seed in range(12):
        rng = np.random.default_rng(seed)
        gone = taken_down(planner.build, RUINS[name], settings, rng)
        sizes.add(len(gone))
        placed = {p.stone_id for p in planner.build.wall.placements}
        assert gone
        assert gone <= placed
        assert all(high in gone for low, high in resting_pairs(planner.build) if low in gone)
        again = taken_down(planner.build, RUINS[name], settings, np.random.default_rng(seed))
        assert again == gone
    assert len(sizes) > 1


def test_a_pile_comes_down_from_the_stone_on() -> None:
    settings = greedy({"search": {"budget": 2}})
    stones = blocks({1: (20, 10), 2: (20, 10), 3: (20, 10)})
    pile = finish(Planner(stones, Site(20, 30), settings=settings)).build
    low, middle, high = (p.stone_id for p in pile.wall.placements)
    assert with_all_above(pile, frozenset({low})) == {low, middle, high}
    assert with_all_above(pile, frozenset({middle})) == {middle, high}
    assert with_all_above(pile, frozenset({high})) == {high}


def test_joint_paths_are_those_of_the_wall_not_of_the_air_above_it() -> None:
    settings = greedy({"search": {"budget": 2}})
    stones = blocks(dict.fromkeys(range(1, 6), (20, 10)))
    pile = finish(Planner(stones, Site(20, 300), settings=settings)).build
    *lower, highest = (p.stone_id for p in pile.wall.placements)
    draws = [RUINS["joint"](pile, 1, np.random.default_rng(seed)) for seed in range(40)]
    assert set().union(*draws) == {*lower, highest}
    assert draws.count(frozenset({highest})) < 20


def test_what_stays_is_where_it_was(planner: Planner) -> None:
    build = planner.build
    first = build.wall.placements[0].stone_id
    gone = with_all_above(build, frozenset({first}))
    left = without(build, gone, planner.workshop, planner.settings).build
    before = {p.stone_id: p for p in build.wall.placements}
    kept = list(left.wall.placements)
    assert gone.isdisjoint(p.stone_id for p in kept)
    for p in kept:
        was = before[p.stone_id]
        assert p.posed.angle_deg == was.posed.angle_deg
        if p.settled is None:
            assert (p.row, p.col) == (was.row, was.col)
        else:
            assert was.settled is not None
            assert (p.settled.corners == was.settled.corners).all()
    assert all(a.resistance.stable and a.sturdy for a in left.actions)
    assert without(build, frozenset(), planner.workshop, planner.settings).build is build
