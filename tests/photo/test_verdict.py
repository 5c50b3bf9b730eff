"""Whole photographs: found, or in doubt with a reason, never stones that are none and no word."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import skimage
from PIL import Image
from scipy import ndimage
from scipy.spatial import cKDTree

from drystone.errors import InputError
from drystone.photo.segment import EDGE, FAINT, segment
from drystone.photo.segment_doubts import LISTED, doubts_of, notices_of, verdict_notices, verdict_of
from drystone_lab.photographs.scene import photograph
from drystone_lab.photos import pixels
from tests.photo.scenes import SMALL

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


def concrete(rng):
    return 120 + 16 * smooth(rng, 9) + 5 * smooth(rng, 1)


def paint(rng):
    """Boulders of the colour of the floor, with numbers in paint on them."""
    picture = rgb(concrete(rng))
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


def room(rng):
    """Boxes of all sizes and colours in front of each other."""
    picture = rgb(concrete(rng))
    for _ in range(60):
        row, col = rng.integers(0, 400), rng.integers(0, 540)
        high, wide = rng.integers(10, 180, 2)
        picture[row : row + high, col : col + wide] = rng.integers(20, 240, 3)
    return picture


def sheet(rng):
    """Stones on a red sheet that lies on a beach."""
    picture = pebbles(rng)
    picture[40:380, 60:500] = 190, 50, 70
    rows, cols = np.indices(SHAPE)
    for row in (110, 210, 310):
        for col in (130, 230, 330, 430):
            picture[np.hypot(rows - row, cols - col) < 30] = rng.integers(90, 180)
    return picture


def in_doubt_or_refused(picture):
    try:
        found = segment(picture)
    except InputError as error:
        return error.code in ("E175", "E176")
    against = verdict_of(found, doubts_of(found))
    assert [notice.code for notice in verdict_notices(against)] == ["W183"] * bool(against)
    return bool(against)


@pytest.mark.parametrize("kind", [pebbles, paint, sand, room, sheet])
def test_what_is_no_photograph_of_stones_laid_out_is_in_doubt_or_refused(kind):
    assert in_doubt_or_refused(kind(np.random.default_rng(1)))


@pytest.mark.parametrize(
    "changes",
    [
        {"ground": "gravel", "rocks": ("granite", "schist")},
        {"ground": "grass", "touching": 2, "shadow": 0.45},
    ],
)
def test_ground_that_varies_is_not_in_doubt(changes):
    """Plainer photographs are not in doubt either: test_segment.py."""
    found = segment(pixels(photograph(replace(SMALL, **changes))))
    assert found.ground.spread.max() > 4.0
    assert verdict_of(found, doubts_of(found)) == ()


def test_few_stones_on_a_large_plain_ground_are_not_in_doubt():
    rng = np.random.default_rng(4)
    picture = rgb(200 + rng.normal(0, 2, SHAPE), (0.4, 0.6, 1.0))
    rows, cols = np.indices(SHAPE)
    for col in (120, 300, 480):
        picture[np.hypot(rows - 200, cols - col) < 22] = 130, 120, 110
    found = segment(picture)
    assert found.count == 3
    assert not verdict_of(found, doubts_of(found))


def installed(name):
    with Image.open(Path(skimage.__file__).parent / "data" / f"{name}.png") as picture:
        return np.asarray(picture.convert("RGB"))


def test_light_from_one_side_is_said_and_what_it_hides():
    found = segment(installed("coins"))
    assert "uneven" in " ".join(verdict_of(found, doubts_of(found)))
    whys = {one.why: one.at_px for one in found.left_out}
    # One of the coins lies at the right edge; the upper left one is in the brightest ground.
    assert whys[EDGE] == pytest.approx((358, 268), abs=2)
    assert whys[FAINT] == pytest.approx((45, 54), abs=20)


@pytest.mark.parametrize("name", ["brick", "gravel", "grass"])
def test_parts_of_walls_and_beds_are_never_stones(name):
    whole = installed(name)
    assert in_doubt_or_refused(np.ascontiguousarray(whole[61:357, 211:507]))


def test_ground_that_is_not_plain_is_said_where_nothing_was_found():
    with pytest.raises(InputError, match=r"not plain.*river bed"):
        segment(installed("gravel"))


def test_many_shapes_that_were_left_out_are_named_in_part():
    rng = np.random.default_rng(6)
    picture = rgb(200 + rng.normal(0, 2, SHAPE), (0.4, 0.6, 1.0))
    rows, cols = np.indices(SHAPE)
    picture[np.hypot(rows - 200, cols - 280) < 70] = 130, 120, 110
    for col in range(30, 540, 40):
        picture[395:401, col : col + 6] = 130, 120, 110
    found = segment(picture)
    (notice,) = notices_of(doubts_of(found))
    assert notice.code == "W182"
    assert notice.message.count("too small") == LISTED
    assert f"and {len(found.left_out) - LISTED} more in stones.json" in notice.message
