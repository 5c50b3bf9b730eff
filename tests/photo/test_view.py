from dataclasses import replace

import cv2
import numpy as np
import pytest

from drystone.errors import InputError
from drystone.photo.layout import MarkerLayout
from drystone.photo.markers import FoundMarker, find_markers
from drystone.photo.scale import scale_and_view
from drystone.photo.view import View, apply, rectify, refuse_horizon
from tests.photo.scenes import camera, outline, photograph

SIDE = 0.05
SIZE, MOST_PX = (640, 480), 10**7
PLACED = ((3, 15.0, -0.12, -0.08, SIDE), (11, 80.0, 0.12, 0.05, SIDE))
TO_PHOTO = camera(800, SIZE, tilt_deg=30.0, distance_m=0.5)

SHOWN = photograph(TO_PHOTO, SIZE, PLACED)
CORNERS = [FoundMarker(one, apply(TO_PHOTO, outline(*lies)), "aruco") for one, *lies in PLACED]
VIEW = scale_and_view(tuple(CORNERS), MarkerLayout(SIDE), SIZE)


def test_points_go_where_they_are_said_to_go():
    values, px_per_m, _, from_photo = rectify(SHOWN, replace(VIEW, px_per_m=1500.0), MOST_PX)
    assert px_per_m == 1500.0
    found = find_markers(values)
    apart = outline(*PLACED[0][1:]).mean(axis=0) - outline(*PLACED[1][1:]).mean(axis=0)
    seen = found[0].corners_px.mean(axis=0) - found[1].corners_px.mean(axis=0)
    assert np.hypot(*seen) == pytest.approx(1500.0 * np.hypot(*apart), abs=0.5)
    for one, of_photo in zip(found, find_markers(SHOWN), strict=True):
        sides = one.corners_px - np.roll(one.corners_px, 1, axis=0)
        assert np.hypot(*sides.T) == pytest.approx(np.full(4, 75.0), abs=0.4)
        moved = apply(from_photo, of_photo.corners_px)
        assert np.abs(moved - one.corners_px).max() < 0.5
        on_ground = apply(VIEW.photo_to_ground, of_photo.corners_px)
        assert moved == pytest.approx(on_ground * 1500.0, abs=1e-6)


def test_all_of_the_photo_is_shown_and_nothing_else_in_a_size_that_is_bounded():
    values, _, inside, from_photo = rectify(np.full_like(SHOWN, 200), VIEW, MOST_PX)
    corners = apply(from_photo, np.array([[0.0, 0.0], [640, 0], [640, 480], [0, 480]]))
    height, width = inside.shape
    assert values.shape == (height, width, 3)
    assert corners.min() >= -1e-6
    assert corners.max(axis=0) == pytest.approx([width, height], abs=1.0)
    drawn = cv2.contourArea(corners.astype(np.float32))
    assert inside.sum() == pytest.approx(drawn, rel=0.005)
    assert (values[~inside] == 0).mean() > 0.98
    _, px_per_m, inside, _ = rectify(SHOWN, VIEW, max_px=50_000)
    assert inside.size <= 50_000 * 1.02
    assert px_per_m < VIEW.px_per_m


def from_above(picture, px_per_m):
    """The picture of a view from straight above at 400 px/m, in another scale."""
    straight = View(np.diag([1 / 400, 1 / 400, 1.0]), px_per_m, (), 0.0, 0.0, ())
    return rectify(np.ascontiguousarray(picture), straight, MOST_PX)[0]


def test_no_half_px_is_lost_and_fine_texture_is_averaged():
    ramp = np.broadcast_to(np.arange(256, dtype=np.uint8)[None, :, None], (64, 256, 3))
    # The centre of px j of four px each lies between px 4 j + 1 and 4 j + 2.
    expected = 4.0 * np.arange(1, 63) + 1.5
    across = from_above(ramp.swapaxes(0, 1), 100.0)
    for small in (from_above(ramp, 100.0), across.swapaxes(0, 1)):
        assert np.abs(small[8, 1:-1, 0] - expected).max() <= 0.5
    stripes = np.zeros((240, 240, 3), dtype=np.uint8)
    stripes[:, ::4] = 240
    small = from_above(stripes, 50.0)
    assert small.shape == (30, 30, 3)
    assert np.abs(small[:, 1:-1].astype(float) - 60.0).max() < 6.0


def test_the_horizon_is_refused():
    for row in ([0.0, -0.003, 1.0], [0.0, -0.00195, 1.0], [0.0028, 0.0, -0.9]):
        with pytest.raises(InputError, match="E173"):
            refuse_horizon(np.array([[0.001, 0.0, 0.0], [0.0, 0.001, 0.0], row]), SIZE)
