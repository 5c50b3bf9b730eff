"""Stones that are banned or pinned, and stones in a given order."""

from dataclasses import replace

import pytest

from drystone.errors import UsageError
from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from tests.planner.scenes import blocks, bricks, finish, greedy, ids, of_rubble, order


@pytest.mark.parametrize("changes", [{}, {"geometry": "raster"}, {"selection_rule": "algorithm2"}])
def test_stones_are_banned_pinned_or_in_a_given_order(changes):
    def built(more=None, steps=None):
        return of_rubble(greedy({**changes, **(more or {})}), steps, seed=1)

    free = ids(built())
    without = ids(built({"ban": free[1:3]}))
    assert without
    assert not set(without) & set(free[1:3])
    assert ids(built({"pin": free[-1:]})).index(free[-1]) < len(free) - 2
    given = built({"order": "given"})
    assert len(given.build.actions) >= 5
    assert ids(given) == sorted(ids(given))
    # What is built says where to go on.
    assert order(finish(built({"order": "given"}, 3))) == order(given)


def test_why_a_wall_ends_without_banned_stones():
    def said(changes, stones=3):
        settings = PlannerSettings().updated(changes)
        planner = finish(Planner(bricks(stones), Site(60, 10), settings=settings))
        return planner.stopped.text

    all_four = [stone.id for stone in bricks(4)]
    assert said({"ban": [all_four[0]]}) == "all stones that are not banned placed"
    assert said({}) == "filling above 0.99"
    assert said({}, 2) == "all stones placed"
    assert said({"ban": all_four[:3]}) == "all stones that are not banned placed"


def test_a_banned_stone_may_be_too_large():
    stones, site = blocks({1: (20, 10), 2: (200, 100), 3: (20, 10)}), Site(60, 20)
    with pytest.raises(UsageError, match="E120"):
        Workshop.prepare(stones, site, PlannerSettings())
    workshop = Workshop.prepare(stones, site, PlannerSettings(ban=(2,)))
    assert workshop.fitting == (1, 3)
    # Nobody waits for its sides, and wedges are numbered after all stones, banned ones too.
    assert sum(workshop.sides.values()) == 2
    assert Workshop.prepare(stones, site, PlannerSettings(ban=(2, 3))).stock.largest_id == 3


@pytest.mark.parametrize("name", ["ban", "pin"])
def test_unknown_stones_are_refused(name):
    with pytest.raises(UsageError, match="E145") as caught:
        of_rubble(greedy({name: [1, 77, 99]}))
    assert caught.value.where == f"--{name}"
    assert "77, 99" in caught.value.what


def test_what_finds_no_place_in_its_turn_is_set_aside():
    stones = blocks({1: (20, 10), 2: (70, 10), 3: (20, 10), 4: (20, 10), 5: (20, 10)})
    settings = greedy({"geometry": "raster", "order": "given", "orientations": "sf"})
    settings = replace(settings, skip_too_large=True)
    small = finish(Planner(stones, Site(60, 10), settings=settings))
    assert ids(small) == [1, 3, 4]
    assert small.stopped.reason == "filled"
    narrow = finish(Planner(stones, Site(45, 10), settings=settings))
    assert ids(narrow) == [1, 3]
    assert narrow.stopped.text == "no stone is left that was not tried in its turn"
