"""Overlap of outlines: none where they touch, whatever rounding does, and all of it elsewhere."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import turn
from drystone.model.overlap import CIRCLE, common_parts, deepest_overlap, overlap_depth, shape_of
from tests.naive import overlap as naive
from tests.polygons import box_of, simple_polygons
from tests.strategies import repeatable

RIGHT = 1e-6
"""Of the size: no overlap is seen or missed above it."""


def box(*sides):
    return shapely.Polygon(box_of(*sides))


@pytest.mark.parametrize(("first", "second", "depth"), [
    (box(0, 0, 4, 2), box(0, 2, 4, 2), 0.0),
    (box(0, 0, 4, 2), box(9, 2, 4, 2), 0.0),
    (box(0, 0, 4, 2), box(0, 1.75, 4, 2), 0.25),
    # A tip of 1 px in a large stone.
    (shapely.Polygon([(5, 4), (3, 9), (7, 9)]), box(0, 0, 10, 5), 1.0),
    # A stone wholly in another, and one on top of its like.
    (box(0, 0, 10, 10), box(4, 4, 2, 2), 4.0),
    (box(0, 0, 10, 10), box(0, 0, 10, 10), 5.0),
    # The deepest point is none of the corners, but the middle of an edge.
    (box(0, 0, 20, 20), box(-1, 9, 22, 2), 9.0),
])  # fmt: skip
def test_depth_of_simple_shapes(first, second, depth):
    assert overlap_depth(first, second) == pytest.approx(depth, abs=1e-9)
    assert overlap_depth(second, first) == pytest.approx(depth, abs=1e-9)


@repeatable(30)
@given(
    simple_polygons(max_corners=8),
    simple_polygons(max_corners=8),
    st.tuples(st.floats(-5, 5), st.floats(-5, 5)),
)
def test_depth_is_that_of_all_points_of_the_rims(one, other, shift):
    pieces = 12
    moved = other + np.array(shift)
    depth, slow = overlap_depth(shape_of(one), shape_of(moved)), naive.depth(one, moved, pieces)
    size = max(float(np.hypot(*np.ptp(ring, axis=0))) for ring in (one, moved))
    # The twin misses the deepest point of an edge, or of the grid, by half a step.
    assert slow - CIRCLE * size <= depth <= slow + size / pieces


@st.composite
def stacked(draw):
    """How far one of two polygons that touch is pushed into the other gives both, and their size.

    They touch with corners on corners or edges, edges on parts of edges, or along common lines,
    and are seen from anywhere.
    """
    size = 10.0 ** draw(st.integers(-3, 3))
    below, above = (draw(simple_polygons(max_corners=7)) for _ in range(2))
    below, above = below - (0.0, below[:, 1].max()), above - (0.0, above[:, 1].min())
    if draw(st.booleans()):  # a lowest corner above a highest one
        below, above = below - below[below[:, 1].argmax()], above - above[above[:, 1].argmin()]
    elif draw(st.booleans()):  # along a common line of several pieces
        rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
        x = np.sort(rng.uniform(0.0, 9.0, draw(st.integers(2, 6))))
        line = np.column_stack([x, rng.uniform(-1.0, 1.0, len(x))])
        above = np.vstack([line, [[x[-1], 9.0], [x[0], 9.0]]])
        below = np.vstack([line[::-1], [[x[0], -9.0], [x[-1], -9.0]]])
    angle_deg, x = draw(st.floats(-180, 180)), draw(st.floats(-1, 1))
    away = np.array([x, 1.0 - x]) * draw(st.sampled_from([0.0, 1.0, 1e3, 1e8])) * size

    def pushed(by):
        lowered = above * size - np.array([0.0, by * size])
        return turn(below * size, angle_deg) + away, turn(lowered, angle_deg) + away

    return pushed, size


@repeatable(120)
@given(stacked(), st.sampled_from([0.0, 1e-16, 1e-15, 1e-13, 1e-11, 1e-9]), st.floats(-5.5, -1.0))
def test_what_touches_does_not_overlap_and_what_is_pushed_in_does(pair, gap, exponent):
    """Rounding, and up to 1e-9 of the size between both, make no overlap.

    Pushing makes one that is no deeper, and as deep as exact arithmetic finds at some points.
    """
    pushed, size = pair
    for below, above in (map(shape_of, pushed(gap)), map(shape_of, pushed(-gap))):
        for one, other in ((below, above), (above, below)):
            assert overlap_depth(one, other) <= RIGHT * size
            assert sum(part.area for part in common_parts(one, other)) <= RIGHT * size**2
    below, above = pushed(10.0**exponent)
    depth = overlap_depth(shape_of(below), shape_of(above))
    assert depth == overlap_depth(shape_of(above), shape_of(below))
    assert naive.depth(below, above, 4) - RIGHT * size <= depth
    assert depth <= (10.0**exponent + RIGHT) * size


def test_a_spike_without_an_area_is_no_part_of_a_shape():
    spiked = shape_of(np.array([(0, 0), (2, 0), (2, 1), (3, 1), (2, 1), (0, 1)], float))
    assert spiked.area == 2.0
    assert sum(part.area for part in common_parts(spiked, box(1, -1, 9, 9))) == pytest.approx(1.0)
    flat = shape_of(np.array([(0, 0), (1, 1), (2, 2)], float))
    for other in (box(0, 0, 2, 2), flat):
        assert common_parts(flat, other) == common_parts(other, flat) == ()
        assert overlap_depth(flat, other) == 0.0


def test_deepest_overlap_names_the_pair():
    outlines = [(4, box(0, 0, 16, 8)), (2, box(0, 8, 16, 8)), (9, box(14, -2, 16, 8))]
    depth, pair = deepest_overlap(outlines)
    assert (pair, depth) == ((4, 9), pytest.approx(2.0, abs=1e-9))
    assert deepest_overlap(outlines[:2]) == (0.0, None)
    assert deepest_overlap([]) == (0.0, None)
