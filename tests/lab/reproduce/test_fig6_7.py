import numpy as np
import pytest

from drystone_lab.reproduce import fig6_7
from drystone_lab.reproduce.construction import amid_course
from drystone_lab.reproduce.fig6_7 import action_at, recounted, resting_places
from tests.lab.reproduce.small_walls import RUBBLE, built, gids, of, rows
from tests.naive.support import rests_stably

EVERY = 4
"""Columns that are looked at slowly: each of so many."""


MADE = of(fig6_7.INDICES, RUBBLE)


@pytest.fixture(scope="module")
def moment(folder):
    return amid_course(built(folder, RUBBLE))[0]


@pytest.fixture(scope="module")
def places(moment):
    return resting_places(moment)


def test_places_are_all_at_which_a_stone_rests(moment, places):
    stone_id = moment.remaining[0]
    posed = moment.workshop.poses(stone_id)[0]
    occupied, mask = moment.wall.occupied, posed.mask
    height, width = occupied.shape
    expected = {
        (row, col)
        for row in range(height - mask.shape[0] + 1)
        for col in range(0, width - mask.shape[1] + 1, EVERY)
        if not np.any(occupied[row : row + mask.shape[0], col : col + mask.shape[1]] & mask)
        and rests_stably(occupied, mask, row, col, col + posed.anchor[0], 0.0)
    }
    found = {(p.row, p.col) for p in places if p.posed is posed}
    assert {place for place in found if place[1] % EVERY == 0} == expected != set()
    assert {p.posed.stone.id for p in places} <= set(moment.remaining)


def test_extremes_are_the_least_and_the_largest(output, places):
    for row in rows(output, "extremes"):
        name = row["index"]
        values = [place.values[name] for place in places if name in place.values]
        best = (row["case"] == "favourable") == (name != "NHR")
        assert row["value"] == pytest.approx(max(values) if best else min(values), abs=1e-4)


def test_counting_again_agrees_everywhere(moment, places):
    seen = set()
    for place in places[::7]:
        action = action_at(moment, place.posed, place.row, place.col)
        for name in place.values.keys() - {"SF"}:
            again = recounted(action, name)
            if again is not None:
                assert again == pytest.approx(place.values[name], abs=1e-12), (name, place.order)
                seen.add(name)
    assert seen == {"LFR", "GDS", "NHR", "IWR", "IS"}


def test_the_stone_of_fig7_stands_where_the_run_left_it(folder, output, moment):
    run = built(folder, RUBBLE)
    placed = run.stages[moment.number - 1].group.placement
    table = rows(output, "fig7")
    assert {row["stone"] for row in table} == {placed.stone_id}
    assert {row["index"] for row in table} >= {"NHR", "IWR"}
    claimed = run.stages[moment.number - 1].stone.indices
    for row in table:
        assert row["value"] == pytest.approx(claimed[row["index"]], abs=1e-4)


def test_pictures_show_what_is_measured(output):
    six = gids(output, "fig6")
    assert six.count("stone") == 12
    assert {"box", "begun", "rays"} <= set(six)
    assert [six.count(mark) for mark in ("begun", "rays", "box")] == [2, 2, 2]
    seven = set(gids(output, "fig7"))
    assert {"stone", "rays", "begun", "box", "top", "joint", "offset", "slope", "name"} <= seven
