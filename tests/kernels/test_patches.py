"""Pieces of label images, and what is painted into them, pixel by pixel."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.boundary import EMPTY
from drystone.kernels.patches import GROUND, MARGIN_PX, painted_patch, whole_patch
from tests.strategies import dust_labels, masks, repeatable


def cell(labels, row, col):
    """What cells say about a pixel inside or outside of an image."""
    height, width = labels.shape
    if row >= height:
        return GROUND
    inside = row >= 0 and 0 <= col < width
    return (int(labels[row, col]) or EMPTY) if inside else EMPTY


def cells_at(labels, shape, top, left):
    return [[cell(labels, top + r, left + c) for c in range(shape[1])] for r in range(shape[0])]


around = st.integers(-9, 9)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint32, np.int64, np.int16])
def test_a_whole_image_has_a_margin_of_nothing_and_the_ground_below(dtype):
    labels = np.array([[0, 3], [5, 5]], dtype)
    patch = whole_patch(labels)
    assert patch.cells.tolist() == cells_at(labels, (8, 8), -MARGIN_PX, -MARGIN_PX)
    assert (patch.fresh, patch.origin) == (None, (-MARGIN_PX, 2 + MARGIN_PX))


def test_ids_of_more_than_32_bits_survive():
    labels = np.array([[2**40, 0]])
    assert whole_patch(labels).cells[MARGIN_PX].tolist() == [EMPTY] * 3 + [2**40] + [EMPTY] * 4


@given(
    labels=dust_labels(),
    parts=st.lists(st.tuples(masks(9), around, around), min_size=1),
    strided=st.booleans(),
)
@repeatable(100)
def test_a_patch_is_the_painted_image_around_all_parts(labels, parts, strided):
    """Parts may leave the image: what is drawn there is seen too.  Views are read in place."""
    parts = [(2**32 - 1 - k, row, col, mask) for k, (mask, row, col) in enumerate(parts)]
    if strided:
        labels = np.repeat(labels, 2, axis=1)[::-1, ::2]
        parts = [(*part, np.asfortranarray(mask)) for *part, mask in parts]
    labels.flags.writeable = False
    before = labels.copy()
    patch, sums = painted_patch(labels, parts)
    assert (labels == before).all()
    left, up = patch.origin
    top = labels.shape[0] - up
    expected = np.array(cells_at(labels, patch.cells.shape, top, left))
    fresh = np.zeros(expected.shape, bool)
    for label, row, col, mask in parts:
        window = np.s_[row - top :, col - left :]
        view = expected[window][: mask.shape[0], : mask.shape[1]]
        view[mask] = label
        fresh[window][: mask.shape[0], : mask.shape[1]][mask] = True
    assert (patch.cells == expected).all()
    assert (patch.fresh == fresh).all()
    rows, cols = np.nonzero(fresh)
    assert (rows.min(), cols.min()) == (MARGIN_PX, MARGIN_PX)
    assert (rows.max() + 1 + MARGIN_PX, cols.max() + 1 + MARGIN_PX) == fresh.shape
    places = [np.nonzero(mask) for *_, mask in parts]
    assert sums == [(len(rows), cols.sum(), rows.sum()) for rows, cols in places]
