import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.kernels.boundary import EMPTY, boundary_of
from tests.strategies import label_images, repeatable

pictures = arrays(
    np.uint32, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.integers(0, 3)
)


def chains_of(cells, fresh=None):
    """Both labels and the nodes of each chain."""
    boundary = boundary_of(cells, fresh)
    nodes = np.split(boundary.nodes, boundary.begins[1:-1])
    return [(*pair, mine) for pair, mine in zip(boundary.labels.tolist(), nodes, strict=False)]


def test_an_enclosed_label_has_one_closed_chain_from_its_lowest_left_corner():
    cells = np.full((5, 5), 1)
    cells[1:4, 1:4] = 2
    ((_, _, nodes),) = chains_of(cells)
    assert nodes[0].tolist() == nodes[-1].tolist() == [4, 1]
    assert len(nodes) == 13


@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0), (1, 1)])
def test_where_there_is_hardly_anything_nothing_touches(shape):
    boundary = boundary_of(np.ones(shape, np.int64))
    assert boundary.begins.tolist() == [0]
    assert boundary.labels.shape == boundary.nodes.shape == (0, 2)
    assert boundary.corners.shape == (0, 4)


@given(labels=pictures | label_images(), ids=st.lists(st.integers(1, 4), max_size=3))
@repeatable(100)
def test_chains_and_corners_of_what_is_fresh_are_those_of_all_that_have_it(labels, ids):
    cells = np.full((labels.shape[0] + 2, labels.shape[1] + 2), EMPTY, np.int64)
    cells[1:-1, 1:-1] = np.where(labels > 0, labels.astype(np.int64), EMPTY)
    cells[-1] = 0
    every, found = boundary_of(cells), boundary_of(cells, np.isin(cells, ids))
    kept = [(*pair, nodes.tolist()) for *pair, nodes in chains_of(cells) if set(pair) & set(ids)]
    mine = [(*pair, nodes.tolist()) for *pair, nodes in chains_of(cells, np.isin(cells, ids))]
    assert mine == kept
    assert found.corners.tolist() == [c for c in every.corners.tolist() if {*c[:2]} & {*ids}]


def test_labels_of_64_bits_survive():
    cells = np.array([[2**62], [2**40 + 1], [2**40]])
    assert boundary_of(cells).labels.tolist() == [[2**40 + 1, 2**40], [2**62, 2**40 + 1]]
    crossing = np.array([[EMPTY, 2**62], [2**40, EMPTY]])
    assert boundary_of(crossing).corners.tolist() == [[2**62, 2**40, 1, 1]]
