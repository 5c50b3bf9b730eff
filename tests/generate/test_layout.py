import numpy as np
import pytest
import shapely
from hypothesis import given

from drystone.errors import UsageError
from drystone.generate.layout import accepted, is_whole, polygon_area, whole_mask
from drystone.kernels.outline import rasterise_polygon
from tests.polygons import simple_polygons
from tests.strategies import repeatable


@repeatable()
@given(simple_polygons())
def test_turning_direction_does_not_matter(outline):
    one, other = (rasterise_polygon(ring)[0] for ring in (outline, outline[::-1]))
    assert np.array_equal(one, other)
    area = polygon_area(outline)
    assert area == pytest.approx(polygon_area(outline[::-1]))
    assert area == pytest.approx(shapely.Polygon(outline).area)


@pytest.mark.parametrize(
    ("picture", "whole"),
    [("111/101/111", False), ("101/101", False), ("10/01", True), ("110/011", True), ("0", False)],
)
def test_whole_is_one_piece_without_holes(picture, whole):
    mask = np.array([[pixel == "1" for pixel in row] for row in picture.split("/")])
    assert is_whole(mask) is whole


def test_rejected_draws_are_passed_over():
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    masks = map(whole_mask, [None, square * 0.1, square])
    assert accepted(masks, "test").shape == (2, 2)


def test_settings_without_any_stone_say_so():
    with pytest.raises(UsageError, match=r"E130 generate test: no stone in 1000 draws"):
        accepted((None for _ in range(1001)), "test")
