"""Overlap of outlines: none where they touch, whatever rounding does, and all of it elsewhere."""

from typing import NamedTuple

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import Points
from drystone.kernels.raster import turn
from drystone.model.overlap import CIRCLE, common_parts, deepest_overlap, overlap_depth, shape_of
from tests.naive import overlap as naive
from tests.polygons import box_of, simple_polygons
from tests.strategies import repeatable

RIGHT = 1e-6
"""Of the size: no overlap is seen or missed above it."""


def box(*sides):
    return shapely.Polygon(box_of(*sides))


@pytest.mark.parametrize(
    ("first", "second", "depth"),
    [
        (box(0, 0, 4, 2), box(0, 2, 4, 2), 0.0),
        (box(0, 0, 4, 2), box(9, 2, 4, 2), 0.0),
        (box(0, 0, 4, 2), box(4, 2, 1, 1), 0.0),
        (box(0, 0, 4, 2), box(0, 1.75, 4, 2), 0.25),
        # A tip of 1 px in a large stone.
        (shapely.Polygon([(5, 4), (3, 9), (7, 9)]), box(0, 0, 10, 5), 1.0),
        # A stone wholly in another, and one on top of its like.
        (box(0, 0, 10, 10), box(4, 4, 2, 2), 4.0),
        (box(0, 0, 10, 10), box(0, 0, 10, 10), 5.0),
        # The deepest point is none of the corners, but the middle of an edge.
        (box(0, 0, 20, 20), box(-1, 9, 22, 2), 9.0),
    ],
)
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


class Stacked(NamedTuple):
    """Two polygons that a line parts, one on either side, and their size."""

    below: Points
    above: Points
    size: float

    def pushed(self, by, angle_deg, away):
        """The upper one pushed into the other by a share of the size, seen from anywhere."""
        lowered = self.above - np.array([0.0, by * self.size])
        return turn(self.below, angle_deg) + away, turn(lowered, angle_deg) + away


@st.composite
def stacked(draw):
    """Polygons that touch: corners on corners or edges, edges on parts of edges, common lines."""
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
    return Stacked(below * size, above * size, size)


ANYWHERE = st.tuples(st.floats(-180, 180), st.floats(-1, 1), st.sampled_from([0.0, 1.0, 1e3, 1e8]))


@repeatable(120)
@given(stacked(), ANYWHERE, st.sampled_from([0.0, 1e-16, 1e-15, 1e-13, 1e-11, 1e-9]), st.booleans())
def test_what_touches_does_not_overlap(pair, seen, gap, into):
    """Rounding, and up to 1e-9 of the size between both, make no overlap."""
    away = np.array([seen[1], 1.0 - seen[1]]) * seen[2] * pair.size
    below, above = map(shape_of, pair.pushed(gap if into else -gap, seen[0], away))
    for one, other in ((below, above), (above, below)):
        assert overlap_depth(one, other) <= RIGHT * pair.size
        assert sum(part.area for part in common_parts(one, other)) <= RIGHT * pair.size**2


@repeatable(100)
@given(stacked(), ANYWHERE, st.floats(-5.5, -1.0))
def test_what_is_pushed_in_overlaps(pair, seen, exponent):
    """By no more than it was pushed, and no less than exact arithmetic finds at some points."""
    away = np.array([seen[1], 1.0 - seen[1]]) * seen[2] * pair.size
    below, above = pair.pushed(10.0**exponent, seen[0], away)
    depth = overlap_depth(shape_of(below), shape_of(above))
    assert depth == overlap_depth(shape_of(above), shape_of(below))
    assert depth <= (10.0**exponent + RIGHT) * pair.size
    assert depth >= naive.depth(below, above, 4) - RIGHT * pair.size


def test_deepest_overlap_names_the_pair():
    outlines = [(4, box(0, 0, 16, 8)), (2, box(0, 8, 16, 8)), (9, box(14, -2, 16, 8))]
    depth, pair = deepest_overlap(outlines)
    assert (pair, depth) == ((4, 9), pytest.approx(2.0, abs=1e-9))
    assert deepest_overlap(outlines[:2]) == (0.0, None)
    assert deepest_overlap([]) == (0.0, None)
