"""Run lengths are unpacked as pycocotools packs them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from pycocotools import mask as coco_mask

from drystone.io.outlines_in.annotations import mask_of, unpacked
from drystone.io.outlines_in.fill import Room
from tests.io.test_annotations import runs


def room():
    return Room(10**8)


@given(arrays(bool, st.tuples(st.integers(1, 40), st.integers(1, 40))), st.booleans())
def test_any_mask_comes_back(mask, packed):
    found = mask_of(runs(mask, packed=packed), room())
    whole = np.zeros_like(mask)
    if found is not None:
        height, width = found.mask.shape
        whole[found.row : found.row + height, found.col : found.col + width] = found.mask
        assert found.mask.any(axis=0)[[0, -1]].all()  # cut to its box
        assert found.mask.any(axis=1)[[0, -1]].all()
    np.testing.assert_array_equal(whole, mask)


@given(st.integers(1, 3000), st.integers(1, 3000), st.data())
def test_long_runs_come_back(height, width, data):
    size = height * width
    first = data.draw(st.integers(0, size - 1))
    run = data.draw(st.integers(1, size - first))
    counts = [first, run, size - first - run]
    packed = coco_mask.frPyObjects({"size": [height, width], "counts": counts}, height, width)
    text = packed["counts"]
    for given_text in (text, text.decode()):
        assert unpacked(given_text)[:3].tolist() == counts[: len(unpacked(given_text))]
    assert mask_of({"size": [height, width], "counts": text}, room()).mask.sum() == run


@pytest.mark.parametrize(
    ("counts", "text"),
    [
        ([1, 2], "add up to 3"),
        ([-1, 7], "below 0"),
        ([1.5, 4.5], "whole numbers"),
        ("\x01", "does not belong"),
        ("PPPPPPPPP0", "does not belong"),  # more bits than a count can have
        ("P", "cut short"),
        ([[6]], "whole numbers"),
    ],
)
def test_damaged_counts(counts, text):
    with pytest.raises(ValueError, match=text):
        mask_of({"size": [2, 3], "counts": counts}, room())


def test_sizes_that_are_none():
    with pytest.raises(ValueError, match="-2 x 3"):
        mask_of({"size": [3, -2], "counts": [6]}, room())
