import math
from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drystone.clusters import stone_features
from drystone.drawing.palette import cluster_colour
from drystone.poses import PoseBook
from drystone_lab.reproduce import fig5
from tests.lab.reproduce.small_walls import RUBBLE, context, gids, of, rows

MADE = of("fig5", RUBBLE, (RUBBLE,))


@pytest.fixture(scope="module")
def stones():
    return RUBBLE.source.stones(None)


@pytest.fixture(scope="module")
def features(stones):
    return stone_features(stones, PoseBook())


def naive_ward(features, threshold):
    """Join the two clusters at the least Ward distance until it is above the threshold."""
    groups = [[k] for k in range(len(features))]

    def distance(pair):
        a, b = (features[groups[k]] for k in pair)
        weight = 2 * len(a) * len(b) / (len(a) + len(b))
        return math.sqrt(weight) * math.dist(a.mean(axis=0), b.mean(axis=0))

    while len(groups) > 1:
        i, j = least = min(combinations(range(len(groups)), 2), key=distance)
        if distance(least) > threshold:
            break
        groups[i] += groups.pop(j)
    return {frozenset(group) for group in groups}


def test_clusters_are_those_of_joining_step_by_step(output, stones, features):
    ids = [stone.id for stone in stones]
    expected = {frozenset(ids[k] for k in group) for group in naive_ward(features, 0.2)}
    table = rows(output, "clusters")
    assert {frozenset(map(int, row["ids"].split())) for row in table} == expected
    for row in table:
        among = [ids.index(int(i)) for i in row["ids"].split()]
        assert row["stones"] == len(among)
        mean = features[among].mean(axis=0)
        assert (row["mean eccentricity"], row["mean size"]) == pytest.approx(mean, rel=2e-3)


def test_counts_over_the_threshold(output, features, stones):
    (row,) = rows(output, "thresholds")
    for distance in fig5.DISTANCES:
        assert row[f"{distance:g}"] == len(naive_ward(features, distance)), distance
    drawn = gids(output, "fig5")
    assert all(drawn.count(f"stone-{stone.id}") == 2 for stone in stones)


def test_the_span_of_thresholds_has_the_paper_s_count(stones, features):
    grouped = fig5.ClusteredStones.of("rubble", stones)
    low, high = grouped.between(7)
    assert len(naive_ward(features, (low + high) / 2)) == 7
    assert len(naive_ward(features, low - 2e-3)) > 7 > len(naive_ward(features, high + 2e-3))


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
