from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import example, given

from drystone.model.site import Site
from drystone_lab.second_arrangement import finer_labels, finer_picture, second_arrangement
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@repeatable(40)
@given(walls(max_px=22))
@example(finer_labels(bricks(3, 3, 5, 12)))
def test_is_its_slow_twin(labels):
    assert second_arrangement(labels) == tuple(
        None if expected is None else pytest.approx(expected, abs=1e-9)
        for expected in naive.second_definition(labels)
    )


def test_pixels_and_outlines_are_drawn_three_times_as_fine():
    wall = SimpleNamespace(labels=bricks(4, 3, 6, 14), outlines=None)
    expected = np.kron(wall.labels, np.ones((3, 3), np.uint32))
    np.testing.assert_array_equal(finer_picture(wall), expected)
    corners = np.array([[4.0, 2.0], [20.0, 2.0], [20.0, 10.0], [4.0, 10.0]])
    outlines = SimpleNamespace(blocks=((7, corners), (9, corners + np.array([16, -2]))))
    labels = finer_picture(SimpleNamespace(site=Site(20, 8, 0.5), outlines=outlines))
    assert labels.shape == (24, 60)
    expected = np.zeros((24, 60), np.uint32)
    expected[24 - 15 : 24 - 3, 6:30] = 7
    expected[24 - 12 : 24, 30:54] = 9
    np.testing.assert_array_equal(labels, expected)
