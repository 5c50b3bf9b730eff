import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

from drystone.drawing.outlines import (
    label_regions,
    pixel_loops,
    polygon_regions,
    stands_on_ground,
    wall_outlines,
    wall_regions,
)
from drystone.model.placement import Placement, Wedge
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from tests.naive import plotting as naive
from tests.verify.exact_examples import GAP_PX, exact_example

masks = hnp.arrays(bool, st.tuples(st.integers(1, 7), st.integers(1, 7)))


@given(masks)
def test_loops_fill_exactly_the_mask_and_every_corner_is_one(mask):
    """Pixels that touch at a corner are apart."""
    loops = pixel_loops(mask)
    np.testing.assert_array_equal(naive.covered(loops, mask.shape), mask)
    assert sum(naive.signed_area(loop) for loop in loops) == np.count_nonzero(mask)
    pieces = ndimage.label(mask)[1]
    assert sum(naive.signed_area(loop) > 0 for loop in loops) == pieces
    for loop in loops:
        steps = np.roll(loop, -1, axis=0) - loop
        assert ((steps == 0).sum(axis=1) == 1).all()
        assert ((steps == 0) != np.roll(steps == 0, 1, axis=0)).all()


@given(hnp.arrays(np.uint32, (5, 6), elements=st.sampled_from([0, 1, 300, 70_000, 2**32 - 1])))
def test_regions_are_the_labels(labels):
    regions = label_regions(labels)
    assert [region.id for region in regions] == [int(i) for i in np.unique(labels) if i]
    for region in regions:
        mask = labels == region.id
        rows, cols = np.nonzero(mask)
        np.testing.assert_array_equal(naive.covered(region.loops, labels.shape), mask)
        assert region.centroid == pytest.approx((cols.mean() + 0.5, 5 - rows.mean() - 0.5))


@pytest.mark.parametrize("px_per_m", [None, 200.0])
def test_wall_outlines_turn_counter_clockwise_and_scale(px_per_m):
    long = Stone(9, np.ones((2, 8), bool))
    lean = np.array([[1, 1, 1], [0, 0, 1]], bool)
    for stone, angle, size in ((long, 90.0, (2, 8)), (Stone(4, lean), 180.0, (3, 2))):
        height, width = size[1] // 2 + 1, size[0] // 2 + 1
        posed = PosedStone(
            stone, angle, 0.5, np.ones((height, width), bool), (width / 2, height / 2)
        )
        site = Site(10, 10, scale=0.5, px_per_m=px_per_m)
        wedge = Wedge(7, stone.id, np.ones((1, 2), bool), 9, 0)
        wall = Wall.empty(site).add(Placement(posed, 10 - height, 3), (wedge,))
        outlines = {i: loop * (px_per_m or 1.0) for i, loop in wall_outlines(wall).items()}
        assert np.ptp(outlines[stone.id], axis=0) == pytest.approx(size, abs=0.05)
        np.testing.assert_allclose(outlines[7], [[0, 0], [4, 0], [4, 2], [0, 2]])
        outline = outlines[stone.id]
        assert outline.mean(axis=0) == pytest.approx([6 + size[0] / 2, size[1] / 2], abs=2.1)
    # The lone pixel of `lean` is at the lower right; half a turn takes it to the upper left.
    top = outline[outline[:, 1] > outline[:, 1].max() - 0.1]
    assert top[:, 0].max() < outline[:, 0].mean()


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_regions_of_polygons_have_their_centroid_and_area(offset):
    corners = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]], float) + offset
    for polygon in (corners, corners[::-1], np.vstack([corners, corners[:1]])):
        (region,) = polygon_regions({9: polygon})
        assert region.id == 9
        # Two rectangles: 3 x 1 and 1 x 2.
        assert np.array(region.centroid) - offset == pytest.approx((1.1, 1.1))
        assert len(region.loops[0]) == 6
        assert naive.signed_area(region.loops[0] - offset) == pytest.approx(5.0)


def test_regions_of_a_wall_stand_on_its_lowest_stone():
    labels = np.array([[0, 5], [3, 5], [0, 0], [0, 0]], np.uint32)
    regions = wall_regions(labels)
    assert [region.centroid for region in regions] == [(0.5, 0.5), (1.5, 1.0)]
    assert stands_on_ground(regions)
    assert wall_regions(np.zeros((3, 3), np.uint32)) == ()
    polygons = {5: np.array([[0, 2], [1, 2], [1, 3.0]]), 3: np.array([[4, 2], [5, 2], [5, 3.0]])}
    assert [region.id for region in wall_regions(polygons)] == [3, 5]
    assert not stands_on_ground(wall_regions(polygons))


@pytest.mark.parametrize("unit", [1.0, 1 / 200.0])
def test_stones_that_settled_stand_on_the_ground(unit):
    """They hang .01 source px above it."""
    wall = exact_example().wall
    outlines = {block: loop * unit for block, loop in wall.outlines.blocks}
    lowest = min(loop[:, 1].min() for loop in outlines.values())
    assert lowest == pytest.approx(GAP_PX * unit, rel=1e-4)
    assert stands_on_ground(wall_regions(outlines))
    lifted = {block: loop + np.array([0, unit]) for block, loop in outlines.items()}
    assert not stands_on_ground(wall_regions(lifted))
    sunk = {block: loop - np.array([0, unit]) for block, loop in outlines.items()}
    assert not stands_on_ground(wall_regions(sunk))
