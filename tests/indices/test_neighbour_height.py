"""NHR and the left neighbour (Eq. 6-8, DESIGN 4.5)."""

from statistics import fmean

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.indices.neighbour_height import left_neighbour, neighbour_height_ratio
from drystone.model.landscape import Box, Landscape, view_box
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.wall import Wall
from tests.naive import indices as naive
from tests.strategies import posed_on_walls, repeatable


@repeatable(80)
@given(scene=posed_on_walls(), others=st.lists(st.integers(1, 20).map(float), max_size=3))
def test_nhr_is_that_of_the_label_image(
    scene: tuple[Wall, PosedStone, int, int], others: list[float]
) -> None:
    wall, posed, row, col = scene
    landscape = Landscape.of(wall)
    box = view_box(posed, row, col, landscape.height_px)
    neighbour = left_neighbour(landscape, box)
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    expected = naive.left_neighbour(wall.labels, stone)
    if expected is None:
        assert neighbour is None
    else:
        extent = naive.extent_of(wall.labels == expected)
        assert neighbour == Box(extent.x0, extent.x1, extent.y0, extent.y1)
    assert neighbour_height_ratio(
        box, neighbour, fmean(others) if others else None
    ) == pytest.approx(naive.neighbour_height_ratio(wall.labels, stone, others))


def landscape_of(*boxes: Box) -> Landscape:
    return Landscape(Wall.empty(Site(60, 30)).occupied, boxes)


def test_the_neighbour_is_the_nearest_to_the_left_at_least_half_level() -> None:
    far, near, high = Box(0, 10, 0, 10), Box(10, 20, 0, 10), Box(12, 22, 6, 20)
    landscape = landscape_of(far, near, high, Box(40, 50, 0, 10))
    assert left_neighbour(landscape, Box(22, 30, 0, 10)) == near
    assert left_neighbour(landscape, Box(22, 30, 5, 15)) == high
    assert left_neighbour(landscape, Box(22, 30, 20, 30)) is None


def test_level_tops_are_best_and_the_first_of_a_course_is_compared_with_the_mean() -> None:
    box = Box(20, 30, 0, 10)
    assert neighbour_height_ratio(box, Box(0, 10, 0, 10), 99.0) == 0.0
    assert neighbour_height_ratio(box, Box(0, 10, 0, 14), None) == 0.4
    assert neighbour_height_ratio(box, None, 13.0) == pytest.approx(0.3)
    assert neighbour_height_ratio(box, None, None) == 0.0
