"""The paper's objective at all positions (Eq. 12-13)."""

import numpy as np
import pytest
from hypothesis import given

from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.placement.feasible import feasible_positions
from drystone.placement.objective import eq12_objective, threshold
from tests.naive import placement as naive
from tests.strategies import posed_on_walls, repeatable


@repeatable(40)
@given(scene=posed_on_walls())
def test_objective_is_that_of_every_position_on_its_own(
    scene: tuple[Wall, PosedStone, int, int],
) -> None:
    wall, posed, _, _ = scene
    landscape = Landscape.of(wall)
    positions = feasible_positions(landscape, posed)[:40]
    expected = [
        naive.eq12(wall.occupied, posed.mask, posed.anchor[0], (row, col), 0.7)
        for row, col in positions.tolist()
    ]
    assert eq12_objective(landscape, posed, positions, 0.7) == pytest.approx(expected, abs=1e-12)


def test_the_threshold_itself_counts_as_below() -> None:
    assert threshold(np.array([0.0, 0.7, 0.7000001, 1.0]), 0.7).tolist() == [0, 0, 0.7000001, 1.0]
