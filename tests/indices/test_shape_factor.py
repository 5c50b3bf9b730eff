"""SF (Eq. 3)."""

import numpy as np
import pytest

from drystone.indices.shape_factor import shape_factor
from drystone.model.stone import Stone
from drystone.poses import PoseBook


def test_an_upright_rectangle_has_one_and_a_turned_square_one_half() -> None:
    square = Stone(1, np.ones((10, 10), bool))
    assert shape_factor(PoseBook(0.3).pose(square, 90.0)) == pytest.approx(1.0)
    assert shape_factor(PoseBook(0.3).pose(square, 45.0)) == pytest.approx(0.5)
