"""Where markers are in P, against a sheet that was laid where it is known to be."""

import numpy as np
import pytest

from drystone.photo.layout import parse_layout
from drystone.photo.markers import FoundMarker
from drystone.photo.segment_photo import placed_markers

PX_PER_M, HEIGHT_PX = 800.0, 600
SHEET, SINGLE = parse_layout("A4:50mm"), parse_layout("120mm")


def laid(layout, one, angle_deg, at_m):
    """Corners of a marker in P whose paper is turned counter-clockwise, its upper left at a place.

    Written out: paper has x to the right and y down, P has y up.
    """
    a = np.radians(angle_deg)
    x, y = layout.corners_m(one).T
    return np.column_stack([x * np.cos(a) + y * np.sin(a), x * np.sin(a) - y * np.cos(a)]) + at_m


def photographed(corners_m, from_photo, noise_px=0.0):
    """Find corners in a photograph that is seen as the picture from above is not."""
    picture = np.column_stack([corners_m[:, 0], HEIGHT_PX / PX_PER_M - corners_m[:, 1]]) * PX_PER_M
    moved = np.column_stack([picture, np.ones(4)]) @ np.linalg.inv(from_photo).T
    seen = moved[:, :2] / moved[:, 2:]
    return seen + np.random.default_rng(3).normal(0.0, noise_px, (4, 2)) * bool(noise_px)


TILTED = np.array([[0.4, 0.03, -20.0], [-0.02, 0.5, 10.0], [1e-5, 4e-5, 1.0]])


@pytest.mark.parametrize("from_photo", [np.eye(3), TILTED])
@pytest.mark.parametrize("angle_deg", [0.0, 33.0, -140.0])
def test_the_frame_of_a_marker_is_in_the_middle_of_its_print(angle_deg, from_photo) -> None:
    true = {one: laid(SHEET, one, angle_deg, (0.3, 0.4)) for one in (3, 0, 1)}
    true[9] = laid(SINGLE, 9, angle_deg + 90.0, (0.1, 0.2))
    for layout, ids in ((SHEET, (3, 0, 1)), (SINGLE, (9,))):
        seen = [FoundMarker(one, photographed(true[one], from_photo), "aruco") for one in ids]
        placed = placed_markers(seen, layout, from_photo, PX_PER_M, HEIGHT_PX)
        assert [marker.id for marker in placed] == sorted(ids)
        for marker in placed:
            corners = true[marker.id]
            assert marker.corners_m == pytest.approx(corners, abs=1e-9)
            matrix = marker.pose.matrix
            assert matrix[:3, 3] == pytest.approx([*corners.mean(axis=0), 0.0], abs=1e-9)
            # X from the left side of the print to its right one, Y up in it, Z out of it.
            x, y = corners[1] - corners[0], corners[0] - corners[3]
            axes = np.column_stack([[*x, 0.0], [*y, 0.0], [0.0, 0.0, layout.side_m]])
            assert matrix[:3, :3] == pytest.approx(axes / layout.side_m, abs=1e-9)


def test_all_markers_of_a_sheet_say_how_it_lies() -> None:
    """One marker that was found a little turned does not turn the frame as much."""
    true = {one: laid(SHEET, one, 20.0, (0.3, 0.4)) for one in range(4)}
    seen = [
        FoundMarker(one, photographed(true[one], np.eye(3), 1.0 if one == 0 else 0.0), "aruco")
        for one in range(4)
    ]

    def off_deg(markers):
        (first, *_) = placed_markers(markers, SHEET, np.eye(3), PX_PER_M, HEIGHT_PX)
        x, y, _ = first.pose.xaxis
        return abs(np.degrees(np.arctan2(y, x)) - 20.0)

    assert off_deg(seen) < 0.25 * off_deg(seen[:1])
