"""Clusters of similar stones (§3.4, Fig. 5)."""

import numpy as np
import pytest

from drystone.clusters import ClusterSettings, cluster_stones
from drystone.io.read_stones import read_stones
from drystone.model.stone import Stone, StoneSet
from drystone.poses import PoseBook


@pytest.mark.parametrize(
    ("name", "stones", "count"), [("PR", 32, 7), ("R", 34, 9), ("IR", None, 15)]
)
def test_published_sets(data_dir, name, stones, count):
    """PR: the paper's Fig. 5 says 32 stones in 7 clusters; R and IR: docs/evidence/decisions.md."""
    found = read_stones(data_dir / "almeida" / f"{name}.png")
    assert stones is None or len(found) == stones
    assert len(set(cluster_stones(found, PoseBook()).values())) == count


def rectangles(*sizes):
    return StoneSet(tuple(Stone(k, np.ones(size, bool)) for k, size in enumerate(sizes, 5)))


def test_similar_stones_share_a_cluster_and_larger_ones_come_first():
    stones = rectangles((4, 4), (20, 40), (4, 12), (20, 41), (4, 13), (5, 5))
    found = cluster_stones(stones, PoseBook())
    assert found[6] == found[8] == 1
    assert found[7] == found[9]
    assert found[5] == found[10]
    assert set(found.values()) == {1, 2, 3}
    assert set(found) == {5, 6, 7, 8, 9, 10}


def test_size_does_not_depend_on_how_the_stone_lies():
    assert cluster_stones(rectangles((6, 20), (20, 6)), PoseBook()) == {5: 1, 6: 1}
    assert cluster_stones(rectangles((3, 3)), PoseBook()) == {5: 1}
    assert cluster_stones(rectangles(), PoseBook()) == {}


def test_distance_decides():
    stones = rectangles((4, 4), (20, 20), (4, 12), (20, 21))
    assert set(cluster_stones(stones, PoseBook(), ClusterSettings(distance=99)).values()) == {1}
    assert (
        len(set(cluster_stones(stones, PoseBook(), ClusterSettings(distance=1e-9)).values())) == 4
    )
    with pytest.raises(ValueError, match="distance must be above 0"):
        ClusterSettings(distance=0)
