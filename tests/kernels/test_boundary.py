from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.kernels import boundary as module
from drystone.kernels.boundary import (
    EMPTY,
    boundary_numpy,
    boundary_of,
    crossing_corners,
    touching_edges,
    trace_chains,
)
from drystone.kernels.raster import Mask
from tests.naive import contacts as naive
from tests.naive.statics import diagonal_touches, pixel_edges
from tests.strategies import label_images, repeatable

pictures = arrays(
    np.uint32, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.integers(0, 3)
)


def cells_of(labels):
    cells = np.full((labels.shape[0] + 2, labels.shape[1] + 2), EMPTY, np.int64)
    cells[1:-1, 1:-1] = np.where(labels > 0, labels.astype(np.int64), EMPTY)
    cells[-1] = 0
    return cells


def unit_edges(chain, height):
    x, y = chain.nodes[:, 1] - 1, height + 1 - chain.nodes[:, 0]
    nodes = list(zip(x.tolist(), y.tolist(), strict=True))
    return [frozenset(pair) for pair in pairwise(nodes)]


@given(labels=pictures)
@repeatable(150)
def test_chains_cover_every_edge_once(labels):
    cells = cells_of(labels)
    found = {}
    for chain in trace_chains(touching_edges(cells, cells > 0)):
        for edge in unit_edges(chain, labels.shape[0]):
            edges = found.setdefault((chain.high, chain.low), set())
            assert edge not in edges
            edges.add(edge)
    assert found == pixel_edges(labels)


@given(labels=pictures)
@repeatable()
def test_the_higher_label_lies_to_the_left_of_every_edge(labels):
    cells = cells_of(labels)
    for chain in trace_chains(touching_edges(cells, cells > 0)):
        steps = np.diff(chain.nodes, axis=0)
        middle = (chain.nodes[1:] + chain.nodes[:-1]) / 2
        left = np.column_stack((-steps[:, 1], steps[:, 0])) / 2  # rows grow downwards
        for side, label in ((left, chain.high), (-left, chain.low)):
            row, col = np.floor(middle + side).astype(int).T
            assert (cells[row, col] == label).all()


@given(labels=pictures, seed=st.integers(0, 99))
@repeatable()
def test_chains_do_not_depend_on_the_order_of_the_edges(labels, seed):
    cells = cells_of(labels)
    edges = touching_edges(cells, cells > 0)
    shuffled = np.random.default_rng(seed).permutation(edges)
    chains, again = trace_chains(edges), trace_chains(shuffled)
    assert [c.nodes.tolist() for c in chains] == [c.nodes.tolist() for c in again]


@given(labels=pictures)
@repeatable(150)
def test_crossing_corners_equal_their_twin(labels):
    cells = cells_of(labels)
    height = labels.shape[0]
    found = crossing_corners(cells, cells > 0).tolist()
    assert {
        (max(a, b), min(a, b), col - 1, height + 1 - row) for a, b, row, col in found
    } == diagonal_touches(labels)
    for above, below, row, col in found:
        assert above in cells[row - 1, col - 1 : col + 1]
        assert below in cells[row, col - 1 : col + 1]


def test_only_edges_of_fresh_cells():
    cells = np.array([[1, 2, 3]])
    assert touching_edges(cells, cells == 3)[:, :2].tolist() == [[3, 2]]


def test_an_enclosed_label_has_one_closed_chain_from_its_lowest_left_corner():
    cells = np.full((5, 5), 1)
    cells[1:4, 1:4] = 2
    (chain,) = trace_chains(touching_edges(cells, cells > 0))
    assert chain.nodes[0].tolist() == chain.nodes[-1].tolist() == [4, 1]
    assert len(chain.nodes) == 13


def test_pixels_that_cross_give_chains_around_each_pixel():
    cells = np.array([[2, 1], [1, 2]])
    chains = trace_chains(touching_edges(cells, cells > 0))
    assert [chain.nodes.tolist() for chain in chains] == [
        [[1, 0], [1, 1], [0, 1]],
        [[1, 2], [1, 1], [2, 1]],
    ]


compiled_too = pytest.mark.skipif(module._fast is None, reason="kernels are not compiled here")


def same_bytes(one, other):
    """Of dataclasses of arrays: the same types, shapes and bits."""
    pairs = zip(vars(one).values(), vars(other).values(), strict=True)
    return all(a.dtype == b.dtype and a.shape == b.shape and (a == b).all() for a, b in pairs)


def fresh_ids(cells, ids: list[int] | None) -> Mask | None:
    return None if ids is None else np.isin(cells, ids)


@compiled_too
@given(
    labels=pictures | label_images(),
    ids=st.none() | st.lists(st.integers(1, 4), max_size=3),
    margin=st.booleans(),
)
@repeatable(300)
def test_the_compiled_boundary_is_the_same(labels, ids, margin):
    cells = cells_of(labels)
    if not margin:
        cells = np.ascontiguousarray(cells[1:-1, 1:-1])
    fresh = fresh_ids(cells, ids)
    assert same_bytes(boundary_of(cells, fresh), boundary_numpy(cells, fresh))


@compiled_too
@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0), (1, 1), (1, 4), (4, 1)])
def test_the_compiled_boundary_of_hardly_anything_is_the_same(shape):
    cells = np.arange(shape[0] * shape[1]).reshape(shape)
    assert same_bytes(boundary_of(cells), boundary_numpy(cells))


@given(labels=pictures | label_images())
@repeatable(100)
def test_chains_equal_their_naive_twin(labels):
    boundary = boundary_of(cells_of(labels))
    found = {}
    for pair, begin, end in zip(
        boundary.labels.tolist(), boundary.begins[:-1], boundary.begins[1:], strict=True
    ):
        row, col = boundary.nodes[begin:end].T
        nodes = zip((col - 1).tolist(), (labels.shape[0] + 1 - row).tolist(), strict=True)
        found.setdefault(tuple(pair), []).append(list(nodes))
    assert list(found) == sorted(found)
    assert found == {
        pair: naive.chains(edges) for pair, edges in naive.directed_edges(labels).items()
    }


def test_labels_of_64_bits_survive():
    cells = np.array([[2**62], [2**40 + 1], [2**40]])
    assert boundary_of(cells).labels.tolist() == [[2**40 + 1, 2**40], [2**62, 2**40 + 1]]
    crossing = np.array([[EMPTY, 2**62], [2**40, EMPTY]])
    assert boundary_of(crossing).corners.tolist() == [[2**62, 2**40, 1, 1]]
