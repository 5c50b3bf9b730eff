"""Walls that are too long to be looked at."""

import numpy as np
import pytest

from drystone.craft import Masonry, look
from drystone.errors import InputError
from tests.craft.walls import box, courses


def comb(teeth: int) -> np.ndarray:
    """One outline that every level line cuts many times."""
    x = np.arange(2.0 * teeth)
    y = np.where(np.arange(2 * teeth) % 2, 100.0, 1.0)
    return np.vstack([np.column_stack([x, y]), [[x[-1], 0.0], [0.0, 0.0]]])


@pytest.mark.parametrize(
    "last",
    [
        box(1e9, 0, 2, 1),
        box(0, 1e9, 2, 1),
        box(4, 0, 1e5, 1),
        np.add(comb(20_000), (4.0, 0.0)),
    ],
    ids=["far aside", "far up", "wide", "comb"],
)
def test_a_wall_that_reaches_too_far_is_refused(last):
    with pytest.raises(InputError, match=r"E192 wall: it reaches over .* mean heights"):
        look(Masonry({1: box(0, 0, 2, 1), 2: box(2, 0, 2, 1), 3: last}))


def test_a_long_wall_of_many_stones_is_looked_at():
    assert look(Masonry(courses([[10.0] * 500]))).findings["running_joints"].number == 1.0
