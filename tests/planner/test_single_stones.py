"""Stones that are banned or pinned, and stones in a given order."""

from dataclasses import replace

import pytest

from drystone.errors import UsageError
from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from tests.planner.scenes import RUBBLE_SITE, blocks, bricks, finish, greedy, ids, order, rubble


@pytest.mark.parametrize("changes", [{}, {"geometry": "raster"}, {"selection_rule": "algorithm2"}])
def test_banned_stones_are_not_used(changes):
    free = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=greedy(changes)))
    ban = ids(free)[1:3]
    settings = greedy({**changes, "ban": ban})
    planner = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))
    assert planner.build.actions
    assert not set(ids(planner)) & set(ban)


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
        Planner(rubble(), RUBBLE_SITE, settings=greedy({name: [1, 77, 99]}))
    assert caught.value.where == f"--{name}"
    assert "77, 99" in caught.value.what


@pytest.mark.parametrize("value", [7, [1.5], [True], ["7"], {"a": 1}])
def test_ids_are_a_list_of_whole_numbers(value):
    with pytest.raises(UsageError, match="E123"):
        PlannerSettings().updated({"pin": value})


def test_no_stone_is_pinned_and_banned():
    with pytest.raises(UsageError, match=r"E123.*: 3\."):
        PlannerSettings().updated({"pin": [1, 3], "ban": [3, 4]})


def test_lists_of_settings_are_lists():
    settings = PlannerSettings().updated({"ban": [3], "pin": [1, 2]})
    assert (settings.ban, settings.pin) == ((3,), (1, 2))
    written = settings.as_dict()
    assert (written["ban"], written["pin"]) == ([3], [1, 2])
    assert PlannerSettings().updated(written) == settings


@pytest.mark.parametrize(
    "changes", [{}, {"geometry": "raster"}, {"selection_rule": "algorithm2", "sampling": "variant"}]
)
def test_a_pinned_stone_goes_in_earlier(changes):
    free = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=greedy(changes)))
    last = ids(free)[-1]
    settings = greedy({**changes, "pin": [last]})
    planner = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))
    assert ids(planner).index(last) < len(free.build.actions) - 2


@pytest.mark.parametrize("changes", [{}, {"geometry": "raster"}, {"selection_rule": "algorithm2"}])
def test_in_a_given_order_ids_ascend(changes):
    settings = greedy({**changes, "order": "given"})
    planner = finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings))
    assert len(planner.build.actions) >= 5
    assert ids(planner) == sorted(ids(planner))
    # What is built says where to go on.
    again = Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings)
    for step in again.steps():
        if step.number == 3:
            break
    assert order(finish(again)) == order(planner)


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
