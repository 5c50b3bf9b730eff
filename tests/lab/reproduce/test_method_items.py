"""The items that show the method on a small run: Table 1, and Figs. 3 to 12 and 17."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from scipy import ndimage
from scipy.cluster.hierarchy import fcluster, linkage

from drystone.clusters import stone_features
from drystone.contacts.blocks import model_from_labels
from drystone.drawing.palette import cluster_colour
from drystone.io.wall_image import read_wall_image
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import measure_labels
from drystone.model.placement import Placement, Wedge
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.planner.planner import Planner
from drystone.poses import PoseBook
from drystone.selection.policies.registry import rule_of
from drystone.stabilise.stabilise import Support
from drystone_lab.reproduce import fig5, fig6_8, fig9, method
from drystone_lab.reproduce.construction import Moment, RestingPlace, amid_course, construction
from drystone_lab.reproduce.items import ITEMS
from drystone_lab.walls import PR
from tests.lab.reproduce.small_walls import RUBBLE, SHARP, context, gids, of, rows
from tests.naive.contacts import directed_edges
from tests.naive.overlap import overlaps
from tests.naive.placement import all_positions, areas_by_convolution, eq12
from tests.naive.support import rests_stably


@pytest.fixture(scope="module")
def outputs(here):
    asked = dict.fromkeys(("fig6-7", "fig8", "fig12", "fig17"), (RUBBLE,))
    asked |= {"fig5": (RUBBLE, (RUBBLE,)), "fig9": (SHARP,)}
    return {name: of(name, *walls).make(here) for name, walls in asked.items()}


def test_table_1_has_the_components_of_our_policies(here):
    table = rows(of("table1").make(here), "table1")
    marks = ITEMS["table1"]["marks"]
    assert [row["component"] for row in table] == list(marks)
    for row, (_, count, *_) in zip(table, marks.values(), strict=True):
        assert sum("ours" in str(row[policy]) for policy in method.MARKS) == count
    assert len({rule_of(name) for name in method.MARKS}) == 7


def test_a_run_is_followed_step_by_step(here):
    output = of("fig3-4", RUBBLE).make(here)
    table = rows(output, "steps")
    assert [row["step"] for row in table] == list(range(1, len(table) + 1))
    wall = here.wall(output.runs[0])
    stones = {placement.stone_id for placement in wall.placements}
    assert {row["stone"] for row in table} == stones
    area = sum(int((wall.labels == stone).sum()) for stone in stones)
    assert table[-1]["filled"] == pytest.approx(area / wall.labels.size, abs=1e-4)


def test_the_step_is_the_planners_own(here):
    step = method.selection_step(here, RUBBLE)
    stones = RUBBLE.source.stones(None)
    site = Site.from_source(*RUBBLE.size(stones), RUBBLE.scale)
    planner = Planner(stones, site, seed=1, settings=RUBBLE.run(1).settings())
    actions = [each.action for each in planner.steps()]
    chosen = step.candidates[step.selected.position]
    expected = actions[len(stones) // 2]
    assert (chosen.stone_id, chosen.indices) == (expected.stone_id, expected.indices)
    counts = [len(survivors) for survivors in step.selected.survivors]
    assert counts == [sum(n > k for n in step.passed) for k in range(len(counts))]
    table = rows(of("fig10", RUBBLE).make(here), "candidates")
    assert [row["stone"] for row in table if row["chosen"]] == [chosen.stone_id]


def test_forces_on_two_stones_are_in_balance(here):
    found = method.two_stones(here)
    assert found.both.right.alpha == pytest.approx(found.model.mu)
    table = rows(of("fig11").make(here), "forces")
    ground = [row for row in table if row["on"] == "the ground"]
    weight = int((found.labels > 0).sum())
    assert sum(r["normal force"] for r in ground) == pytest.approx(weight, abs=1e-3)


def test_factors_are_those_of_the_run_and_of_the_table(here, outputs):
    (row,) = rows(outputs["fig17"], "figures")
    (outcome,) = here.run((RUBBLE.run(1),))
    assert row["F_AV %"] == pytest.approx(outcome.figures["F_AV"], abs=1e-4)
    assert row["F_AH %"] == pytest.approx(outcome.figures["F_AH"], abs=1e-4)
    for way, name, straight in (
        ("horizontal", "F_AH %", row["straight across px"]),
        ("vertical", "F_AV %", row["straight upright px"]),
    ):
        found = [one for one in rows(outputs["fig17"], "paths") if one["way"] == way]
        assert len(found) > 5
        excess = [one["longer than straight %"] for one in found]
        assert math.fsum(excess[:5]) / 5 == pytest.approx(row[name], abs=1e-4)
        lengths = [one["length px"] for one in found]
        assert lengths == sorted(lengths)
        assert lengths == pytest.approx([straight * (1 + e / 100) for e in excess], rel=1e-5)


def test_the_masons_wall_is_measured_beside_it(tmp_path, data_dir):
    output = of("fig17").make(context(tmp_path, data_dir))
    ours, masons = rows(output, "figures")
    assert (ours["wall"], masons["wall"]) == ("planned PR", "the masons' PR")
    labels = reduce_labels(read_wall_image(data_dir / PR.source.name), PR.scale)
    measured = measure_labels(labels)
    assert masons["F_AH %"] == pytest.approx(measured.F_AH, abs=1e-4)
    assert masons["F_AV %"] == pytest.approx(measured.F_AV, abs=1e-4)
    assert {"path-1", "path-7"} <= set(gids(output, "fig17-masons"))


def test_clusters_are_those_of_ward_at_every_threshold(outputs):
    stones = RUBBLE.source.stones(None)
    ids, features = [stone.id for stone in stones], stone_features(stones, PoseBook())
    tree = linkage(features, "ward")
    of_each = fcluster(tree, 0.2, "distance")
    expected = {frozenset(np.array(ids)[of_each == one].tolist()) for one in of_each}
    table = rows(outputs["fig5"], "clusters")
    assert {frozenset(map(int, row["ids"].split())) for row in table} == expected
    for row in table:
        among = [ids.index(int(i)) for i in row["ids"].split()]
        assert row["stones"] == len(among)
        mean = features[among].mean(axis=0)
        assert (row["mean eccentricity"], row["mean size"]) == pytest.approx(mean, rel=2e-3)
    (row,) = rows(outputs["fig5"], "thresholds")
    for distance in fig5.DISTANCES:
        assert row[f"{distance:g}"] == fcluster(tree, distance, "distance").max(), distance
    drawn = gids(outputs["fig5"], "fig5")
    assert all(drawn.count(f"stone-{stone.id}") == 2 for stone in stones)
    # The span of thresholds has the paper's count.
    grouped = fig5.ClusteredStones.of("rubble", stones)
    low, high = grouped.between(7)
    ats = (low - 2e-3, (low + high) / 2, high + 2e-3)
    fewer = [fcluster(tree, at, "distance").max() for at in ats]
    assert fewer[0] > fewer[1] == 7 > fewer[2]


def test_the_stones_pr_fall_into_the_paper_s_clusters(tmp_path, data_dir):
    output = of("fig5").make(context(tmp_path, data_dir))
    assert len(rows(output, "clusters")) == fig5.PAPER_CLUSTERS
    assert [row["stones"] for row in rows(output, "thresholds")] == ["PR", "R", "IR"]
    assert [row["count"] for row in rows(output, "thresholds")] == [32, 34, 61]


def test_stones_are_at_their_features_in_the_colour_of_their_cluster():
    features, clusters = np.array([[0.2, 1.0], [0.8, 0.5], [0.81, 0.5]]), {3: 1, 5: 2, 8: 2}
    ax = Figure().add_subplot()
    fig5.plot_features(ax, features, [3, 5, 8], clusters)
    lines = {line.get_gid(): line for line in ax.lines}
    assert list(lines) == ["stone-3", "stone-5", "stone-8"]
    for line, at, cluster in zip(lines.values(), features, clusters.values(), strict=True):
        np.testing.assert_allclose(line.get_xydata(), [at])
        assert to_hex(line.get_markerfacecolor()) == cluster_colour(cluster)
    assert lines["stone-3"].get_marker() != lines["stone-5"].get_marker()


def test_blocks_of_fig12_are_three_stones_and_interfaces_end_on_corners(here, outputs):
    run = construction(here, RUBBLE)
    labels = method.three_stones(run[-1].stage.after)
    # Edges are where pixels of blocks meet.
    edges = np.stack(method.boundary_edges(labels), 1).tolist()
    found = [tuple(map(tuple, edge)) for edge in edges]
    assert len(found) == len(set(found)) > 10
    expected = set().union(*directed_edges(labels).values())
    assert set(found) == expected
    corners = {point for edge in expected for point in edge}
    table = rows(outputs["fig12"], "interfaces")
    for row in table:
        ends = (row["x0"], row["y0"]), (row["x1"], row["y1"])
        if row["length px"] > 0:
            assert set(ends) <= corners
        assert row["length px"] == pytest.approx(np.hypot(*np.subtract(*ends)), abs=1e-4)
        assert np.hypot(row["normal x"], row["normal y"]) == pytest.approx(1, abs=1e-3)
    assert {row["other"] for row in table} > {"ground"}
    drawn = gids(outputs["fig12"], "fig12")
    for row in rows(outputs["fig12"], "blocks"):
        assert drawn.count(f"block-{row['stone']}") == 3
        assert f"centre-{row['stone']}" in drawn
    assert {"edges", "normals", "interfaces"} <= set(drawn)
    # The stones stand on the ground and on each other.
    whole = run[-1].stage.after.labels
    ids = set(np.unique(labels).tolist()) - {0}
    assert len(ids) == 3
    for stone in ids:
        assert np.count_nonzero(labels == stone) == np.count_nonzero(whole == stone)
    on_ground = set(np.unique(labels[-1]).tolist()) - {0}
    assert len(on_ground) == 2
    (top,) = ids - on_ground
    pairs = {frozenset((i.block, i.other)) for i in model_from_labels(labels).model.interfaces}
    assert all(frozenset((top, below)) in pairs for below in on_ground)
    # Where none stands on two, the first three are taken.
    first = {moment.stage.stone.stone for moment in run[:3]}
    assert set(np.unique(method.three_stones(run[2].stage.after)).tolist()) == first | {0}


def test_a_normal_is_apart_from_the_mean_of_those_of_pixels_which_is_across_the_ends():
    points, normal = np.array([[1.0, 2.0], [6.0, 2.0], [9.0, 8.0]]), np.array([-0.8, 0.6])
    apart_deg = method._apart_deg(SimpleNamespace(points=points, normal=normal))
    assert apart_deg == pytest.approx(math.degrees(math.acos(0.8 * 0.6 + 0.6 * 0.8)))


def test_normals_are_to_the_left_of_the_way():
    starts, ends = np.array([[4.0, 4.0], [8.0, 0.0]]), np.array([[5.0, 4.0], [8.0, 1.0]])
    ax = Figure().add_subplot()
    labels = np.kron([[0, 7, 7], [3, 3, 5]], np.ones((4, 4), int)).astype(np.uint32)
    method.plot_boundary_edges(ax, labels, starts, ends)
    lines = {one.get_gid(): one.get_segments() for one in ax.collections}
    np.testing.assert_allclose(lines["edges"], np.stack([starts, ends], axis=1))
    ups = [[[4.5, 4.0], [4.5, 4.0 + method.NORMAL_PX]], [[8.0, 0.5], [8.0 - method.NORMAL_PX, 0.5]]]
    np.testing.assert_allclose(lines["normals"], ups)


def slab(height, width):
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
def amid(here):
    return amid_course(construction(here, RUBBLE))


def test_places_are_all_at_which_a_stone_rests_and_counting_again_agrees(amid, outputs):
    moment = amid.moment
    places = fig6_8.resting_places(moment)
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


def test_the_stone_of_fig7_stands_where_the_run_left_it(here, outputs, amid):
    stage = construction(here, RUBBLE)[amid.moment.number - 1].stage
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


def test_every_stone_that_is_left_is_tried_and_those_that_fall_are_found(here, unstable):
    tried = [
        (moment, stone_id, trial)
        for moment in construction(here, SHARP)
        for stone_id in moment.remaining
        if (trial := moment.trial(stone_id)) is not None
    ]
    assert unstable.trials == len(tried)
    assert [(one.moment.number, one.trial.pose[0].stone.id) for one in unstable.unstable] == [
        (moment.number, stone_id)
        for moment, stone_id, trial in tried
        if falls(moment.wall.occupied, trial)
    ]

    # Turned and wedged ones rest.
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
