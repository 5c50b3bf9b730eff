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


def test_similar_stones_share_a_cluster_and_larger_ones_come_first():
    def found(*sizes, **settings):
        stones = StoneSet(tuple(Stone(k, np.ones(size, bool)) for k, size in enumerate(sizes, 5)))
        return cluster_stones(stones, PoseBook(), ClusterSettings(**settings))

    assert found((4, 4), (20, 40), (4, 12), (20, 41), (4, 13), (5, 5)) == dict(
        zip(range(5, 11), (3, 1, 2, 1, 2, 3), strict=True)
    )
    # The size of a stone does not depend on how it lies.
    assert found((6, 20), (20, 6)) == {5: 1, 6: 1}
    assert (found((3, 3)), found()) == ({5: 1}, {})
    apart = (4, 4), (20, 20), (4, 12), (20, 21)
    for distance, count in ((99, 1), (1e-9, 4)):
        assert len(set(found(*apart, distance=distance).values())) == count
    with pytest.raises(ValueError, match="distance must be above 0"):
        ClusterSettings(distance=0)
