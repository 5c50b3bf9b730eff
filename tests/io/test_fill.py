"""Pixels belong to an area when their centres do, by angles and by matplotlib."""

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.path import Path as Outline

from drystone.io.outlines_in.model import Area, PlacedMask, filled_area, united

NUMBERS = st.integers(-24, 72).map(lambda n: n / 3 + 0.1)
RINGS = st.lists(st.tuples(NUMBERS, NUMBERS), min_size=3, max_size=9, unique=True)
LOW, SIZE = -10, 40


def whole(placed):
    image = np.zeros((SIZE, SIZE), bool)
    if placed is not None:
        rows, cols = placed.mask.shape
        row, col = placed.row - LOW, placed.col - LOW
        image[row : row + rows, col : col + cols] = placed.mask
    return image


CENTRES = np.stack(np.meshgrid(*2 * [np.arange(LOW, LOW + SIZE) + 0.5]), axis=-1)


def off_edges(*rings):
    """Where a rule for points on edges does not matter: centres farther than 1e-6 from them."""
    lines = shapely.MultiLineString([[*ring, ring[0]] for ring in rings])
    return shapely.distance(shapely.points(CENTRES), lines) > 1e-6


@given(RINGS)
def test_by_the_sum_of_turns_which_are_angles(points):
    """The winding number as the sum of the angles at which a centre sees the edges."""
    found = whole(filled_area(Area((np.array(points),), "nonzero")))
    to_corners = np.array(points) - CENTRES[:, :, None]
    angles = np.arctan2(to_corners[..., 1], to_corners[..., 0])
    turns = np.roll(angles, -1, axis=-1) - angles
    winding = ((turns + np.pi) % (2 * np.pi) - np.pi).sum(axis=-1) / (2 * np.pi)
    where = off_edges(points)
    np.testing.assert_array_equal(found[where], (np.abs(winding) > 0.5)[where])


@given(RINGS, RINGS)
def test_by_the_number_of_rings_as_matplotlib_counts(one, other):
    found = whole(filled_area(Area((np.array(one), np.array(other)))))
    want = np.zeros(found.size, bool)
    for points in (one, other):
        outline = Outline([*points, points[0]], closed=True)
        want ^= outline.contains_points(CENTRES.reshape(-1, 2))
    where = off_edges(one, other)
    np.testing.assert_array_equal(found[where], want.reshape(found.shape)[where])


@given(st.lists(st.integers(0, 35), min_size=4, max_size=9, unique=True), st.data())
def test_halves_of_a_polygon_share_no_pixel_and_leave_none(tens, data):
    """Corners of an ellipse through centres of pixels, split along any of its diagonals."""
    angles = np.radians(sorted(tens)) * 10
    ring = np.column_stack([5.5 + 9 * np.cos(angles), 4.5 + 7 * np.sin(angles)])
    first = data.draw(st.integers(0, len(ring) - 3))
    last = data.draw(st.integers(first + 2, len(ring) - 1))
    one, other = (
        ring[first : last + 1],
        np.roll(ring, -last, axis=0)[: len(ring) - last + first + 1],
    )
    both = [whole(filled_area(Area((part,)))) for part in (one, other) if len(part) > 2]
    assert sum(mask.astype(int) for mask in both).max() <= 1
    np.testing.assert_array_equal(np.any(both, axis=0), whole(filled_area(Area((ring,)))))


def test_what_holds_no_centre_is_nothing():
    assert filled_area(Area((np.array([[0.6, 0.6], [0.9, 0.6], [0.9, 0.9]]),))) is None
    assert filled_area(Area((np.array([[0.0, 0.0], [9.0, 0.0], [4.0, 0.0]]),))) is None
    assert united([]) is None


def test_union_of_masks():
    one, other = (PlacedMask(np.ones((2, 3), bool), row, col) for row, col in ((5, 5), (6, 7)))
    union = united([one, other])
    assert (union.row, union.col, union.mask.shape) == (5, 5, (3, 5))
    assert union.mask.sum() == 6 + 6 - 1
