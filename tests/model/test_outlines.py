"""The outlines of a wall, as it grows, and who covers how much of each cell, cell by cell."""

from collections import defaultdict

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.coverage import coverage
from drystone.model.outlines import Outlines, Shares
from drystone.model.site import Site
from tests.polygons import simple_polygons
from tests.strategies import repeatable


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
    for (_, kept), (_, corners) in zip(found.blocks, blocks, strict=True):
        assert np.array_equal(kept, corners)
    boxes = [[*corners.min(axis=0), *corners.max(axis=0)] for _, corners in blocks]
    assert found.polygons.boxes == pytest.approx(np.array(boxes))
    assert not Outlines.empty(site).shares.total.any()
    for array in (found.shares.total, found.shares.largest, found.shares.owners):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1


@st.composite
def blocks(draw, count=5):
    """Shares of blocks anywhere about a small site, quarters often, so that some are equal."""
    made = []
    for block_id in draw(st.permutations(range(1, 1 + count))):
        rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
        shape = draw(st.tuples(st.integers(1, 5), st.integers(1, 5)))
        shares = rng.uniform(0.0, 1.0, shape)
        if draw(st.booleans()):
            shares = np.floor(5.0 * shares) / 4.0
        left, bottom = draw(st.integers(-6, 9)), draw(st.integers(-6, 7))
        made.append((70_000 * block_id, shares, left, bottom))
    return made


def by_cells(made, height, width):
    """The shares of each cell (x, y) of a site, from its bottom-left corner, by block."""
    cells = defaultdict(list)
    for number, (_, shares, left, bottom) in enumerate(made):
        for (row, col), share in np.ndenumerate(shares):
            x, y = left + col, bottom + len(shares) - 1 - row
            if 0 <= x < width and 0 <= y < height:
                cells[x, y] += [0.0] * (number - len(cells[x, y])) + [float(share)]
    return cells


@repeatable(80)
@given(made=blocks(), height=st.integers(1, 7), width=st.integers(1, 9))
def test_each_cell_has_the_sum_the_largest_and_its_owner_and_fresh_ones_become_part(
    made, height, width
):
    shares = Shares.empty(height, width)
    for block in made:
        before, shares = shares, shares.added(*block)
    cells = by_cells(made, height, width)
    assert shares.total.shape == shares.largest.shape == shares.owners.shape == (height, width)
    for x in range(width):
        for y in range(height):
            at, each = (height - 1 - y, x), cells[x, y]
            largest = max(each, default=0.0)
            owner = made[each.index(largest)][0] if largest > 0.0 else 0
            assert shares.total[at] == pytest.approx(sum(each))
            assert shares.largest[at] == largest
            assert shares.owners[at] == owner
            assert shares.labels[at] == (owner if sum(each) >= 0.5 - 1e-12 else 0)
    image, fresh = np.zeros((height, width), bool), before.fresh(*made[-1][1:])
    if fresh is not None:
        mask, row, col = fresh
        image[row : row + mask.shape[0], col : col + mask.shape[1]] = mask
    np.testing.assert_array_equal(image, (before.labels == 0) & (shares.labels > 0))


def test_of_equal_shares_the_first_keeps_the_cell_and_half_is_enough_whatever_the_rounding():
    first = Shares.empty(1, 2).added(9, np.array([[0.5, 0.3]]), 0, 0)
    both = first.added(3, np.array([[0.5 + 1e-14, 0.3 + 1e-9]]), 0, 0)
    assert both.owners.tolist() == [[9, 3]]
    assert both.labels.tolist() == [[9, 3]]
    half = Shares.empty(1, 2).added(4, np.array([[0.5 - 1e-13, 0.5 - 1e-11]]), 0, 0)
    assert half.labels.tolist() == [[4, 0]]
