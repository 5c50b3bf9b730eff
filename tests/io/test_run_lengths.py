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


@given(arrays(bool, st.tuples(st.integers(1, 40), st.integers(1, 40))), st.booleans())
def test_any_mask_comes_back(mask, packed):
    found = mask_of(runs(mask, packed=packed), Room(10**8))
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
    assert mask_of({"size": [height, width], "counts": text}, Room(10**8)).mask.sum() == run


@pytest.mark.parametrize(
    ("said", "text"),
    [
        ({"counts": [1, 2]}, "add up to 3"),
        ({"counts": [-1, 7]}, "below 0"),
        ({"counts": [1.5, 4.5]}, "whole numbers"),
        ({"counts": "\x01"}, "does not belong"),
        ({"counts": "PPPPPPPPP0"}, "does not belong"),  # more bits than a count can have
        ({"counts": "P"}, "cut short"),
        ({"counts": [[6]]}, "whole numbers"),
        ({"counts": [6], "size": [3, -2]}, "a picture of -2 x 3 px"),
    ],
)
def test_damaged_counts_and_sizes(said, text):
    with pytest.raises(ValueError, match=text):
        mask_of({"size": [2, 3], **said}, Room(10**8))
