"""Outlines of pixels: simple, exact in area and centroid, near the contour, with its corners."""

from hashlib import sha256

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from drystone.kernels.outline import pixel_polygon, rasterise_polygon
from drystone.kernels.polygons import turn
from drystone.model.outline import reach_px, second_moments, solid, stone_outline
from drystone.model.stone import OUTLINE_TOLERANCE_PX, Stone
from tests.naive import outline as naive
from tests.strategies import JOINED, blobs, holed, largest, masks, repeatable

TOLERANCE = OUTLINE_TOLERANCE_PX
TOLERANCES = [0.0, 0.1, TOLERANCE, 1.0, 4.0]


def check(corners, mask):
    """An outline is simple, counter-clockwise, without straight corners; area and centroid fit."""
    mask = solid(mask)
    shape = shapely.Polygon(corners)
    assert shape.is_valid
    assert shape.exterior.is_ccw
    assert shape.area == pytest.approx(mask.sum(), rel=1e-12)
    assert (shape.centroid.x, shape.centroid.y) == pytest.approx((0.0, 0.0), abs=1e-9)
    ahead = np.roll(corners, -1, axis=0) - corners
    behind = np.roll(ahead, 1, axis=0)
    sine = (behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]) / np.prod(
        [np.hypot(*behind.T), np.hypot(*ahead.T)], axis=0
    )
    assert np.abs(sine).min() > 1e-9


@pytest.mark.parametrize("tolerance", TOLERANCES[:3])
@pytest.mark.parametrize(
    ("width", "height"), [(2, 2), (1, 4), (40, 1), (2, 9), (3, 2), (36, 12), (200, 35)]
)
def test_a_brick_is_its_rectangle(width, height, tolerance):
    corners = stone_outline(np.ones((height, width), bool), tolerance)
    x, y = width / 2, height / 2
    expected = {(-x, -y), (x, -y), (x, y), (-x, y)}
    assert {tuple(corner) for corner in corners.round(12).tolist()} == expected
    assert len(corners) == 4


def test_an_l_keeps_its_inner_corner():
    mask = np.zeros((30, 20), bool)
    mask[:, :6] = True
    mask[-6:, :] = True
    stone = Stone(1, mask)
    found = (stone.outline + stone.local_centroid).round(9)
    expected = {(0, 0), (20, 0), (20, 6), (6, 6), (6, 30), (0, 30)}
    assert {tuple(corner) for corner in found.tolist()} == expected
    assert stone.outline is stone.outline_within(TOLERANCE)
    for tolerance in (0.0, TOLERANCE, 0.5):
        np.testing.assert_array_equal(
            stone.outline_within(tolerance), stone_outline(mask, tolerance)
        )
    with pytest.raises(ValueError, match="read-only"):
        stone.outline[0, 0] = 1.0


@pytest.mark.parametrize("size", [40, 120, 360])
def test_sides_are_straight_at_any_resolution(size):
    """Outlines of triangles to octagons of pixels have their corners, and lie where they lie."""
    rng, corners, away = np.random.default_rng(0), [], []
    for count in range(3, 9):
        angles = (np.arange(count) + rng.uniform(0.0, 0.4, count)) * 2.0 * np.pi / count
        drawn = size * np.column_stack([0.7 * np.cos(angles), 0.5 * np.sin(angles)])
        mask, left, bottom = rasterise_polygon(drawn)
        stone = Stone(1, mask)
        outline = stone.outline + np.array(stone.local_centroid) + (left, bottom)
        truth = shapely.Polygon(drawn)
        corners.append(len(outline) - count)
        apart = shapely.Polygon(outline).symmetric_difference(truth)
        away.append(apart.area / truth.length)
    assert max(corners) <= 3
    assert np.mean(away) < 0.12


@repeatable(150)
@given(mask=holed(), tolerance=st.sampled_from([*TOLERANCES, 0.5]))
def test_outlines_are_simple_weigh_what_the_pixels_do_and_stay_near_their_rim(mask, tolerance):
    """The middle of every pixel edge around a stone is near its outline, holes or not.

    A hole moves the centroid, and nothing else.
    """
    stone, (rows, cols) = Stone(1, mask), np.nonzero(mask)
    middle = cols.mean() + 0.5, len(mask) - rows.mean() - 0.5
    assert (stone.area_px, stone.local_centroid) == (len(rows), pytest.approx(middle))
    check(stone_outline(mask, tolerance), mask)
    outline = shapely.LinearRing(stone.outline_within(tolerance) + np.array(stone.local_centroid))
    assert max(outline.distance(point) for point in naive.rim(mask)) <= reach_px(tolerance)


@repeatable(40)
@given(mask=blobs(min_px=14, max_px=40), tolerance=st.sampled_from([0.1, TOLERANCE, 1.0]))
def test_outlines_go_nowhere_else(mask, tolerance):
    """√2/4 px for a corner that is put back or cut off, beside what the rim shows."""
    stone = Stone(1, mask)
    outline = shapely.LinearRing(stone.outline_within(tolerance) + np.array(stone.local_centroid))
    squares = shapely.LinearRing(pixel_polygon(mask))
    assert outline.hausdorff_distance(squares) <= 2.0**0.5 / 4 + reach_px(tolerance)
    assert squares.hausdorff_distance(outline) <= 2.0**0.5 / 4 + reach_px(tolerance)


@pytest.mark.parametrize("rough", [0.7, 1.5, 4.0])
def test_ragged_stones_have_outlines(rough):
    """Finer lines where they must be, and the contour where none will do."""
    rng = np.random.default_rng(3)
    y, x = np.mgrid[-1:1:120j, -1:1:160j]
    noise = ndimage.gaussian_filter(rng.normal(size=x.shape), rough)
    mask = largest(solid(0.7 - np.hypot(x, y) + 0.2 * noise / noise.std() > 0.0), JOINED)
    outline = stone_outline(mask, TOLERANCE)
    check(outline, mask)
    edges = naive.rim(mask)
    ring = shapely.LinearRing(outline + np.array(Stone(1, mask).local_centroid))
    assert max(ring.distance(edge) for edge in edges) <= reach_px(TOLERANCE)
    assert len(outline) < len(edges) * (0.6 if rough < 1.0 else 0.2)


def test_outlines_are_the_same_bits_on_every_machine():
    """Sines, norms and solvers differ by a bit from one processor to the next: walls would too."""
    y, x = np.mgrid[-40:41, -60:61]
    outline = stone_outline(4 * x * x + x * y + 9 * y * y < 9000, TOLERANCE)
    assert sha256(outline.tobytes()).hexdigest()[:16] == "05934e8517909090"


@pytest.mark.parametrize("flip", [(1, 1), (-1, 1), (1, -1), (-1, -1)])
def test_of_several_pieces_the_largest_counts(flip):
    mask = np.zeros((4, 9), bool)
    mask[:2, :2] = mask[1:, 3:] = True
    corners = stone_outline(mask[:: flip[0], :: flip[1]], TOLERANCE)
    width, height = np.ptp(corners, axis=0).tolist()
    assert (len(corners), width / height) == (4, pytest.approx(2.0))
    assert width * height == pytest.approx(18.0)


@repeatable(80)
@given(mask=masks(max_px=9), angle=st.floats(-180, 180), far=st.floats(-1e3, 1e3))
def test_second_moments_are_those_of_the_pixels_and_turn_and_move_as_tensors_do(mask, angle, far):
    rows, cols = np.nonzero(mask)
    x, y = cols - cols.mean(), rows.mean() - rows
    # Beside those of unit squares about their own centres.
    axes = turn(np.eye(2), angle).T
    tensor = axes @ (np.inner([x, y], [x, y]) + len(rows) / 12.0 * np.eye(2)) @ axes.T
    found = second_moments(turn(pixel_polygon(mask), angle) + far)
    assert found == pytest.approx((tensor[0, 0], tensor[1, 1], tensor[0, 1]), rel=1e-6, abs=1e-6)
