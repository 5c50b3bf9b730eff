"""Fig. 5, clusters of like stones, and Fig. 12, stones as rigid blocks: on small walls."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from scipy.cluster.hierarchy import fcluster, linkage

from drystone.clusters import stone_features
from drystone.contacts.blocks import model_from_labels
from drystone.drawing.palette import cluster_colour
from drystone.poses import PoseBook
from drystone_lab.reproduce import fig5, method
from tests.lab.reproduce.small_walls import RUBBLE, built, context, gids, of, rows
from tests.naive.contacts import directed_edges


@pytest.fixture(scope="module")
def outputs(here):
    made = {"fig5": of("fig5", RUBBLE, (RUBBLE,)), "fig12": of("fig12", RUBBLE)}
    return {name: item.make(here) for name, item in made.items()}


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


@pytest.fixture(scope="module")
def labels(folder):
    return method.three_stones(built(folder, RUBBLE)[-1].stage.after)


def test_edges_are_where_pixels_of_blocks_meet_and_interfaces_end_on_corners(labels, outputs):
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


def test_three_stones_stand_on_the_ground_and_on_each_other(folder, labels):
    run = built(folder, RUBBLE)
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
