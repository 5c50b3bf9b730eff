"""Turned outlines, made once."""

import numpy as np
import pytest

from drystone.kernels.polygons import mirrored_polygon, polygon_edges
from drystone.kernels.profiles import hanging
from drystone.kernels.raster import turn
from drystone.model.outline import stone_outline
from drystone.model.stone import Stone
from drystone.settle.book import OutlineBook

TRAPEZE = Stone(7, np.tri(9, 16, 5, dtype=bool))


def test_an_outline_is_the_stones_own_within_the_tolerance():
    for tolerance_px in (0.1, 0.35, 2.0):
        outline = OutlineBook(tolerance_px, 2.0).outline(TRAPEZE)
        assert (outline == stone_outline(TRAPEZE.mask, tolerance_px)).all()
    assert len(OutlineBook(0.1, 2.0).outline(TRAPEZE)) > len(OutlineBook(2.0, 2.0).outline(TRAPEZE))


@pytest.mark.parametrize("angle_deg", [0.0, 90.0, -33.0])
def test_hung_outlines_are_turned_then_mirrored_for_the_right(angle_deg):
    book = OutlineBook(0.35, 2.0)
    outline = book.outline(TRAPEZE)
    left, right = (book.hung(TRAPEZE, angle_deg, side) for side in ("left", "right"))
    assert (left.turned.corners == turn(outline, angle_deg)).all()
    assert (right.turned.corners == mirrored_polygon(left.turned.corners, 0.0)).all()
    for hung, side in ((left, "left"), (right, "right")):
        assert (hung.turned.outline == outline).all()
        assert (hung.turned.angle_deg, hung.turned.side) == (angle_deg, side)
        assert hung.turned.size_px == pytest.approx(np.sqrt(TRAPEZE.area_px))
        assert (hung.turned.edges == polygon_edges(hung.turned.corners)).all()
        for mine, expected in zip(hung.profile, hanging(hung.turned.corners, 2.0), strict=True):
            assert np.array_equal(mine, expected)
    assert (left.profile.left, left.profile.right) == (-right.profile.right, -right.profile.left)
