"""Outlines of stones that are pixels."""

import numpy as np
import pytest

from drystone.kernels.polygons import area_and_centroid
from drystone.kernels.profiles import extremes
from drystone.model.placement import Placement
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from drystone.search.pixel_outlines import column_outline, placed_outline, posed_outline
from tests.planner.scenes import rubble

HOLLOW = np.array([[1, 1, 1, 0], [0, 0, 1, 1], [1, 1, 1, 0]], bool)
"""Hollow at the left, with a shoulder at the right."""


def poses() -> list[PosedStone]:
    book = PoseBook(0.5)
    return [book.pose(stone, angle) for stone in rubble(4, 6) for angle in (0.0, 37.0, 90.0)]


@pytest.mark.parametrize("mask", [HOLLOW, *(posed.mask for posed in poses())])
def test_an_outline_reaches_over_each_column_from_its_lowest_to_its_highest_pixel(
    mask: np.ndarray,
) -> None:
    height, width = mask.shape
    lows, highs = [], []
    for column in range(width):
        filled = [height - 1 - row for row in range(height) if mask[row, column]]
        lows.append(min(filled))
        highs.append(max(filled) + 1)
    corners = column_outline(mask)
    bottoms, tops = extremes(corners, 0.0, 0.5, 2 * width)
    assert bottoms.tolist() == np.repeat(lows, 2).tolist()
    assert tops.tolist() == np.repeat(highs, 2).tolist()
    assert area_and_centroid(corners)[0] == pytest.approx(sum(highs) - sum(lows))


def test_outlines_are_where_the_pixels_are() -> None:
    site = Site(60, 40, scale=0.5)
    for posed in poses():
        placement = Placement(posed, 3, 7)
        rows, cols = np.nonzero(Wall.empty(site).add(placement).labels)
        corners = placed_outline(placement, site.height_px)
        left, bottom = corners.min(axis=0).tolist()
        right, top = corners.max(axis=0).tolist()
        assert [left, right] == [cols.min() / 0.5, (cols.max() + 1) / 0.5]
        assert [bottom, top] == [(39 - rows.max()) / 0.5, (40 - rows.min()) / 0.5]
        x, y = placement.centroid(site.height_px)
        around = posed_outline(posed) + np.array([x, y]) / 0.5
        np.testing.assert_allclose(around, corners, atol=1e-9)
