import numpy as np
import pytest
from benchmarks.labels import coursed_labels, irregular_labels

from drystone.contacts.blocks import model_from_labels

MAKERS = [coursed_labels, irregular_labels]


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("count", [10, 60, 300])
def test_there_are_enough_stones_and_no_gaps(make, count):
    labels, again, other = (make(np.random.default_rng(seed), count) for seed in (3, 3, 2))
    assert np.array_equal(labels, again)
    assert not np.array_equal(labels, other)
    assert labels.dtype == np.uint32
    assert labels.min() == 1
    assert count * 1.1 < len(np.unique(labels)) == labels.max() < 2.2 * count + 20
    assert 0.5 < labels.shape[1] / labels.shape[0] < 6


def test_joints_are_level_in_courses_and_tilted_in_irregular_walls():
    def square(make):
        interfaces = model_from_labels(make(np.random.default_rng(0), 30)).model.interfaces
        between = [i for i in interfaces if i.other and len(i.points) > 1]
        return np.mean([max(abs(x) for x in i.normal) == 1.0 for i in between])

    assert square(coursed_labels) == 1.0
    assert square(irregular_labels) < 0.3
