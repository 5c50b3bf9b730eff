"""Values to ids, and the census of values."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from drystone.io.images import Picture
from drystone.io.labels import take_census, to_ids
from tests.naive import io as naive

shapes = array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=9)


@given(
    arrays(np.uint32, shapes, elements=st.integers(0, 5))
    | arrays(np.uint32, shapes, elements=st.integers(2**32 - 4, 2**32 - 1))
    | arrays(np.uint32, shapes)
)
def test_census(labels):
    census = take_census(labels)
    index, values = naive.index_of(labels)
    np.testing.assert_array_equal(census.index, index)
    assert census.values.tolist() == values
    assert census.counts.tolist() == [int((labels == value).sum()) for value in values]
    solid = [
        [_is_solid(labels, row, col) for col in range(labels.shape[1])]
        for row in range(labels.shape[0])
    ]
    np.testing.assert_array_equal(census.solid, solid)


def _is_solid(labels, row, col):
    around = labels[max(row - 1, 0) : row + 2, max(col - 1, 0) : col + 2]
    return around.shape == (3, 3) and len(np.unique(around)) == 1


@given(arrays(np.uint8, st.tuples(st.integers(1, 6), st.integers(1, 6), st.just(3))))
def test_ids_of_colours(picture):
    """The id of DESIGN 4.1, unless two colours would share it; never two colours, one id."""
    ids = to_ids(Picture(picture), 0).ids
    colours = {tuple(pixel) for row in picture.tolist() for pixel in row}
    assert len(np.unique(ids)) == len(colours)
    expected = [[naive.colour_id(*pixel) for pixel in row] for row in picture.tolist()]
    if len(set(np.ravel(expected).tolist())) == len(colours):
        np.testing.assert_array_equal(ids, expected)


def test_colours_that_would_share_an_id_are_kept_apart():
    picture = np.array([[[0, 0, 0], [5, 5, 5], [5, 0, 0], [1, 2, 3]]], np.uint8)
    image = to_ids(Picture(picture), 0)
    assert image.ids.tolist() == [[0, 5 * 0x010101, 5, 1 + 256 * 2 + 65536 * 3]]
    assert "greys" not in image.notices[0].message


def test_greys_among_colours_keep_their_value():
    picture = np.array([[[0, 0, 0], [7, 7, 7], [5, 0, 0], [1, 2, 3]]], np.uint8)
    image = to_ids(Picture(picture), 0)
    assert image.ids.tolist() == [[0, 7, 5, 1 + 256 * 2 + 65536 * 3]]
    assert "(greys: their value)" in image.notices[0].message
