"""Pieces of label images, and what is painted into them, pixel by pixel."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import patches as module
from drystone.kernels.boundary import EMPTY
from drystone.kernels.patches import (
    GROUND,
    MARGIN_PX,
    cut_out_numpy,
    paint_numpy,
    painted_patch,
    whole_patch,
)
from tests.strategies import dust_labels, masks, repeatable

compiled_too = pytest.mark.skipif(module._fast is None, reason="kernels are not compiled here")


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
shapes = st.tuples(st.integers(0, 12), st.integers(0, 12))


@given(labels=dust_labels(), shape=shapes, top=around, left=around)
@repeatable(150)
def test_cells_show_the_image_and_what_is_around_it(labels, shape, top, left):
    expected = cells_at(labels, shape, top, left)
    cells = np.full(shape, 99)
    cut_out_numpy(labels, cells, top, left)
    assert cells.tolist() == expected


@compiled_too
@given(labels=dust_labels(), shape=shapes, top=around, left=around, strided=st.booleans())
@repeatable(150)
def test_the_compiled_cells_are_the_same(labels, shape, top, left, strided):
    if strided:
        labels = np.repeat(labels, 2, axis=1)[::-1, ::2]
    labels.flags.writeable = False
    expected, cells = np.full(shape, 98), np.full(shape, 99)
    cut_out_numpy(labels, expected, top, left)
    module._fast.cut_out(labels, cells, top, left)
    assert cells.tolist() == expected.tolist()


@pytest.mark.parametrize("dtype", [np.uint8, np.uint32, np.int64, np.int16])
def test_a_whole_image_has_a_margin_of_nothing_and_the_ground_below(dtype):
    labels = np.array([[0, 3], [5, 5]], dtype)
    patch = whole_patch(labels)
    assert patch.cells.tolist() == cells_at(labels, (8, 8), -MARGIN_PX, -MARGIN_PX)
    assert (patch.fresh, patch.origin) == (None, (-MARGIN_PX, 2 + MARGIN_PX))


def test_ids_of_more_than_32_bits_survive():
    labels = np.array([[2**40, 0]])
    assert whole_patch(labels).cells[MARGIN_PX].tolist() == [EMPTY] * 3 + [2**40] + [EMPTY] * 4


KERNELS = [
    pytest.param(paint_numpy, id="numpy"),
    pytest.param(getattr(module._fast, "paint", None), id="compiled", marks=compiled_too),
]


@pytest.mark.parametrize("paint", KERNELS)
def test_painting_marks_pixels_and_adds_up_their_places(paint):
    @given(mask=masks(9), row=st.integers(0, 3), col=st.integers(0, 3))
    @repeatable(60)
    def check(mask, row, col):
        mask.flags.writeable = False
        cells, fresh = np.full((12, 12), EMPTY), np.zeros((12, 12), bool)
        rows, cols = np.nonzero(mask)
        assert paint(mask, 2**32 - 1, row, col, cells, fresh) == (
            len(rows),
            cols.sum(),
            rows.sum(),
        )
        painted = list(zip((rows + row).tolist(), (cols + col).tolist(), strict=True))
        assert [tuple(place) for place in np.argwhere(fresh).tolist()] == painted
        assert [tuple(place) for place in np.argwhere(cells == 2**32 - 1).tolist()] == painted
        assert (cells[~fresh] == EMPTY).all()

    check()


@given(labels=dust_labels(), parts=st.lists(st.tuples(masks(5), around, around), min_size=1))
@repeatable(100)
def test_a_patch_is_the_painted_image_around_all_parts(labels, parts):
    """Parts may leave the image: what is drawn there is seen too."""
    parts = [(100 + k, row, col, mask) for k, (mask, row, col) in enumerate(parts)]
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
    assert [area for area, _, _ in sums] == [mask.sum() for _, _, _, mask in parts]
