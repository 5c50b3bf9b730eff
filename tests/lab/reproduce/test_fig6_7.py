import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.model.landscape import Box
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone_lab.reproduce import fig6_7
from drystone_lab.reproduce.construction import amid_course
from drystone_lab.reproduce.fig6_7 import action_at, recounted, resting_places
from tests.lab.reproduce.small_walls import RUBBLE, built, gids, of, rows
from tests.naive.support import rests_stably

EVERY = 4
"""Columns that are looked at slowly: each of so many."""
MADE = of("fig6-7", RUBBLE)


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
    stage = built(folder, RUBBLE).stages[moment.number - 1]
    table = rows(output, "fig7")
    assert {row["stone"] for row in table} == {stage.group.placement.stone_id}
    assert {row["index"] for row in table} >= {"NHR", "IWR"}
    for row in table:
        assert row["value"] == pytest.approx(stage.stone.indices[row["index"]], abs=1e-4)


def test_pictures_show_what_is_measured(output):
    six = gids(output, "fig6")
    assert [six.count(mark) for mark in ("stone", "begun", "rays", "box")] == [12, 2, 2, 2]
    seven = set(gids(output, "fig7"))
    assert {"stone", "rays", "begun", "box", "top", "joint", "offset", "slope", "name"} <= seven


LABELS = np.zeros((10, 20), np.uint32)
LABELS[6:, :6] = 1
LABELS[6:, 6:12] = 2
LABELS[2:6, :5] = 3
MASK = np.ones((3, 4), bool)
POSED = PosedStone(Stone(9, MASK), 0.0, 1.0, MASK, (2.0, 1.5))
SWEPT = np.zeros((10, 20), bool)
SWEPT[3:6, :5] = SWEPT[6:, 5:9] = True
ACTION = fig6_7.ActionView(
    LABELS, POSED, 3, 5, SWEPT, 8, (3, Box(0, 5, 4, 8)),
    ((1, Box(0, 6, 0, 4)), (2, Box(6, 12, 0, 4))), (0, 3),
)  # fmt: skip


def fills(ax):
    return {patch.get_gid(): to_hex(patch.get_facecolor()) for patch in ax.patches}


def drawn(ax, gid):
    return [line.get_xydata().tolist() for line in ax.lines if line.get_gid() == gid]


def test_only_what_is_asked_for_is_marked():
    ax = fig6_7.plot_action(ACTION, {"neighbour"})
    assert fills(ax)["block-3"] == fig6_7.NEIGHBOUR
    assert fills(ax)["block-1"] == fills(ax)["block-2"] == fig6_7.BUILT
    assert fills(ax)["stone"] == fig6_7.STONE
    assert not ax.images
    # Tops at 7 and at 8, over both stones; the difference between them.
    assert drawn(ax, "top") == [[[0, 7], [9, 7]], [[0, 8], [9, 8]]]
    assert drawn(ax, "difference") == [[[4.5, 7], [4.5, 8]]]
    # Joints are the top corners of the stones below.
    ax = fig6_7.plot_action(ACTION, {"joints", "rays", "box", "begun", "slope"})
    assert fills(ax)["block-1"] == fills(ax)["block-2"] == fig6_7.BELOW
    assert drawn(ax, "joint") == [[[6, 4]], [[6, 4]]]
    assert drawn(ax, "offset") == [[[5, 4], [6, 4]], [[9, 4], [6, 4]]]
    assert drawn(ax, "slope") == [[[5.5, 7], [8.5, 7]]]
    np.testing.assert_array_equal(ax.images[0].get_array()[..., 3] > 0, SWEPT)
    patches = {patch.get_gid(): patch for patch in ax.patches}
    assert patches["box"].get_bbox().bounds == (5, 4, 4, 3)
    assert patches["begun"].get_bbox().bounds == (0, 0, 20, 8)
