"""IS and boundary stones (Eq. 10, §3.8)."""

import numpy as np
import pytest
from hypothesis import given

from drystone.indices.inward_slope import inward_slope, is_boundary
from drystone.model.landscape import Box, Landscape
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from tests.naive import indices as naive
from tests.strategies import posed_on_walls, repeatable

EMPTY = Landscape.of(Wall.empty(Site(40, 20)))
FALLS_TO_THE_RIGHT = PoseBook().pose(
    Stone(1, np.array([[1, 1, 0, 0], [1, 1, 1, 0], [1, 1, 1, 1]], bool)), 0.0
)


@repeatable(80)
@given(scene=posed_on_walls())
def test_is_is_that_of_the_wall_image(scene: tuple[Wall, PosedStone, int, int]) -> None:
    wall, posed, row, col = scene
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    assert inward_slope(Landscape.of(wall), posed, col) == pytest.approx(
        naive.inward_slope(stone, col + posed.anchor[0])
    )


def test_falling_inwards_is_positive_at_both_ends() -> None:
    # Highest points: column 0 (outermost of two), and column 2, one px lower.
    assert inward_slope(EMPTY, FALLS_TO_THE_RIGHT, 0) == pytest.approx(0.5)
    assert inward_slope(EMPTY, FALLS_TO_THE_RIGHT, 36) == pytest.approx(-0.5)
    assert inward_slope(EMPTY, FALLS_TO_THE_RIGHT.mirrored, 36) == pytest.approx(0.5)


def test_a_steep_slope_is_clipped_and_a_level_top_has_none() -> None:
    steep = np.ones((9, 2), bool)
    steep[:8, 1] = False
    steep_posed = PosedStone(Stone(1, steep), 0.0, 1.0, steep, (0.75, 4.0))
    assert inward_slope(EMPTY, steep_posed, 0) == 1.0
    flat = PoseBook().pose(Stone(1, np.ones((3, 6), bool)), 0.0)
    assert inward_slope(EMPTY, flat, 0) == 0.0
    assert inward_slope(EMPTY, PoseBook().pose(Stone(1, np.ones((3, 1), bool)), 0.0), 0) == 0.0


@pytest.mark.parametrize(
    ("left", "right", "expected"), [(0, 5, True), (4, 9, True), (5, 9, False), (31, 36, True)]
)
def test_boundary_stones_are_nearer_to_an_end_than_the_narrowest_is_wide(
    left: int, right: int, expected: bool
) -> None:
    assert is_boundary(EMPTY, Box(left, right, 0, 3), narrowest_px=5) is expected


def test_a_peak_exactly_at_the_centroid_slopes_to_neither_side() -> None:
    pyramid = np.array([[0, 0, 1, 0, 0], [0, 1, 1, 1, 0], [1, 1, 1, 1, 1]], bool)
    posed = PosedStone(Stone(1, pyramid), 0.0, 1.0, pyramid, (2.5, 1.0))
    assert inward_slope(EMPTY, posed, 0) == 0.0
