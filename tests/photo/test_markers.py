"""Markers in photographs, and the sheets on which they are printed."""

import sys

import cv2
import numpy as np
import pytest

from drystone.errors import InputError, UsageError
from drystone.photo import markers
from drystone.photo.layout import (
    margin_mm,
    parse_layout,
    sheet_positions_m,
    single_position_m,
)
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
    assert f"markers 3, 11 of {FAMILIES[dictionary][0]}" in notice.message
    with pytest.raises(InputError) as refused:
        scale_and_view(found, parse_layout("A4:50mm"), SIZE)
    assert refused.value.code == "E170"
    assert FAMILIES[dictionary][0] in refused.value.what


@pytest.mark.parametrize("dictionary", ["aruco", "apriltag"])
@pytest.mark.parametrize("tilt_deg", [0.0, 35.0])
def test_corners_are_found_to_a_tenth_of_a_px(dictionary, tilt_deg):
    shown = photograph(to_photo(tilt_deg), SIZE, PLACED, dictionary=dictionary)
    found = find_markers(shown)
    assert [(one.id, one.dictionary) for one in found] == [(3, dictionary), (11, dictionary)]
    for off in offsets(found, tilt_deg):
        assert np.abs(off).max() < 0.25
        assert np.sqrt((off**2).mean()) < 0.1


def test_neither_blur_nor_shadow_moves_corners_and_without_edges_they_are_taken_alone(monkeypatch):
    """Blur rounds corners off: what looks for them alone reads .4 % too little."""
    for one in find_markers(photograph(to_photo(), SIZE, PLACED, blur_px=1.2)):
        assert one.side_px == pytest.approx(600 * SIDE / 0.4, rel=0.001)
    shown = photograph(to_photo(), SIZE, PLACED)
    half_dark = (shown * np.linspace(1.0, 0.5, SIZE[0])[None, :, None]).astype(np.uint8)
    found = find_markers(half_dark)
    assert [one.id for one in found] == [3, 11]
    assert all(np.abs(off).max() < 0.3 for off in offsets(found))
    monkeypatch.setattr(markers, "corners_by_edges", lambda *_: None)
    found = find_markers(shown)
    assert [one.id for one in found] == [3, 11]
    for off in offsets(found):
        assert np.abs(off).max() < 0.7
        assert off.mean(axis=0) == pytest.approx([0, 0], abs=0.1)


def test_grey_pictures_are_read_too_and_an_id_may_be_found_twice_or_never(monkeypatch):
    shown = photograph(to_photo(), SIZE, [PLACED[0], (3, *PLACED[1][1:])])
    for picture in (shown, shown[..., 0]):
        assert [one.id for one in find_markers(picture)] == [3, 3]
    noise = np.random.default_rng(1).integers(0, 256, (300, 400, 3), dtype=np.uint8)
    for picture in (noise, np.zeros((50, 50), np.uint8), np.ascontiguousarray(shown[:, ::-1])):
        assert find_markers(picture) == ()
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(UsageError, match=r"E305.*drystone\[photo\]"):
        find_markers(shown)


def test_patterns_are_those_of_opencv():
    for name, (family, across) in BITS.items():
        assert modules_across(name) == across
        known = cv2.aruco.getPredefinedDictionary(family)
        picture = cv2.aruco.generateImageMarker(known, 5, across * 10)
        assert np.array_equal(marker_modules(name, 5), picture[5::10, 5::10] < 128)
    for name, marker_id in (("qr", 0), ("aruco", 50), ("aruco", -1)):
        with pytest.raises(UsageError, match="E174"):
            marker_modules(name, marker_id)


def test_a_sheet_has_its_markers_in_the_corners_of_the_page():
    places = sheet_positions_m("A4", 0.05)
    expected = [[0.015, 0.015], [0.145, 0.015], [0.145, 0.232], [0.015, 0.232]]
    assert places == pytest.approx(np.array(expected))
    for size_m, text in ((0.05, "5cm"), (0.0508, "2in"), (0.06096, ".2 ft")):
        assert parse_layout(f"letter:{text}").size_m == pytest.approx(size_m)
    layout = parse_layout("a4:5cm")
    assert (layout.page, layout.ids) == ("A4", (0, 1, 2, 3))
    assert layout.corners_m(2)[2] == pytest.approx([0.195, 0.282])
    assert [layout.group(one) for one in (0, 3, 4)] == [0, 0, 1]
    assert parse_layout("A4:").size_m == 0.05
    small = parse_layout("A4", printed=0.97)
    assert small.corners_m(2) == pytest.approx(0.97 * layout.corners_m(2))
    with pytest.raises(UsageError, match="fit on A4") as caught:
        sheet_positions_m("A4", 0.09)
    largest = int(caught.value.cure.split()[1])
    sheet_positions_m("A4", largest / 1000)
    with pytest.raises(UsageError):
        sheet_positions_m("A4", (largest + 1) / 1000)
    sheet_positions_m("letter", 0.01)
    assert margin_mm(70) == 18.0  # white, of a square and a half or more: 17.5 mm


def test_single_markers_have_a_size_and_no_place_and_fit_on_a_page():
    layout = parse_layout("0.12 m", printed=0.9)
    assert (layout.page, layout.group(7), layout.side_m) == (None, 7, pytest.approx(0.108))
    assert layout.corners_m(7)[2] == pytest.approx([0.108, 0.108])
    assert single_position_m("A4", 0.12) == pytest.approx([0.045, 0.03])
    with pytest.raises(UsageError, match="does not fit"):
        single_position_m("A4", 0.2)
    with pytest.raises(UsageError, match="not plausible"):
        parse_layout("A4", printed=97.0)
    for text in ("", "50", "0mm", "50 inches", "A5", "A4:5mm", "A4:90mm", "A4:50", "-5mm"):
        with pytest.raises(UsageError, match="E174"):
            parse_layout(text)
