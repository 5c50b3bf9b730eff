import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.metrics.reduce import reduce_labels
from tests.metrics.walls import walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@repeatable()
@given(walls(), st.floats(0.05, 2.5))
def test_is_its_slow_twin(labels, scale):
    reduced = reduce_labels(labels, scale)
    assert np.array_equal(reduced, naive.reduce_labels(labels, scale))
    assert reduced.dtype == labels.dtype


@repeatable()
@given(walls())
def test_scale_one_copies(labels):
    reduced = reduce_labels(labels, 1.0)
    assert np.array_equal(reduced, labels)
    assert not np.shares_memory(reduced, labels)


@repeatable()
@given(walls(), st.floats(0.01, 3))
def test_no_label_is_invented(labels, scale):
    assert set(np.unique(reduce_labels(labels, scale))) <= set(np.unique(labels))


def test_working_size_rounds_half_up():
    assert reduce_labels(np.ones((5, 7), np.uint8), 0.5).shape == (3, 4)


def test_a_scale_must_be_positive():
    with pytest.raises(ValueError, match="scale must be positive"):
        reduce_labels(np.ones((5, 7), np.uint8), 0.0)
