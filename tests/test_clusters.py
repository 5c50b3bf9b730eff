"""Clusters of similar stones (§3.4, Fig. 5)."""

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from drystone.clusters import ClusterSettings, cluster_stones
from drystone.model.stone import Stone, StoneSet
from drystone.poses import PoseBook


def stones_of(labels):
    """Largest 8-connected piece of every id, holes filled."""
    found = []
    for value in np.unique(labels[labels > 0]).tolist():
        pieces, _ = ndimage.label(labels == value, np.ones((3, 3)))
        largest = int(np.argmax(np.bincount(pieces.ravel())[1:])) + 1
        mask = ndimage.binary_fill_holes(pieces == largest)
        rows, cols = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        found.append(Stone(value, mask[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]))
    return StoneSet(tuple(found))


def read_ids(path):
    """Ids as DESIGN 4.1 reads them: the grey value, or R + 256 G + 65536 B."""
    with Image.open(path) as image:
        pixels = np.asarray(image.convert("RGB") if image.mode in ("RGBA", "RGB", "P") else image)
    if pixels.ndim == 2:
        return pixels.astype(np.int64)
    red, green, blue = (pixels[..., k].astype(np.int64) for k in range(3))
    grey = (red == green) & (green == blue)
    return np.where(grey.all(), red, red + 256 * green + 65536 * blue)


@pytest.mark.parametrize(
    ("name", "stones", "count"), [("PR", 32, 7), ("R", 34, 9), ("IR", None, 15)]
)
def test_published_sets(data_dir, name, stones, count):
    """PR: the paper's Fig. 5 says 32 stones in 7 clusters; R and IR: docs/evidence/decisions.md."""
    found = stones_of(read_ids(data_dir / "almeida" / f"{name}.png"))
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
    lying, standing = rectangles((6, 20)), rectangles((20, 6))
    both = StoneSet((lying.stones[0], Stone(6, standing.stones[0].mask)))
    assert len(set(cluster_stones(both, PoseBook()).values())) == 1


def test_distance_decides():
    stones = rectangles((4, 4), (20, 20), (4, 12), (20, 21))
    assert set(cluster_stones(stones, PoseBook(), ClusterSettings(distance=99)).values()) == {1}
    assert (
        len(set(cluster_stones(stones, PoseBook(), ClusterSettings(distance=1e-9)).values())) == 4
    )
    with pytest.raises(ValueError, match="distance must be above 0"):
        ClusterSettings(distance=0)


def test_one_stone_and_none():
    assert cluster_stones(rectangles((3, 3)), PoseBook()) == {5: 1}
    assert cluster_stones(StoneSet(()), PoseBook()) == {}
