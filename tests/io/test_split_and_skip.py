"""Pieces that become stones have numbers that do not depend on what is skipped."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from drystone.errors import LabelImageError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas


def in_pieces():
    """Stones 1 of three pieces, 2 of one, and 3 of two; the pieces are 4, 5 and 6."""
    labels = np.zeros((50, 90), np.uint8)
    for stone, row, col, side in (
        (1, 2, 2, 20),
        (1, 2, 30, 15),
        (1, 2, 60, 12),
        (2, 26, 2, 18),
        (3, 26, 30, 16),
        (3, 26, 60, 11),
    ):
        labels[row : row + side, col : col + side] = stone
    return labels


ALL = {1: 400, 2: 324, 3: 256, 4: 225, 5: 144, 6: 121}


def split(labels, skip, **more):
    return read_stones(labels, settings=ReadSettings(pieces="split", skip=tuple(skip), **more))


@pytest.mark.parametrize(
    "skip", [(), *combinations(ALL, 1), (1, 4), (2, 6), (1, 3, 5), (1, 2, 3, 4, 6)]
)
def test_each_is_left_out_under_the_number_that_was_announced(skip):
    stones = split(in_pieces(), skip)
    assert areas(stones) == {i: area for i, area in ALL.items() if i not in skip}
    said = " ".join(str(notice) for notice in stones.notices)
    assert "W116" not in said
    for piece in (4, 5, 6):
        assert (f"{piece} ({ALL[piece]} px)" in said) == (piece not in skip)


def test_numbers_that_neither_a_stone_nor_a_piece_has_are_said():
    stones = split(in_pieces(), (4, 7))
    (notice,) = [n for n in stones.notices if n.code == "W116"]
    assert notice.message == "no stone 7 to skip."
    whole = read_stones(in_pieces() % 3, settings=ReadSettings(pieces="keep-largest", skip=(4,)))
    assert "no stone 4 to skip." in [n.message for n in whole.notices]


def test_all_skipped():
    with pytest.raises(LabelImageError, match=r"E104.*all were skipped"):
        split(in_pieces(), ALL)


def test_what_is_a_speck_beside_skipped_giants_is_not_numbered():
    labels = np.pad(in_pieces(), ((0, 400), (0, 400)))
    labels[60:440, 2:242], labels[60:440, 246:486], labels[4:50, 100:480] = 7, 8, 9
    labels[2, 480::2] = 10
    everything = areas(split(labels, (), min_area_px=None))
    for skip in ((7, 8), (7, 8, 9), (1, 9)):
        left = {i: area for i, area in everything.items() if i not in skip}
        assert areas(split(labels, skip)) == left


@given(
    arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, min_side=3, max_side=9)),
    st.sets(st.integers(1, 12)),
)
def test_skipping_is_leaving_out(values, skip):
    labels = np.pad(values % 4 * 100, 1)
    if not labels.any():
        return
    more = {"min_area_px": 2, "mask": False}
    try:
        everything = areas(split(labels, (), **more))
    except LabelImageError:
        return
    skip = {sorted(everything)[i % len(everything)] for i in skip}
    left = {i: area for i, area in everything.items() if i not in skip}
    if left:
        assert areas(split(labels, skip, **more)) == left
