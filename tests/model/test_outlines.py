"""The outlines of a wall, as it grows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.coverage import coverage
from drystone.model.outlines import Outlines
from drystone.model.shares import Shares
from drystone.model.site import Site
from tests.polygons import simple_polygons
from tests.strategies import repeatable


def box(left, low, right, high):
    return np.array([[left, low], [right, low], [right, high], [left, high]], float)


def test_nothing_is_there_yet():
    empty = Outlines.empty(Site(6, 4, 0.5))
    assert (len(empty.polygons), empty.ids, empty.blocks) == (0, (), [])
    assert empty.shares.labels.tolist() == [[0] * 6] * 4


def test_adding_keeps_the_old_ones():
    site = Site(6, 4, 0.5)
    stone, wedge = box(0.0, 0.0, 8.0, 4.0), box(8.0, 0.0, 12.0, 2.0)
    one = Outlines.empty(site).added([(70_000, stone)], site.scale)
    two = one.added([(3, box(0.0, 4.0, 2.0, 8.0)), (4_000_000_000, wedge)], site.scale)
    assert (one.ids, two.ids) == ((70_000,), (70_000, 3, 4_000_000_000))
    assert len(one.polygons) == 1
    assert one.shares.labels.tolist()[2:] == [[70_000] * 4 + [0] * 2] * 2
    assert two.shares.labels.tolist() == [
        [3, 0, 0, 0, 0, 0],
        [3, 0, 0, 0, 0, 0],
        [70_000] * 4 + [0] * 2,
        [70_000] * 4 + [4_000_000_000] * 2,
    ]
    assert two.added([], site.scale).ids == two.ids


def test_blocks_are_the_corners_in_source_px():
    corners = [box(0.0, 0.0, 8.0, 4.0), np.array([[9.0, 0.0], [12.0, 0.0], [9.0, 2.5]])]
    outlines = Outlines.empty(Site(6, 4, 0.5)).added(list(zip((5, 2), corners, strict=True)), 0.5)
    assert [block for block, _ in outlines.blocks] == [5, 2]
    for (_, found), sought in zip(outlines.blocks, corners, strict=True):
        assert np.array_equal(found, sought)
    assert outlines.polygons.boxes.tolist() == [[0.0, 0.0, 8.0, 4.0], [9.0, 0.0, 12.0, 2.5]]


@repeatable(25)
@given(
    polygons=st.lists(simple_polygons(max_size=12.0), min_size=1, max_size=5),
    scale=st.sampled_from([1.0, 0.5, 0.3]),
    data=st.data(),
)
def test_shares_are_those_of_every_block_in_the_order_of_placement(polygons, scale, data):
    site = Site(14, 10, scale)
    blocks = [
        (10 * k + 7, polygon + np.array([data.draw(st.floats(0.0, 14.0)), 5.0]) / scale)
        for k, polygon in enumerate(polygons)
    ]
    cut = data.draw(st.integers(0, len(blocks)))
    found = Outlines.empty(site).added(blocks[:cut], scale).added(blocks[cut:], scale)
    expected = Shares.empty(10, 14)
    for block_id, corners in blocks:
        expected = expected.added(block_id, *coverage(corners * scale))
    assert found.shares.total.tobytes() == expected.total.tobytes()
    assert np.array_equal(found.shares.labels, expected.labels)
    covered = sum(coverage(corners * scale)[0].sum() for _, corners in blocks)
    assert found.shares.total.sum() <= covered + 1e-9
    assert found.ids == tuple(block_id for block_id, _ in blocks)
    with pytest.raises(ValueError, match="read-only"):
        found.shares.labels[0, 0] = 1
