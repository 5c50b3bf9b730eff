"""Shortest ways along rows, against a search on a heap."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.paths import DIAGONAL, STRAIGHT, row_lengths, row_ways, step_counts
from tests.naive import metrics as naive
from tests.strategies import repeatable


def noise(shape, share, seed):
    return np.asarray(np.random.default_rng(seed).random(shape) < share)


images = st.builds(
    noise,
    st.tuples(st.integers(1, 12), st.integers(1, 20)),
    st.sampled_from([0.5, 0.65, 0.8]),
    st.integers(0, 10**6),
)


def lengths_px(lengths):
    """Lengths in pixels, as the slow twin gives them."""
    counts = [step_counts(length) if length >= 0 else None for length in lengths.tolist()]
    return [None if c is None else c[0] + math.sqrt(2) * c[1] for c in counts]


def assert_as_slow(image, rows):
    last = image.shape[1] - 1
    expected = [naive.shortest_to(image, (row, 0), {(row, last)}) for row in rows.tolist()]
    assert lengths_px(row_lengths(image, rows)) == pytest.approx(expected, abs=1e-9)


@repeatable(120)
@given(images)
def test_lengths_are_those_of_the_slow_twin(image):
    assert_as_slow(image, np.arange(image.shape[0]))


@repeatable(100)
@given(images, st.data())
def test_a_way_is_as_long_as_it_should_be_and_stays_on_open_pixels(image, data):
    row = data.draw(st.integers(0, image.shape[0] - 1))
    (way,) = row_ways(image, np.array([row]))
    length = row_lengths(image, np.array([row]))[0]
    assert (way is None) == (length < 0)
    if way is None:
        return
    assert way[0].tolist() == [row, 0]
    assert way[-1].tolist() == [row, image.shape[1] - 1]
    assert image[tuple(way.T)].all()
    steps = np.abs(np.diff(way, axis=0))
    assert (steps.max(axis=1, initial=1) == 1).all()
    diagonal = np.count_nonzero(steps.sum(axis=1) == 2)
    assert (len(steps) - diagonal) * STRAIGHT + diagonal * DIAGONAL == length


@pytest.mark.parametrize("seed", [2492, 2882, 3913, 4836])
def test_a_better_way_that_is_found_just_after_the_first(seed):
    """Images in which a search that ends with the first bucket of the end is wrong; larger ones."""
    assert_as_slow(noise((12, 18), 0.62, seed), np.arange(12))
    assert_as_slow(noise((60, 110), 0.62 if seed % 4 else 0.95, seed), np.arange(seed % 9, 60, 27))


def test_edges():
    nothing = np.zeros((3, 4), bool)
    assert row_lengths(nothing, np.array([1])).tolist() == [-1]
    assert row_lengths(~nothing, np.zeros(0, int)).tolist() == []
    assert row_lengths(~nothing, np.array([2, 0, 2])).tolist() == [3 * STRAIGHT] * 3


def test_of_equal_ways_always_the_same_is_taken():
    ring = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], bool)
    found = row_ways(ring, np.array([1, 0]))
    assert [way.tolist() for way in found] == [[[1, 0], [2, 1], [1, 2]], [[0, 0], [0, 1], [0, 2]]]
    longer = np.insert(ring, [1, 2], True, axis=1)
    assert row_ways(longer, np.array([1]))[0].tolist() == [[1, 0], [2, 1], [2, 2], [1, 3], [1, 4]]
    assert row_ways(ring[:, :1], np.array([2]))[0].tolist() == [[2, 0]]


@given(*[st.integers(0, 10**6)] * 4)
def test_whole_numbers_order_ways_as_their_true_lengths_do(a, b, straight, diagonal):
    whole = (a - straight) * STRAIGHT + (b - diagonal) * DIAGONAL
    more, less = a - straight, diagonal - b  # longer when more > sqrt 2 * less
    true = np.sign(more * abs(more) - 2 * less * abs(less))
    assert np.sign(whole) == true
    assert step_counts(a * STRAIGHT + b * DIAGONAL) == (a, b)
