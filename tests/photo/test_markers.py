import sys

import cv2
import numpy as np
import pytest

from drystone.errors import InputError, UsageError
from drystone.photo import markers
from drystone.photo.layout import parse_layout
from drystone.photo.markers import (
    DICTIONARIES,
    FAMILIES,
    find_markers,
    marker_modules,
    modules_across,
)
from drystone.photo.scale import scale_and_view
from drystone.photo.view import apply
from tests.photo.scenes import BITS, camera, outline, photograph

SIDE = 0.05
SIZE = (420, 320)
PLACED = ((3, 15.0, -0.08, -0.06, SIDE), (11, 200.0, 0.07, 0.06, SIDE))


def to_photo(tilt_deg=0.0):
    return camera(600, SIZE, tilt_deg=tilt_deg, distance_m=0.4)


def offsets(found, tilt_deg=0.0):
    """How far the corners of each marker are from where they are seen."""
    for one, (_, *lies) in zip(found, PLACED, strict=True):
        yield one.corners_px - apply(to_photo(tilt_deg), outline(*lies))


@pytest.mark.parametrize("dictionary", sorted(set(BITS) - set(DICTIONARIES)))
def test_markers_of_other_dictionaries_are_read_and_named(dictionary):
    shown = photograph(to_photo(), SIZE, PLACED, dictionary=dictionary)
    found = find_markers(shown)
    assert [(one.id, one.dictionary) for one in found] == [(3, dictionary), (11, dictionary)]
    view = scale_and_view(found, parse_layout("50mm"), SIZE)
    assert view.px_per_m == pytest.approx(1500.0, rel=0.01)
    (notice,) = [one for one in view.notices if one.code == "W184"]
    assert f"markers 3, 11 of {FAMILIES[dictionary]}" in notice.message
    with pytest.raises(InputError) as refused:
        scale_and_view(found, parse_layout("A4:50mm"), SIZE)
    assert refused.value.code == "E170"
    assert FAMILIES[dictionary] in refused.value.what


@pytest.mark.parametrize("dictionary", ["aruco", "apriltag"])
@pytest.mark.parametrize("tilt_deg", [0.0, 35.0])
def test_corners_are_found_to_a_tenth_of_a_px(dictionary, tilt_deg):
    shown = photograph(to_photo(tilt_deg), SIZE, PLACED, dictionary=dictionary)
    found = find_markers(shown)
    assert [(one.id, one.dictionary) for one in found] == [(3, dictionary), (11, dictionary)]
    for off in offsets(found, tilt_deg):
        assert np.abs(off).max() < 0.25
        assert np.sqrt((off**2).mean()) < 0.1


def test_blur_makes_no_marker_smaller():
    """It rounds corners off: what looks for them alone reads .4 % too little."""
    shown = photograph(to_photo(), SIZE, PLACED, blur_px=1.2)
    for one in find_markers(shown):
        assert one.side_px == pytest.approx(600 * SIDE / 0.4, rel=0.001)


def test_a_shadow_over_one_half_moves_nothing():
    shown = photograph(to_photo(), SIZE, PLACED).astype(float)
    shown *= np.linspace(1.0, 0.5, SIZE[0])[None, :, None]
    found = find_markers(shown.astype(np.uint8))
    assert [one.id for one in found] == [3, 11]
    assert all(np.abs(off).max() < 0.3 for off in offsets(found))


def test_where_edges_cannot_be_measured_the_corners_are_taken(monkeypatch):
    monkeypatch.setattr(markers, "corners_by_edges", lambda *_: None)
    found = find_markers(photograph(to_photo(), SIZE, PLACED))
    assert [one.id for one in found] == [3, 11]
    for off in offsets(found):
        assert np.abs(off).max() < 0.7
        assert off.mean(axis=0) == pytest.approx([0, 0], abs=0.1)


def test_grey_pictures_are_read_too_and_an_id_may_be_found_twice():
    shown = photograph(to_photo(), SIZE, [PLACED[0], (3, *PLACED[1][1:])])
    for picture in (shown, shown[..., 0]):
        assert [one.id for one in find_markers(picture)] == [3, 3]


def test_nothing_is_found_where_there_is_nothing_or_a_mirrored_marker():
    noise = np.random.default_rng(1).integers(0, 256, (300, 400, 3), dtype=np.uint8)
    mirrored = np.ascontiguousarray(photograph(to_photo(), SIZE, PLACED)[:, ::-1])
    for picture in (noise, np.zeros((50, 50), np.uint8), mirrored):
        assert find_markers(picture) == ()


def test_patterns_are_those_of_opencv():
    for name, (family, across) in BITS.items():
        assert modules_across(name) == across
        known = cv2.aruco.getPredefinedDictionary(family)
        picture = cv2.aruco.generateImageMarker(known, 5, across * 10)
        assert np.array_equal(marker_modules(name, 5), picture[5::10, 5::10] < 128)


@pytest.mark.parametrize(("name", "marker_id"), [("qr", 0), ("aruco", 50), ("aruco", -1)])
def test_markers_that_do_not_exist(name, marker_id):
    with pytest.raises(UsageError, match="E174"):
        marker_modules(name, marker_id)


def test_without_opencv_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(UsageError, match=r"E305.*drystone\[photo\]"):
        find_markers(np.zeros((50, 50), dtype=np.uint8))
