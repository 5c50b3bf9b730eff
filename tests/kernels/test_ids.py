"""Numbering and counting ids."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from drystone.kernels import ids as module
from drystone.kernels.ids import counted, looked_up, numbered
from tests.naive import io as naive
from tests.strategies import repeatable

shapes = hnp.array_shapes(min_dims=2, max_dims=2, max_side=9)
values = st.sampled_from([0, 1, 2, 7, 300, 65535, 65536, 70000, 2**31, 2**32 - 1])


@repeatable(150)
@given(
    st.one_of(
        hnp.arrays(np.uint32, shapes, elements=values),
        hnp.arrays(np.uint8, shapes, elements=st.integers(0, 5)),
        hnp.arrays(np.int64, shapes, elements=st.integers(0, 400)),
    )
)
def test_numbers_are_places_among_the_sorted_values(ids):
    for image in (ids, ids.T):
        index, found = numbered(image)
        expected, sorted_values = naive.index_of(image)
        assert index.tolist() == expected.tolist()
        assert found.tolist() == sorted_values
        assert index.dtype == np.uint8  # there are few
        assert found.dtype == np.int64


@pytest.mark.parametrize(("most", "kind"), [(255, np.uint8), (256, np.uint16), (65536, np.int32)])
def test_numbers_have_no_more_bytes_than_they_need(most, kind):
    for ids in (np.arange(most), 10**6 * np.arange(most)):
        index, _ = numbered(ids.reshape(1, -1))
        assert index.dtype == kind
        assert index[0].tolist() == list(range(1, most + 1))


@pytest.mark.parametrize("block", [1, 5, 1 << 20])
def test_counts_do_not_depend_on_the_blocks(block, monkeypatch):
    monkeypatch.setattr(module, "BLOCK_PX", block)
    index = np.random.default_rng(1).integers(0, 6, (7, 9)).astype(np.int32)
    assert counted(index, 8).tolist() == [int((index == k).sum()) for k in range(9)]


@pytest.mark.parametrize("kind", [np.uint8, np.uint32, np.int64])
def test_looking_up_is_indexing(kind, monkeypatch):
    monkeypatch.setattr(module, "_CACHED_PX", 10)
    rng = np.random.default_rng(2)
    table, index = rng.integers(0, 99, 6).astype(np.uint16), rng.integers(0, 6, (7, 9)).astype(kind)
    for image in (index, index.T):
        assert np.array_equal(looked_up(table, image), table[image])
    out = np.zeros(index.shape, np.uint32)
    assert looked_up(table.astype(np.uint32), index, out) is out
    assert np.array_equal(out, table[index])
