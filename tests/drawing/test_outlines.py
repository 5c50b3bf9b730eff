from itertools import product

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

from drystone.drawing.outlines import label_regions, stands_on_ground, wall_outlines, wall_regions
from drystone.verify.outlines import plan_polygons
from tests.naive import plotting as naive
from tests.polygons import box
from tests.verify.exact_examples import GAP_PX, exact_example
from tests.verify.examples import example


@given(hnp.arrays(np.uint32, (7, 6), elements=st.sampled_from([0, 300, 70_000, 2**32 - 1])))
def test_regions_are_the_labels_and_every_corner_is_one(labels):
    """Pixels that touch at a corner are apart."""
    regions = label_regions(labels)
    assert [region.id for region in regions] == [int(i) for i in np.unique(labels) if i]
    for region in regions:
        mask = labels == region.id
        rows, cols = np.nonzero(mask)
        np.testing.assert_array_equal(naive.covered(region.loops, labels.shape), mask)
        assert region.centroid == pytest.approx((cols.mean() + 0.5, 7 - rows.mean() - 0.5))
        areas = list(map(naive.signed_area, region.loops))
        assert sum(areas) == np.count_nonzero(mask)
        assert sum(area > 0 for area in areas) == ndimage.label(mask)[1]
        for loop in region.loops:
            steps = np.roll(loop, -1, axis=0) - loop
            assert ((steps == 0).sum(axis=1) == 1).all()
            assert ((steps == 0) != np.roll(steps == 0, 1, axis=0)).all()


@pytest.mark.parametrize("px_per_m", [None, 200.0])
@pytest.mark.parametrize("wall", [example, exact_example])
def test_wall_outlines_lie_where_the_plan_has_its_blocks(wall, px_per_m):
    made = wall(0.5, px_per_m)
    expected = (pair for group in plan_polygons(made.plan, made.stones) for pair in group)
    found = wall_outlines(made.wall)
    for block, corners in expected:
        outline = shapely.Polygon(found.pop(block) * (px_per_m or 1.0))
        assert outline.exterior.is_ccw
        assert outline.symmetric_difference(shapely.Polygon(corners)).area < 1e-6
    assert found == {}


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_regions_of_polygons_have_their_centroid_and_area(offset):
    corners = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]], float) + offset
    for polygon in (corners, corners[::-1], np.vstack([corners, corners[:1]])):
        (region,) = wall_regions({9: polygon})
        assert region.id == 9
        # Two rectangles: 3 x 1 and 1 x 2.
        assert np.array(region.centroid) - offset == pytest.approx((1.1, 1.1))
        assert len(region.loops[0]) == 6
        assert naive.signed_area(region.loops[0] - offset) == pytest.approx(5.0)


def test_regions_of_a_wall_stand_on_its_lowest_stone_and_settled_stones_on_the_ground():
    labels = np.array([[0, 5], [3, 5], [0, 0], [0, 0]], np.uint32)
    regions = wall_regions(labels)
    assert [region.centroid for region in regions] == [(0.5, 0.5), (1.5, 1.0)]
    assert stands_on_ground(regions)
    assert wall_regions(np.zeros((3, 3), np.uint32)) == ()
    polygons = wall_regions({5: box(0, 2, 1, 3), 3: box(4, 2, 5, 3)})
    assert [region.id for region in polygons] == [3, 5]
    # Settled stones hang .01 source px above it.
    blocks = exact_example().wall.outlines.blocks
    assert min(loop[:, 1].min() for _, loop in blocks) == pytest.approx(GAP_PX, rel=1e-4)
    for unit, lift in product((1.0, 1 / 200.0), (0, 1, -1)):
        outlines = {block: (loop + np.array([0, lift])) * unit for block, loop in blocks}
        assert stands_on_ground(wall_regions(outlines)) is (lift == 0)
