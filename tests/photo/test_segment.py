"""Stones in photographs: found, or in doubt with a reason, never stones that are none."""

import sys
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import skimage
from PIL import Image
from scipy import ndimage
from scipy.spatial import cKDTree

from drystone.errors import InputError
from drystone.kernels.polygons import turn
from drystone.model.stone_size import sizes_of
from drystone.photo.layout import parse_layout
from drystone.photo.markers import FoundMarker
from drystone.photo.segment import EDGE, FAINT, refine_outlines, segment
from drystone.photo.segment import SMALL as TOO_SMALL
from drystone.photo.segment_doubts import (
    LISTED,
    doubts_of,
    notices_of,
    ruler_doubts,
    verdict_notices,
    verdict_of,
)
from drystone.photo.segment_photo import placed_markers, segment_photo
from drystone.photo.view import apply
from drystone_lab.photographs.rendered import photograph
from drystone_lab.photos import overlaps, pixels, score
from tests.photo.scenes import SMALL

ROWS, COLS = np.indices((300, 400))


def disc(row, col, radius):
    return (ROWS - row) ** 2 + (COLS - col) ** 2 <= radius**2


def drawn(*stones, ground=(60, 110, 180), noise=2.0):
    """A picture of masks, in colours of their own or not, with noise."""
    picture = np.empty((*ROWS.shape, 3))
    picture[:] = ground
    for stone in stones:
        mask, colour = stone if isinstance(stone, tuple) else (stone, (170, 160, 150))
        picture[mask] = colour
    picture += np.random.default_rng(0).normal(0, noise, picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def codes(found):
    return [notice.code for notice in notices_of(doubts_of(found))]


MORE = replace(SMALL, count=8, width_px=600, height_px=450)  # of so much light is not even
EASY = {
    "tarpaulin": {"count": MORE.count, "width_px": MORE.width_px, "height_px": MORE.height_px},
    "rubber": {"rocks": ("granite", "limestone"), "seed": 2},
    "plywood": {"rocks": ("granite", "basalt"), "uneven": 0.35, "seed": 3},
    "gravel": {"rocks": ("sandstone",)},
    "grass": {"seed": 4},
}


@pytest.mark.parametrize("ground", EASY)
def test_easy_photographs_are_found_with_tight_outlines_also_on_ground_that_varies(ground):
    made = photograph(replace(SMALL, ground=ground, **EASY[ground]))
    result = segment_photo(pixels(made))
    got = score(made, result)
    assert (got.recall, got.precision) == (1.0, 1.0)
    assert np.median(got.ious) > 0.95
    assert min(got.ious) > 0.9
    assert verdict_of(result.found, doubts_of(result.found)) == ()
    assert (result.found.ground.spread.max() > 4.0) == (ground in ("gravel", "grass"))


def test_stones_of_nearly_the_colour_of_a_ground_that_varies_are_named_and_make_it_doubtful():
    """One by one their px are no further from it than the grain of the gravel."""
    made = photograph(replace(MORE, ground="gravel", rocks=("granite", "schist")))
    found = segment(pixels(made))
    truth = made.truth_in(np.eye(3), found.labels.shape)
    named = {truth[round(one.at_px[1]), round(one.at_px[0])] for one in found.left_out}
    assert len(named) == len(found.left_out) > 2
    assert 0 not in named
    assert named.isdisjoint(np.unique(truth[found.labels > 0]))
    assert {one.why for one in found.left_out} == {FAINT}
    assert "hardly differ from the ground" in " ".join(verdict_of(found, doubts_of(found)))


def test_shadows_on_a_ground_that_varies_are_not_named_as_stones():
    made = photograph(replace(MORE, ground="gravel", rocks=("basalt",), count=4, shadow=0.5))
    found = segment(pixels(made))
    assert found.count == 4
    assert not [one for one in found.left_out if one.why == FAINT]


def test_photographs_repeat_and_others_differ():
    made = photograph(SMALL).jpeg
    assert photograph(SMALL).jpeg == made != photograph(replace(SMALL, seed=9)).jpeg


def test_a_disc_has_its_size_to_a_px():
    mask = disc(150.3, 200.6, 60)
    found = segment(drawn(mask))
    wrong = np.count_nonzero((found.labels > 0) ^ mask)
    # A px all round would be 377.
    assert wrong < 120
    (size,) = sizes_of(found.labels)
    assert size.length_px == pytest.approx(120, abs=2)
    assert size.at_px == pytest.approx((201.1, 150.8), abs=0.5)


def test_cast_shadows_are_not_added_to_stones_and_dark_stones_are_no_shadows():
    rocks = ("limestone", "basalt")
    made = photograph(replace(MORE, shadow=0.5, sun_deg=45.0, ground="plywood", rocks=rocks))
    result = segment_photo(pixels(made))
    got = score(made, result)
    assert got.recall == 1.0
    # Shadows of half the stones' area would leave .67.
    assert np.median(got.ious) > 0.96
    assert min(got.ious) > 0.85
    assert result.found.shadow_level == pytest.approx(0.5, abs=0.06)
    assert verdict_of(result.found, doubts_of(result.found)) == ()
    # No more light than a shadow has, but all round: no side is the shaded one.
    ground = np.array([150, 150, 148])
    stones = [(disc(80 + 140 * (k // 3), 70 + 130 * (k % 3), 40), ground * 0.72) for k in range(6)]
    found = segment(drawn(*stones, ground=ground))
    assert (found.count, found.shadow_level) == (6, 1.0)


def test_touching_stones_are_cut_where_they_touch_and_convex_ones_never():
    one, other = disc(150, 130, 60), disc(150, 245, 58)
    picture = drawn((one, (150, 150, 150)), (other, (150, 150, 150)))
    found = segment(picture)
    assert found.count == 2
    truth = (one & ~other) * 1 + (other & ~one) * 2
    assert overlaps(truth.astype(np.uint16), found.labels).max(axis=1).min() > 0.93
    whole = segment(picture, split=False)
    assert whole.count == 1
    assert "W175" in codes(whole)
    bar = (np.abs(ROWS - 150) < 18) & (np.abs(COLS - 200) < 160)
    wedge = (ROWS > 200) & (ROWS < 280) & (COLS > 40) & (COLS < 40 + 2 * (ROWS - 200))
    found = segment(drawn(bar, (wedge, (90, 90, 90))))
    assert (found.count, len(found.necks)) == (2, 0)


def test_a_waist_is_doubted_with_its_place_and_width():
    half = 24 + 18 * ((COLS - 200) / 80) ** 2
    stone = (np.abs(ROWS - 150) < half) & (np.abs(COLS - 200) < 90)
    found = segment(drawn(stone))
    assert found.count == 1
    (doubt,) = [one for one in doubts_of(found, 200.0) if one.code == "W175"]
    assert doubt.stones == (1,)
    assert doubt.at_px == pytest.approx((200, 150), abs=8)
    assert "it may be two stones" in doubt.text
    assert float(doubt.text.split(" cm wide")[0].split()[-1]) == pytest.approx(24, abs=3)
    # A broad contact has no waist.
    ell = (np.abs(ROWS - 150) < 80) & (np.abs(COLS - 150) < 35)
    ell |= (np.abs(ROWS - 200) < 30) & (COLS >= 150) & (COLS < 320)
    (doubt,) = [one for one in doubts_of(segment(drawn(ell))) if one.code == "W175"]
    assert "has a hollow outline: it may be two stones" in doubt.text


def test_stones_are_numbered_by_rows_with_holes_filled_and_without_those_at_the_edge():
    places = [(70, 80), (75, 200), (65, 320), (220, 80), (225, 320)]
    found = segment(drawn(*(disc(*place, 35) for place in places), disc(150, 10, 30)))
    assert [found.labels[place] for place in (*places, (150, 10))] == [1, 2, 3, 4, 5, 0]
    (doubt,) = [one for one in doubts_of(found) if one.code == "W176"]
    assert doubt.at_px[0] < 60
    ring = disc(150, 200, 60) & ~disc(150, 200, 8)
    assert segment(drawn(ring)[60:240, 110:290]).labels[90, 90] == 1
    frame = np.zeros((300, 400), bool)
    frame[40:260, 60:340] = True
    frame[90:210, 110:290] = False
    assert segment(drawn(frame)).labels[150, 200] == 0  # not what stones enclose


def test_bands_round_a_picture_are_no_ground_and_even_ground_is_no_band():
    picture = drawn(disc(150, 120, 60), disc(150, 280, 55))[::2, ::2]
    for colour, *sides in ((0, (30, 30), (0, 0)), (255, (0, 0), (0, 75)), (9, (25, 20), (20, 25))):
        framed = np.pad(picture, (*sides, (0, 0)), constant_values=colour)
        found = segment_photo(framed).found
        assert (found.count, found.left_out) == (2, ())
    slab = (np.abs(ROWS - 150) < 60) & (np.abs(COLS - 200) < 170)
    assert segment_photo(drawn(slab, noise=0.0)[::2, ::2]).found.count == 1
    # Stones that lie close: along most of a row or column there is no ground.
    close = [disc(60 + 60 * row, 60 + 56 * col, 27) for row in range(4) for col in range(6)]
    assert segment_photo(drawn(*close, ground=(255, 255, 255), noise=0.5)).found.count == 24


def test_a_sheet_is_not_taken_for_a_stone_in_silence_but_a_large_stone_is_one():
    sheet = (np.abs(ROWS - 150) < 80) & (np.abs(COLS - 200) < 100), (60, 110, 180)
    stones = [disc(150 + down, 200 + right, 24) for down in (-40, 40) for right in (-60, 0, 60)]
    lichen = [disc(150 + down, 200 + right, 8) for down in (-40, 40) for right in (-60, 0, 60)]
    cases = ([sheet, *stones], ["may be the sheet"]), ([sheet], []), ([sheet, *lichen], [])
    for layers, reasons in cases:
        found = segment(drawn(*layers, ground=(170, 140, 110)))
        assert found.count == 1
        said = verdict_of(found, doubts_of(found))
        assert len(said) == len(reasons)
        assert all(reason in one for one, reason in zip(said, reasons, strict=True))


def test_a_stone_of_which_a_part_was_taken_for_shadow_is_in_doubt():
    level = replace(MORE, ground="cloth", rocks=("granite",), shadow=0.5, uneven=0.2, seed=3)
    made = photograph(level)
    found = segment(pixels(made))
    ious = overlaps(made.truth_in(np.eye(3), found.labels.shape), found.labels).max(axis=0)
    bitten = np.flatnonzero(ious < 0.9) + 1
    assert len(bitten) == 2
    assert set(bitten) <= set(found.shaded)


@pytest.mark.parametrize("ground", ["light", "dark"])
def test_light_and_dark_ground_can_be_said(ground):
    """The left half is light, the right one dark, and each has a stone."""
    brown, red = (disc(150, 90, 40), (110, 90, 70)), (disc(150, 300, 40), (120, 60, 40))
    picture = drawn((COLS < 190, (230, 225, 215)), brown, red, ground=(40, 40, 45))
    found = segment(picture, ground=ground)
    assert (found.ground.colour[0] > 80) == (ground == "light")
    assert found.labels[150, 90 if ground == "light" else 300]


def test_small_and_unusual_stones_are_said():
    stones = [disc(70, 55 + 96 * k, 42) for k in range(4)]
    small = disc(220, 100, 12)
    speck = disc(220, 250, 4)
    found = segment(drawn(*stones, small, speck))
    assert found.count == 5
    (one,) = found.left_out
    assert (one.why, one.at_px) == (TOO_SMALL, pytest.approx((250.5, 220.5), abs=0.6))
    assert any("stone 5" in doubt.text for doubt in doubts_of(found) if doubt.code == "W179")
    assert segment(drawn(*stones, small, speck), min_area_px=600).count == 4
    faint = drawn((disc(150, 200, 60), (66, 126, 190)), noise=0.5)
    assert "W178" in codes(segment(faint))


@pytest.mark.parametrize("ground", ["auto", "light", "dark"])
def test_no_stones_and_no_ground_are_errors(ground):
    rng, everywhere = np.random.default_rng(0), np.ones((160, 200), bool)
    plain = np.clip(rng.normal(150, 3, (160, 200, 3)), 0, 255).astype(np.uint8)
    clouds = ndimage.gaussian_filter(rng.standard_normal((160, 200, 3)), (12, 12, 0))
    clouds = np.clip(128 + 70 * clouds / clouds.std(), 0, 255).astype(np.uint8)
    either = {"E175", "E176"}
    for picture, papers, codes in (
        (np.full((100, 100, 3), 0, np.uint8), None, {"E175"}),
        (np.full((100, 100, 3), 255, np.uint8), None, {"E175"}),
        (plain, None, either),
        (rng.integers(0, 256, (160, 200, 3), np.uint8), None, either),
        (drawn(disc(150, 200, 60))[70:230, 100:300], everywhere, {"E176"}),
        (clouds, None, {"E176"} if ground == "auto" else either),
    ):
        with pytest.raises(InputError) as refused:
            segment(picture, ground=ground, papers=papers)
        assert refused.value.code in codes


def test_large_photographs_are_reduced_and_areas_may_be_in_square_centimetres():
    picture = drawn(disc(150, 100, 40), disc(150, 300, 20))
    result = segment_photo(picture, 100.0, max_px=30_000)
    assert result.found.labels.shape == (150, 200)
    assert result.px_per_m == pytest.approx(50.0)
    assert result.from_photo == pytest.approx(np.diag([0.5, 0.5, 1.0]))
    # 1 px is .25 cm2: the discs have 1257 and 314 cm2.
    assert segment_photo(picture, 200.0, min_area=(400, "cm2")).found.count == 1
    assert segment_photo(picture, 200.0, min_area=(400, "px")).found.count == 2


def test_markers_are_no_stones_when_the_scale_is_given(monkeypatch):
    level = replace(SMALL, markers="sheet", width_px=640, height_px=480, px_per_m=570.0, count=7)
    made = photograph(level)
    result = segment_photo(pixels(made), 570.0)
    assert result.unasked == (0, 1, 2, 3)
    (notice,) = result.notices
    assert (notice.code, "--aruco" in notice.cure) == ("W170", True)
    # The sheet would be one more, and a false one.
    assert score(made, result).precision == 1.0
    monkeypatch.setitem(sys.modules, "cv2", None)  # without OpenCV none are looked for
    result = segment_photo(drawn(disc(150, 200, 60)), 100.0)
    assert (result.found.count, result.unasked, result.notices) == (1, (), ())


def test_a_stone_along_the_ruler_is_doubted():
    labels = np.zeros((300, 400), np.uint16)
    labels[100:112, 50:350] = 1  # the ruler
    labels[130:200, 60:160] = 2
    (along,) = ruler_doubts(labels, ((60.0, 99.0), (340.0, 99.0)))
    assert (along.code, along.stones) == ("W179", (1,))
    (upright,) = ruler_doubts(labels.T, ((113.0, 340.0), (113.0, 60.0)))
    assert upright.stones == (1,)
    # From one stone to another, over none, and to the corner of the picture.
    assert not ruler_doubts(labels, ((100.0, 105.0), (100.0, 160.0)))
    assert not ruler_doubts(labels, ((10.0, 250.0), (390.0, 250.0)))
    assert not ruler_doubts(labels, ((0.0, 0.0), (400.0, 300.0)))


PX_PER_M, HEIGHT_PX = 800.0, 600
SHEET, SINGLE = parse_layout("A4:50mm"), parse_layout("120mm")
TILTED = np.array([[0.4, 0.03, -20.0], [-0.02, 0.5, 10.0], [1e-5, 4e-5, 1.0]])


def laid(layout, one, angle_deg, at_m):
    """Corners of a marker in P, where y is up, of paper with its upper left at a place."""
    return turn(layout.corners_m(one) * (1.0, -1.0), angle_deg) + at_m


def photographed(corners_m, from_photo, noise_px=0.0):
    """Find corners in a photograph that is seen as the picture from above is not."""
    picture = corners_m * (PX_PER_M, -PX_PER_M) + (0, HEIGHT_PX)
    seen = apply(np.linalg.inv(from_photo), picture)
    return seen + np.random.default_rng(3).normal(0.0, noise_px, (4, 2))


@pytest.mark.parametrize("from_photo", [np.eye(3), TILTED])
@pytest.mark.parametrize("angle_deg", [0.0, 33.0, -140.0])
def test_the_frame_of_a_marker_is_in_the_middle_of_its_print(angle_deg, from_photo):
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


def test_all_markers_of_a_sheet_say_how_it_lies():
    """One marker that was found a little turned does not turn the frame as much."""
    corners = [photographed(laid(SHEET, one, 20.0, (0.3, 0.4)), np.eye(3), float(one == 0))
               for one in range(4)]  # fmt: skip
    seen = [FoundMarker(one, at, "aruco") for one, at in enumerate(corners)]
    off_deg = []
    for some in (seen, seen[:1]):
        x, y, _ = placed_markers(some, SHEET, np.eye(3), PX_PER_M, HEIGHT_PX)[0].pose.xaxis
        off_deg.append(abs(np.degrees(np.arctan2(y, x)) - 20.0))
    assert off_deg[0] < 0.25 * off_deg[1]


SHAPE = (420, 560)


def rgb(grey, tint=(1.0, 0.97, 0.9)):
    return np.clip(np.asarray(grey)[..., None] * tint, 0, 255).astype(np.uint8)


def smooth(rng, sigma, shape=SHAPE):
    values = ndimage.gaussian_filter(rng.standard_normal(shape), sigma)
    return values / values.std()


def pebbles(rng):
    """Stones side by side without a ground: each its own grey, dark gaps between."""
    seeds = rng.random((260, 2)) * SHAPE
    far, nearest = cKDTree(seeds).query(np.stack(np.indices(SHAPE), axis=-1), 2)
    grey = rng.uniform(60, 220, 260)[nearest[..., 0]] + 6 * smooth(rng, 2)
    return rgb(np.where(far[..., 1] - far[..., 0] < 3, 25, grey))


def paint(rng):
    """Boulders of the colour of the floor, with numbers in paint on them."""
    picture = rgb(120 + 16 * smooth(rng, 9) + 5 * smooth(rng, 1))
    for _ in range(7):
        row, col = rng.integers(40, 360), rng.integers(40, 480)
        for part in (np.s_[row : row + 5, col : col + 40], np.s_[row : row + 34, col : col + 5]):
            picture[part] = 150, 220, 60
    return picture


def sand(rng):
    """Coarse ground of light and dark grains, and one red stone."""
    picture = rgb(120 + 40 * smooth(rng, 3))
    rows, cols = np.indices(SHAPE)
    picture[np.hypot(rows - 200, cols - 300) < 24] = 170, 70, 50
    return picture


def sheet(rng):
    """Stones on a red sheet that lies on a beach."""
    picture = pebbles(rng)
    picture[40:380, 60:500] = 190, 50, 70
    rows, cols = np.indices(SHAPE)
    for row, col in product((110, 210, 310), (130, 230, 330, 430)):
        picture[np.hypot(rows - row, cols - col) < 30] = rng.integers(90, 180)
    return picture


def installed(name):
    with Image.open(Path(skimage.__file__).parent / "data" / f"{name}.png") as picture:
        return np.asarray(picture.convert("RGB"))


@pytest.mark.parametrize("kind", [pebbles, paint, sand, sheet, "brick", "gravel", "grass"])
def test_what_is_no_photograph_of_stones_laid_out_is_in_doubt_or_refused(kind):
    """Also parts of walls and beds."""
    if isinstance(kind, str):
        picture = np.ascontiguousarray(installed(kind)[61:357, 211:507])
    else:
        picture = kind(np.random.default_rng(1))[... if kind is sheet else np.s_[20:340, 40:440]]
    try:
        found = segment(picture)
        said = [one.code for one in verdict_notices(verdict_of(found, doubts_of(found)))]
    except InputError as error:
        said = [error.code]
    assert said in (["E175"], ["E176"], ["W183"])


@pytest.mark.parametrize("filled", [8, 20])
def test_a_joint_that_was_filled_is_cleared_to_its_middle(filled):
    """What is left of it half way is a spike on both stones."""
    stones = np.zeros((160, 240), bool)
    stones[30:130, 30:110], stones[30:130, 126:210] = True, True
    lab = np.where(stones[..., None], np.float32([60, 5, 5]), np.float32([45, 0, -30]))
    about = stones.copy()
    about[80 - filled // 2 : 80 + filled // 2, 110:126] = True
    refined = refine_outlines(lab, about, np.ones_like(stones))
    assert not refined[40:120, 110:126].any()
    assert np.count_nonzero(refined != stones) < 30  # corners are rounded


def test_few_stones_on_a_large_plain_ground_are_not_in_doubt():
    found = segment(drawn(*(disc(150, col, 15) for col in (80, 200, 320))))
    assert found.count == 3
    assert not verdict_of(found, doubts_of(found))


def test_many_shapes_that_were_left_out_are_named_in_part():
    specks = [(ROWS // 6 == 46) & (COLS // 6 == part) for part in range(3, 64, 5)]
    found = segment(drawn(disc(150, 200, 60), *specks))
    (notice,) = notices_of(doubts_of(found))
    assert notice.code == "W182"
    assert notice.message.count("too small") == LISTED
    assert f"and {len(found.left_out) - LISTED} more in stones.json" in notice.message


def test_light_from_one_side_is_said_and_what_it_hides_and_ground_that_is_not_plain():
    found = segment(installed("coins"))
    assert "uneven" in " ".join(verdict_of(found, doubts_of(found)))
    whys = {one.why: one.at_px for one in found.left_out}
    # One of the coins lies at the right edge; the upper left one is in the brightest ground.
    assert whys[EDGE] == pytest.approx((358, 268), abs=2)
    assert whys[FAINT] == pytest.approx((45, 54), abs=20)
    with pytest.raises(InputError, match=r"not plain.*river bed"):
        segment(installed("gravel"))
