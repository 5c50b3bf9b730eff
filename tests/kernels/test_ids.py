"""Ids in images: numbered and counted, in runs and in pieces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

from drystone.kernels import ids as module
from drystone.kernels.ids import counted, looked_up, numbered
from drystone.kernels.label_runs import label_runs, runs_in_pieces
from tests.strategies import label_images, repeatable

shapes = hnp.array_shapes(min_dims=2, max_dims=2, max_side=9)
several = st.sampled_from([0, 1, 2, 7, 300, 65535, 65536, 70000, 2**31, 2**32 - 1])


@repeatable(150)
@given(
    st.one_of(
        hnp.arrays(np.uint32, shapes, elements=several),
        hnp.arrays(np.uint8, shapes, elements=st.integers(0, 5)),
        hnp.arrays(np.int64, shapes, elements=st.integers(0, 400)),
    )
)
def test_numbers_are_places_among_the_sorted_values(ids):
    for image in (ids, ids.T):
        index, found = numbered(image)
        values, places = np.unique(image, return_inverse=True)
        assert index.tolist() == (1 + places).tolist()
        assert found.tolist() == values.tolist()
        assert index.dtype == np.uint8  # there are few
        assert found.dtype == np.int64


@pytest.mark.parametrize(("most", "kind"), [(255, np.uint8), (256, np.uint16), (65536, np.int32)])
def test_numbers_have_no_more_bytes_than_they_need(most, kind):
    for ids in (np.arange(most), 10**6 * np.arange(most)):
        index, _ = numbered(ids.reshape(1, -1))
        assert index.dtype == kind
        assert index[0].tolist() == list(range(1, most + 1))


@pytest.mark.parametrize(("kind", "block"), [(np.uint8, 1), (np.uint32, 5), (np.int64, 1 << 20)])
def test_counting_and_looking_up_do_not_depend_on_the_blocks(kind, block, monkeypatch):
    monkeypatch.setattr(module, "BLOCK_PX", block)
    monkeypatch.setattr(module, "_CACHED_PX", 10)
    rng = np.random.default_rng(2)
    table, index = rng.integers(0, 99, 6).astype(np.uint16), rng.integers(0, 6, (7, 9)).astype(kind)
    assert counted(index, 8).tolist() == [int((index == k).sum()) for k in range(9)]
    for image in (index, index.T):
        assert np.array_equal(looked_up(table, image), table[image])
    out = np.zeros(index.shape, np.uint32)
    assert looked_up(table.astype(np.uint32), index, out) is out
    assert np.array_equal(out, table[index])


@given(labels=label_images())
@repeatable(100)
def test_runs_paint_the_image_as_long_as_they_can_be_and_pieces_are_those_of_each_label(labels):
    runs = label_runs(labels)
    painted = np.zeros_like(labels)
    places = zip(runs.labels, runs.rows, runs.begins, runs.ends, strict=True)
    for label, row, begin, end in places:
        assert begin < end
        assert not painted[row, begin:end].any()
        painted[row, begin:end] = label
        assert begin == 0 or labels[row, begin - 1] != label
        assert end == labels.shape[1] or labels[row, end] != label
    assert (painted == labels).all()
    assert (runs.lengths == runs.ends - runs.begins).all()
    order = list(zip(runs.rows.tolist(), runs.begins.tolist(), strict=True))
    assert order == sorted(order)
    numbers = runs_in_pieces(runs)
    assert sorted(set(numbers.tolist())) == list(range(numbers.max(initial=-1) + 1))
    found = np.zeros(labels.shape, int)
    for number, row, begin, end in zip(numbers, runs.rows, runs.begins, runs.ends, strict=True):
        found[row, begin:end] = number + 1
    for label in np.unique(labels[labels > 0]):
        pieces, count = ndimage.label(labels == label, np.ones((3, 3)))
        pairs = {tuple(pair) for pair in zip(pieces.ravel(), found.ravel(), strict=True) if pair[0]}
        assert len(pairs) == count == len({pair[1] for pair in pairs})


@pytest.mark.parametrize("shape", [(0, 0), (0, 4), (4, 0), (2, 3)])
def test_nothing_has_no_runs(shape):
    runs = label_runs(np.zeros(shape, np.uint32))
    assert len(runs.rows) == len(runs_in_pieces(runs)) == 0
