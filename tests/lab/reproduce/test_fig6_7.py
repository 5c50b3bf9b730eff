import numpy as np
import pytest

from drystone_lab.reproduce import fig6_7
from drystone_lab.reproduce.construction import action_at, amid_course, resting_places
from drystone_lab.reproduce.fig6_7 import recounted
from tests.lab.reproduce.small_walls import RUBBLE, built, context, gids, of, rows
from tests.naive import indices as naive
from tests.naive.rays import local_filling_ratio
from tests.naive.support import rests_stably

EVERY = 4
"""Columns that are looked at slowly: each of so many."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("runs")


@pytest.fixture(scope="module")
def output(folder):
    return of(fig6_7.INDICES, RUBBLE).make(context(folder))


@pytest.fixture(scope="module")
def moment(folder):
    return amid_course(built(folder, RUBBLE))[0]


@pytest.fixture(scope="module")
def places(moment):
    return resting_places(moment)


def naive_index(moment, place, name):
    labels, occupied = moment.wall.labels, moment.wall.occupied
    stone = naive.painted(labels.shape, place.posed.mask, place.row, place.col)
    end = moment.workshop.stock.narrowest_px
    if name == "SF":
        return naive_shape(place.posed)
    return {
        "LFR": lambda: local_filling_ratio(occupied, place.posed.mask, place.row, place.col),
        "GDS": lambda: naive.dice_score(occupied, stone),
        "NHR": lambda: naive.neighbour_height_ratio(labels, stone, []),
        "IWR": lambda: naive.interlocking(labels, stone, end),
        "IS": lambda: naive.inward_slope(stone, place.col + place.posed.anchor[0]),
    }[name]()


def naive_shape(posed):
    corners = np.concatenate([np.argwhere(posed.stone.mask) + d for d in np.ndindex(2, 2)])
    angle = np.radians(posed.angle_deg)
    # Rows count downwards, so the sense of turning is the other one.
    x = corners @ [np.sin(angle), np.cos(angle)]
    y = corners @ [np.cos(angle), -np.sin(angle)]
    return posed.stone.area_px / (np.ptp(x) * np.ptp(y))


def test_places_are_all_at_which_a_stone_rests(moment, places):
    stone_id = moment.remaining[0]
    (posed,) = moment.workshop.poses(stone_id)
    occupied, mask = moment.wall.occupied, posed.mask
    height, width = occupied.shape
    expected = {
        (row, col)
        for row in range(height - mask.shape[0] + 1)
        for col in range(0, width - mask.shape[1] + 1, EVERY)
        if not np.any(occupied[row : row + mask.shape[0], col : col + mask.shape[1]] & mask)
        and rests_stably(occupied, mask, row, col, col + posed.anchor[0], 0.0)
    }
    found = {(p.row, p.col) for p in places if p.posed.stone.id == stone_id}
    assert {place for place in found if place[1] % EVERY == 0} == expected != set()
    assert {p.posed.stone.id for p in places} <= set(moment.remaining)


def test_extremes_are_the_least_and_the_largest(output, places):
    for row in rows(output, "extremes"):
        name = row["index"]
        values = [place.values[name] for place in places if name in place.values]
        best = (row["case"] == "favourable") == (name != "NHR")
        assert row["value"] == pytest.approx(max(values) if best else min(values), abs=1e-4)


def test_values_are_those_of_slow_definitions(output, moment, places):
    checked = set()
    for row in rows(output, "extremes"):
        (place,) = [
            place for place in places
            if place.posed.stone.id == row["stone"] and place.col == row["left px"]
            and moment.wall.site.height_px - place.row - place.posed.height_px == row["bottom px"]
        ]  # fmt: skip
        expected = naive_index(moment, place, row["index"])
        assert row["value"] == pytest.approx(expected, abs=1e-4), row
        if row["index"] != "SF":
            assert row["counted again"] in (None, pytest.approx(expected, abs=1e-4))
        checked.add(row["index"])
    assert checked == {"SF", "LFR", "GDS", "NHR", "IWR", "IS"}


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


def test_swept_pixels_are_those_of_rays(moment, places):
    place = places[0]
    action = action_at(moment, place.posed, place.row, place.col)
    stone = set(zip(*map(np.ndarray.tolist, np.nonzero(action.stone_pixels)), strict=True))
    height = action.labels.shape[0]
    swept = {(r, x) for r, c in stone for x in range(c)}
    swept |= {(y, c) for r, c in stone for y in range(r + 1, height)}
    assert set(map(tuple, np.argwhere(action.swept).tolist())) == swept - stone


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
