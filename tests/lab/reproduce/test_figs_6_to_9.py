"""Figs. 6 and 7, indices; Fig. 8, positions; Fig. 9, stones that fall: on small walls."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from scipy import ndimage

from drystone.model.placement import Placement, Wedge
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.stabilise.stabilise import Support
from drystone_lab.reproduce import fig6_8, fig9
from drystone_lab.reproduce.construction import Moment, RestingPlace, amid_course
from tests.lab.reproduce.small_walls import RUBBLE, SHARP, built, gids, of, rows
from tests.naive.overlap import overlaps
from tests.naive.placement import all_positions, areas_by_convolution, eq12
from tests.naive.support import rests_stably


def slab(height, width):
    """A stone that is a rectangle."""
    mask = np.ones((height, width), bool)
    return PosedStone(Stone(9, mask), 0.0, 1.0, mask, (width / 2, height / 2))


def resting(height, width, stone, at, *others):
    """A stone on a wall of others, which are numbered from 1."""
    wall = Wall.empty(Site(width, height))
    for number, (row, col, posed) in enumerate(others, 1):
        numbered = replace(posed, stone=Stone(number, posed.mask))
        wall = wall.add(Placement(numbered, row, col))
    shop = SimpleNamespace(stock=SimpleNamespace(narrowest_px=1))
    return RestingPlace(Moment(1, SimpleNamespace(before=wall), shop, None), stone, *at)


@pytest.fixture(scope="module")
def outputs(here):
    asked = {"fig6-7": RUBBLE, "fig8": RUBBLE, "fig9": SHARP}
    return {name: of(name, wall).make(here) for name, wall in asked.items()}


@pytest.fixture(scope="module")
def amid(folder):
    return amid_course(built(folder, RUBBLE))


@pytest.fixture(scope="module")
def places(amid):
    return fig6_8.resting_places(amid.moment)


def test_places_are_all_at_which_a_stone_rests_and_have_extremes(amid, places, outputs):
    moment = amid.moment
    posed = moment.workshop.poses(moment.remaining[0])[0]
    occupied, mask = moment.wall.occupied, posed.mask
    expected = {
        (row, col)
        for row, col in all_positions(occupied, mask)
        if col % 4 == 0  # each fourth, as this is slow
        and not overlaps(occupied, mask, row, col)
        and rests_stably(occupied, mask, row, col, col + posed.anchor[0], 0.0)
    }
    found = {(p.row, p.col) for p in places if p.posed is posed}
    assert {place for place in found if place[1] % 4 == 0} == expected != set()
    assert {p.posed.stone.id for p in places} <= set(moment.remaining)
    for row in rows(outputs["fig6-7"], "extremes"):
        name = row["index"]
        values = [place.values[name] for place in places if name in place.values]
        best = (row["case"] == "favourable") == (name != "NHR")
        assert row["value"] == pytest.approx(max(values) if best else min(values), abs=1e-4)


def test_counting_again_agrees_everywhere(places):
    seen = set()
    for place in places[::7]:
        for name in place.values.keys() - {"SF"}:
            again = fig6_8.recounted(place, name)
            if again is not None:
                assert again == pytest.approx(place.values[name], abs=1e-12), (name, place.order)
                seen.add(name)
    assert seen == {"LFR", "GDS", "NHR", "IWR", "IS"}
    # On the ground there are no joints below, however low a stone beside is.
    low = slab(2, 6)
    assert "IWR" not in resting(9, 20, slab(6, 4), (3, 8), (7, 2, low), (7, 12, low)).values


def test_the_stone_of_fig7_stands_where_the_run_left_it(folder, outputs, amid):
    stage = built(folder, RUBBLE)[amid.moment.number - 1].stage
    table = rows(outputs["fig6-7"], "fig7")
    assert {row["stone"] for row in table} == {stage.group.placement.stone_id}
    assert {row["index"] for row in table} >= {"NHR", "IWR"}
    for row in table:
        assert row["value"] == pytest.approx(stage.stone.indices[row["index"]], abs=1e-4)
    # Pictures show what is measured.
    six, seven = (gids(outputs["fig6-7"], name) for name in ("fig6", "fig7"))
    assert [six.count(mark) for mark in ("stone", "begun", "rays", "box")] == [12, 2, 2, 2]
    assert {*seven} >= {"stone", "rays", "begun", "box", "top", "joint", "offset", "slope", "name"}


def test_only_what_is_asked_for_is_marked():
    place = resting(10, 20, slab(3, 4), (3, 5), (6, 0, slab(4, 6)), (6, 6, slab(4, 6)),
                    (2, 0, slab(4, 5)))  # fmt: skip

    def plotted(names):
        ax = Figure().add_subplot()
        fig6_8.plot_indices(place, names, ax)
        return ax, {patch.get_gid(): patch for patch in ax.patches}

    def drawn(ax, gid):
        return [line.get_xydata().tolist() for line in ax.lines if line.get_gid() == gid]

    ax, patches = plotted({"NHR"})
    fills = {gid: to_hex(patch.get_facecolor()) for gid, patch in patches.items()}
    assert fills["block-3"] == fig6_8.NEIGHBOUR
    assert fills["block-1"] == fills["block-2"] == fig6_8.BUILT
    assert fills["stone"] == fig6_8.STONE
    assert not ax.images
    # Tops at 7 and at 8, over both stones; the difference between them.
    assert drawn(ax, "top") == [[[0, 7], [9, 7]], [[0, 8], [9, 8]]]
    assert drawn(ax, "difference") == [[[4.5, 7], [4.5, 8]]]
    # Joints are the top corners of the stones below.
    ax, patches = plotted({"IWR", "LFR", "SF", "GDS", "IS"})
    for block in ("block-1", "block-2"):
        assert to_hex(patches[block].get_facecolor()) == fig6_8.BELOW
    assert drawn(ax, "joint") == [[[6, 4]], [[6, 4]]]
    assert drawn(ax, "offset") == [[[5, 4], [6, 4]], [[9, 4], [6, 4]]]
    assert drawn(ax, "slope") == [[[5.5, 7], [8.5, 7]]]
    swept = np.zeros((10, 20), bool)
    swept[3:6, :5] = swept[6:, 5:9] = True
    np.testing.assert_array_equal(ax.images[0].get_array()[..., 3] > 0, swept)
    assert patches["box"].get_bbox().bounds == (5, 4, 4, 3)
    assert patches["begun"].get_bbox().bounds == (0, 0, 20, 8)


def test_maps_are_those_of_every_position_and_the_chosen_one_is_worth_most(outputs, amid):
    occupied = amid.moment.wall.occupied
    posed, *chosen = amid.moment.trial(amid.posed.stone.id)
    found = fig6_8.position_maps(occupied, posed.mask)
    # By convolution: where it overlaps nothing, and where it does not even touch anything
    grown = ndimage.binary_dilation(np.pad(occupied, 1, constant_values=True))[1:-1, 1:-1]
    free, floating = (areas_by_convolution(one, posed.mask) == 0 for one in (occupied, grown))
    np.testing.assert_array_equal(found, (free, floating))
    below = np.vstack([free[1:], np.zeros_like(free[:1])])
    resting = np.count_nonzero(free & ~below)
    table = rows(outputs["fig8"], "positions")
    touching = free.sum() - floating.sum()
    counts = [free.size, free.sum(), floating.sum(), touching, resting, 1]
    assert [row["count"] for row in table] == counts
    others = amid.moment.positions(posed)[::9].tolist()
    most, *less = (
        eq12(occupied, posed.mask, posed.anchor[0], tuple(at), 0.7) for at in (chosen, *others)
    )
    assert max(less) <= most + 1e-12
    *_, touch, rest, own = (row["best: Eq. 12"] for row in table)
    assert touch >= rest == own == pytest.approx(most, abs=1e-4)
    assert table[-1]["best: left px"] == chosen[1]
    drawn = set(gids(outputs["fig8"], "fig8"))
    assert len([gid for gid in drawn if gid.startswith("layer-")]) == 4
    assert {"values", "chosen", "best"} <= drawn


def test_positions_and_their_values_are_drawn_at_the_centroids():
    site, at = np.zeros((6, 10), np.uint32), np.zeros((5, 7), bool)
    site[4:, :5], at[2, 3] = 1, True
    ax, values = Figure().subplots(1, 2)
    fig6_8.plot_position_layers(ax, site, slab(2, 4), [("here", "#d55e00", at)])
    (image,) = ax.images
    rgba, (left, right, bottom, top) = image.get_array(), image.get_extent()
    ((row, col),) = np.argwhere(rgba[..., 3] > 0).tolist()
    x = left + (col + 0.5) * (right - left) / rgba.shape[1]
    y = top - (row + 0.5) * (top - bottom) / rgba.shape[0]
    # Columns 3 to 7, rows 2 and 3 from the top.
    assert (x, y) == (5.0, 3.0)
    # The stone is at the chosen one.
    positions, worth = np.array([[2, 0], [2, 1], [4, 5]]), np.array([1.0, 0.9, 0.5])
    place = resting(6, 10, slab(2, 4), (2, 0), (4, 0, slab(2, 5)))
    fig6_8.plot_position_values(values, place, positions, worth)
    (dots,) = [one for one in values.collections if one.get_gid() == "values"]
    np.testing.assert_allclose(dots.get_offsets(), [[2, 3], [3, 3], [7, 1]])
    np.testing.assert_allclose(dots.get_array(), worth)
    (stone,) = [patch for patch in values.patches if patch.get_gid() == "chosen"]
    box = stone.get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (0, 2, 4, 4)
    (best,) = [line for line in values.lines if line.get_gid() == "best"]
    assert best.get_xydata().tolist() == [[2, 3]]


@pytest.fixture(scope="module")
def unstable(here):
    return fig9.falls(here, SHARP)


def falls(occupied, pose):
    posed, row, col = pose
    under = occupied[row : row + posed.height_px, col : col + posed.width_px]
    assert not np.any(under & posed.mask)
    return not rests_stably(occupied, posed.mask, row, col, col + posed.anchor[0], 0.0)


def test_every_stone_that_is_left_is_tried_and_those_that_fall_are_found(folder, unstable):
    tried = [
        (moment, stone_id, trial)
        for moment in built(folder, SHARP)
        for stone_id in moment.remaining
        if (trial := moment.trial(stone_id)) is not None
    ]
    assert unstable.trials == len(tried)
    assert [(one.moment.number, one.trial.pose[0].stone.id) for one in unstable.unstable] == [
        (moment.number, stone_id)
        for moment, stone_id, trial in tried
        if falls(moment.wall.occupied, trial)
    ]


def test_turned_and_wedged_stones_rest(unstable):
    for case in unstable.unstable:
        occupied = case.moment.wall.occupied
        if case.turned is not None:
            assert not falls(occupied, case.turned.pose)
            first, last = (one.pose[0].angle_deg for one in (case.trial, case.turned))
            assert math.remainder(case.turn_deg - (last - first), 360) == 0
            # It turns to the side to which it falls.
            assert (case.turn_deg < 0) == (case.trial.falls > 0)
        if case.wedged is not None:
            scene = occupied.copy()
            for wedge in case.wedged.wedges:
                assert not np.any(scene[wedge.window] & wedge.mask)
                scene[wedge.window] |= wedge.mask
            assert not falls(scene, case.wedged.pose)
            assert case.wedged.pose == case.trial.pose
    for way in ("turned", "wedged"):
        assert sum(getattr(case, way) is not None for case in unstable.unstable) > 5


def test_counts_add_up_and_the_most_turned_and_the_largest_wedge_are_drawn(outputs, unstable):
    count = {row["what"]: row["count"] for row in rows(outputs["fig9"], "counts")}
    trials, cases = unstable.trials, unstable.unstable
    assert (count["tried"], count["not stable"]) == (trials, len(cases))
    ends = ("stable after turning", "turning fails, a wedge does", "neither")
    assert sum(count[end] for end in ends) == len(cases)
    wrong = [one for one in cases if (one.trial.cross < 0) != (one.trial.falls > 0)]
    assert count["sign of AB x AC is wrong"] == len(wrong)
    table = rows(outputs["fig9"], "cases")
    assert [row["pose"] for row in table] == ["tried", "turned", "wedged", "tried", "wedged"]
    turns = []
    for case in cases:
        support, width = case.trial.support, case.trial.pose[0].width_px
        both = case.turned is not None and case.wedged is not None
        if both and support.right_x - support.left_x >= 0.1 * width:
            turns.append(abs(case.turn_deg))
    assert abs(table[1]["turned deg"]) == max(turns)
    for row in table:
        assert (row["wedge height px"] is None) == (row["pose"] != "wedged")
    drawn = gids(outputs["fig9"], "fig9")
    assert [drawn.count(gid) for gid in ("stone", "AB", "C", "C'")] == [5, 5, 5, 5]
    assert (drawn.count("turn"), drawn.count("before"), drawn.count("supported")) == (2, 1, 2)
    assert sum(gid.startswith("wedge-") for gid in drawn) >= 2


def test_points_of_a_stone_that_falls_and_sizes_of_the_wedge_that_holds_it():
    step, lying = np.zeros((10, 20), np.uint32), (slab(3, 12), 3, 4)
    step[6:, :8] = 1
    trial = fig9.SupportedStone(lying, Support(4, 8, 6, 6), 1, (), 10)
    wedge = Wedge(10, 9, np.ones((4, 2), bool), 6, 13)
    wedged = fig9.SupportedStone(lying, Support(4, 15, 6, 6), 0, (wedge,), 10)
    ax, held = Figure().subplots(1, 2)
    fig9.plot_standing(ax, step, trial, (0, 0, 20, 10))
    drawn = {line.get_gid(): line.get_xydata().tolist() for line in ax.lines}
    assert (drawn["AB"], drawn["C"], drawn["C'"]) == ([[8, 4], [4, 4]], [[10, 5.5]], [[10, 4]])
    # AB = (-4, 0), AC = (2, 1.5): clockwise, to the right.
    assert trial.cross == pytest.approx(-6.0)
    marks = {patch.get_gid() for patch in ax.patches}
    assert ("turn" in marks, "supported" in marks) == (True, False)
    fig9.plot_standing(held, step, wedged, (0, 0, 20, 10), before=trial)
    patches = {patch.get_gid(): patch for patch in held.patches}
    assert "turn" not in patches
    box = patches["wedge-10"].get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (13, 0, 15, 4)
    assert patches["supported"].get_bbox().bounds == (4, 4, 4, 3)
    assert "h 4, w 2" in [text.get_text() for text in held.texts]
