import numpy as np
import pytest
from benchmarks.labels import coursed_labels, irregular_labels

from drystone.contacts.blocks import model_from_labels

MAKERS = [coursed_labels, irregular_labels]


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("count", [10, 60, 300])
def test_there_are_enough_stones_and_no_gaps(make, count):
    labels = make(np.random.default_rng(3), count)
    assert labels.dtype == np.uint32
    assert labels.min() == 1
    assert count * 1.1 < len(np.unique(labels)) == labels.max() < 2.2 * count + 20
    width, height = labels.shape[::-1]
    assert 0.5 < width / height < 6


@pytest.mark.parametrize("make", MAKERS)
def test_walls_are_those_of_their_seed(make):
    first, again, other = (make(np.random.default_rng(seed), 20) for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert first.shape != other.shape or not np.array_equal(first, other)


def test_joints_are_level_in_courses_and_tilted_in_irregular_walls():
    def square(make):
        interfaces = model_from_labels(make(np.random.default_rng(0), 30)).model.interfaces
        between = [i for i in interfaces if i.other and len(i.points) > 1]
        return np.mean([max(abs(x) for x in i.normal) == 1.0 for i in between])

    assert square(coursed_labels) == 1.0
    assert square(irregular_labels) < 0.3
