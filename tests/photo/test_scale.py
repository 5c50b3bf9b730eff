import cv2
import numpy as np
import pytest
from scipy.spatial.distance import pdist

from drystone.errors import InputError
from drystone.photo.layout import MarkerLayout, parse_layout
from drystone.photo.markers import FoundMarker, find_markers
from drystone.photo.scale import scale_and_view
from drystone.photo.view import apply, jacobian
from tests.photo.scenes import camera, distance_error_percent, outline, photograph

SIDE = 0.05
SIZE = (1000, 750)
APART = ((0, 10.0, -0.14, -0.10, SIDE), (2, 95.0, 0.14, 0.05, SIDE))
SHEET = parse_layout("A4:50mm")


def sheet_on_ground(ids=(0, 1, 2, 3)):
    """The sheet with its middle at 0, 0."""
    return [(one, 0.0, *(SHEET.corners_m(one)[0] - (0.105, 0.1485)), SIDE) for one in ids]


def seen(to_photo, placed, noise_px=0.05):
    """Corners as they would be found, without a picture."""
    rng = np.random.default_rng(2)
    return tuple(
        FoundMarker(one, apply(to_photo, outline(*lies)) + rng.normal(0, noise_px, (4, 2)), "aruco")
        for one, *lies in placed
    )


@pytest.mark.parametrize(
    ("side_px", "tilt_deg", "most_percent"), [(60, 30.0, 0.5), (150, 0.0, 0.25)]
)
def test_photographed_markers_measure_the_ground(side_px, tilt_deg, most_percent):
    size = round(0.26 / SIDE * side_px), round(0.2 / SIDE * side_px)
    focal, away = 1.2 * size[0], {"tilt_deg": tilt_deg, "turn_deg": 7.0}
    to_photo = camera(focal, size, distance_m=focal * SIDE / side_px, **away)
    two = [(0, 10.0, -0.09, -0.06, SIDE), (7, 100.0, 0.09, 0.02, SIDE)]
    found = find_markers(photograph(to_photo, size, two))
    view = scale_and_view(found, MarkerLayout(SIDE), size)
    assert distance_error_percent(view, to_photo, 0.2, 0.15) < most_percent
    assert view.ids == (0, 7)
    assert view.residual_percent < 0.15
    assert tilt_deg or view.px_per_m == pytest.approx(side_px / SIDE, rel=0.002)


def test_a_sheet_agrees_with_opencv():
    """The same ground from cv2.findHomography, which makes the same squares least."""
    to_photo = camera(1200, SIZE, tilt_deg=25.0, turn_deg=-12.0, distance_m=0.7)
    found = seen(to_photo, sheet_on_ground(), 0.2)
    view = scale_and_view(found, SHEET, SIZE)
    flat = np.concatenate([SHEET.corners_m(one.id) for one in found])
    theirs, _ = cv2.findHomography(flat, np.concatenate([one.corners_px for one in found]))
    corners = np.array([[100.0, 100.0], [900.0, 100.0], [900.0, 650.0], [100.0, 650.0]])
    maps = (view.photo_to_ground, np.linalg.inv(theirs))
    ours, other = (pdist(apply(one, corners)) for one in maps)
    assert ours == pytest.approx(other, rel=2e-5)
    # Noise of .2 px along each axis, at about 1700 px a metre.
    assert 0.05 < view.residual_mm < 0.2


@pytest.mark.parametrize("angle", [80.0, 180.0, 275.0])
def test_the_picture_stays_upright_and_is_never_mirrored(angle):
    to_photo = camera(1000, SIZE, tilt_deg=20.0, turn_deg=angle, distance_m=0.7)
    for found, layout in (
        (seen(to_photo, sheet_on_ground()), SHEET),
        (seen(to_photo, APART), MarkerLayout(SIDE)),
    ):
        view = scale_and_view(found, layout, SIZE)
        local = jacobian(view.photo_to_ground, np.array(SIZE) / 2.0)
        assert min(np.linalg.det(local), local[0, 0], local[1, 1]) > 0
        assert local[1, 0] == pytest.approx(local[0, 1], abs=1e-9)
        corners = apply(view.photo_to_ground, np.array([[0, 0], [SIZE[0], 0], SIZE, [0, SIZE[1]]]))
        assert corners.min(axis=0) == pytest.approx([0, 0], abs=1e-12)


def test_two_markers_of_a_sheet_are_enough_and_two_sheets_lie_anywhere():
    to_photo = camera(1200, SIZE, tilt_deg=15.0, distance_m=0.7)
    for ids in ((0, 2), (1, 2), (0, 1, 3)):
        view = scale_and_view(seen(to_photo, sheet_on_ground(ids), 0.02), SHEET, SIZE)
        assert view.ids == ids
        assert distance_error_percent(view, to_photo, 0.2, 0.25) < 0.3
    to_photo = camera(1200, SIZE, distance_m=0.9)
    across = SHEET.corners_m(1)[0, 0] - SHEET.corners_m(0)[0, 0]
    x, y = across * np.cos(np.deg2rad(33.0)), across * np.sin(np.deg2rad(33.0))
    other = [(4, 33.0, 0.2, -0.1, SIDE), (5, 33.0, 0.2 + x, -0.1 + y, SIDE)]
    layout = parse_layout("A4:50mm", tuple(range(8)))
    view = scale_and_view(seen(to_photo, [*sheet_on_ground(), *other]), layout, SIZE)
    assert view.ids == (0, 1, 2, 3, 4, 5)
    assert distance_error_percent(view, to_photo, 0.3, 0.3) < 0.1


def code_of(found, layout=None, size=SIZE):
    with pytest.raises(InputError) as caught:
        scale_and_view(found, layout or MarkerLayout(SIDE), size)
    return caught.value.code, str(caught.value)


STRAIGHT = camera(1200, SIZE, distance_m=0.6)
STONE_6_CM_HIGH = camera(1200, SIZE, distance_m=0.54)
FAR, FLAT = camera(400, SIZE, distance_m=0.6), camera(2400, SIZE, tilt_deg=75.0, distance_m=1.2)
TALL = (1000, 2600)
HORIZON = camera(900, TALL, tilt_deg=55.0, distance_m=0.5)


def test_markers_of_another_sheet_are_left_out():
    stray = (17, 0.0, 0.0, 0.0, 0.3)
    view = scale_and_view(seen(STRAIGHT, [*sheet_on_ground((0, 1)), stray]), SHEET, SIZE)
    assert view.ids == (0, 1)
    (notice,) = view.notices
    assert (notice.code, "17" in notice.message) == ("W170", True)
    code, text = code_of(seen(STRAIGHT, [stray, (18, 0.0, 0.2, 0.0, SIDE)]), SHEET)
    assert (code, "17, 18" in text) == ("E170", True)
    assert "add --marker-ids 17 18. Else: Print markers" in text
    assert "--marker-ids" not in code_of(seen(STRAIGHT, [stray]), SHEET)[1]


def mixed(ratio, tilt_deg):
    """Two markers as found, the second of another size."""
    to_photo = camera(1200, SIZE, tilt_deg=tilt_deg, distance_m=0.6)
    return seen(to_photo, [APART[0], (*APART[1][:4], SIDE * ratio)])


def pair(y=0.0, angle=0.0):
    """Two markers side by side."""
    return [(0, 0.0, -0.1, 0.0, SIDE), (1, angle, 0.1, y, SIDE)]


def test_markers_that_give_no_scale_are_refused():
    for found, layout, code, said in (
        ((), None, "E170", ""),
        (seen(STRAIGHT, APART[:1]), None, "E170", "only marker 0"),
        (seen(FAR, APART), None, "E170", "smaller than 40 px: 0 (33 px), 2 (33 px)"),
        (seen(FLAT, pair()), None, "E170", "too flat an angle"),
        (seen(STRAIGHT, [APART[0], (0, 20.0, 0.1, 0.1, SIDE), APART[1]]), None, "E171", "arker 0"),
        (mixed(0.96, 0.0), None, "E172", "arker 0"),
        (mixed(0.96, 30.0), None, "E172", "arker 0"),
        (mixed(0.5, 15.0), None, "E172", "arker 0"),
        (seen(STRAIGHT, APART), SHEET, "E172", ""),  # a sheet cut up
        # One marker lies on a stone.
        ((*seen(STRAIGHT, APART[:1]), *seen(STONE_6_CM_HIGH, APART[1:])), None, "E172", ""),
        (seen(HORIZON, pair(0.03, 20.0)), None, "E173", ""),
    ):
        refused, text = code_of(found, layout, TALL if code == "E173" else SIZE)
        assert refused == code
        assert said in text


def test_small_markers_and_a_bent_sheet_are_used_and_doubted():
    small = seen(camera(800, SIZE, distance_m=0.6), APART)
    found = list(seen(STRAIGHT, sheet_on_ground(), 0.0))
    found[3] = FoundMarker(3, found[3].corners_px + np.array([2.8, -1.7]), "aruco")
    for corners, layout, said in (
        (small, MarkerLayout(SIDE), "67 px"),
        (tuple(found), SHEET, "off on average"),
    ):
        (notice,) = scale_and_view(corners, layout, SIZE).notices
        assert (notice.code, said in notice.message) == ("W172", True)
