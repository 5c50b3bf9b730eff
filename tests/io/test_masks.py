"""Which pictures and archives of arrays are masks, and how their stones are numbered."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from PIL import Image
from scipy import ndimage

from drystone.errors import InputError, LabelImageError, UsageError
from drystone.io.masks import components
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import PIECES, compare, label_image, masks
from tests.io.pictures import areas, codes, discs, many_stones, two_stones
from tests.naive import io as naive

small_masks = arrays(bool, array_shapes(min_dims=2, max_dims=2, max_side=12))


@given(small_masks)
def test_components_are_numbered_in_row_order(mask):
    labels, count = components(mask)
    expected, expected_count = naive.components(mask)
    assert count == expected_count
    np.testing.assert_array_equal(labels, expected)


@pytest.mark.parametrize(
    "mask",
    [
        two_stones(1, 1, bool),
        two_stones(1, 1, np.uint8),
        two_stones(255, 255, np.uint8),
        two_stones(1, 1, float),
        two_stones(300, 300, np.uint16),
    ],
)
def test_two_values_are_a_mask(tmp_path, mask):
    stones = read_stones(mask)
    assert areas(stones) == {1: 375, 2: 600}
    assert codes(stones) == ["W114"]
    assert "2 components, numbered in row order" in stones.notices[0].message
    if mask.dtype in (bool, np.uint8):
        Image.fromarray(mask).save(tmp_path / "m.png")
        assert areas(read_stones(tmp_path / "m.png")) == {1: 375, 2: 600}


def test_stones_that_meet_at_a_corner_are_one_component():
    mask = np.zeros((40, 40), bool)
    mask[5:20, 5:20] = mask[20:35, 20:35] = True
    stones = read_stones(mask)
    assert areas(stones) == {1: 450}
    assert codes(stones) == ["W114", "W110"]
    assert "meet at a corner only" in stones.notices[1].message


def test_a_single_stone_keeps_its_id():
    labels = two_stones()
    labels[labels == 70000] = 0
    assert areas(read_stones(labels)) == {300: 375}
    labels[labels == 300] = 255
    assert areas(read_stones(labels)) == {1: 375}
    assert areas(read_stones(labels, settings=ReadSettings(mask=False))) == {255: 375}


def test_two_stones_that_fill_the_picture_are_ids():
    labels = np.full((20, 40), 5, np.uint8)
    labels[:, 22:] = 9
    assert areas(read_stones(labels)) == {5: 440, 9: 360}


@pytest.mark.parametrize("colour", [False, True])
def test_antialiased_mask(tmp_path, colour):
    centres = [(15, 15), (15, 50), (50, 16), (50, 52)]
    cover = (discs((70, 70), centres, 10.3) * 255).astype(np.uint8)
    values = cover
    if colour:
        # Sub-pixel smoothing leaves a little colour in the edges.
        values = np.dstack([cover, cover, cover - np.uint8(20) * ((cover > 40) & (cover < 255))])
    Image.fromarray(values).save(tmp_path / "m.png")
    stones = read_stones(tmp_path / "m.png")
    assert len(stones) == 4
    assert stones.total_area_px == int((cover >= 127.5).sum())
    between = int(((cover > 0) & (cover < 255)).sum())
    assert codes(stones) == ["W114"]
    assert f"{between} px of values between them" in stones.notices[0].message


def test_a_grey_stone_among_antialiased_ones_is_not_taken_for_an_edge():
    centres = [(15 + 30 * i, 15 + 30 * j) for i in range(4) for j in range(4)]
    values = (discs((150, 130), centres, 10.3) * 255).astype(np.uint8)
    values[130:140, 10:20] = 90
    with pytest.raises(LabelImageError, match=r"E10[13]"):
        read_stones(values)


def test_few_grey_stones_are_no_antialiasing():
    # 0 and the large stone's 200 hold nearly all pixels; the others are stones all the same.
    labels = np.zeros((200, 200), np.uint8)
    labels[10:150, 10:190] = 200
    for i in range(5):
        labels[160:170, 10 + 30 * i : 20 + 30 * i] = 20 + i
    labels[180:182, 10:30] = 30  # a sliver with no 3 x 3 px of its own
    assert len(read_stones(labels)) == 7


def test_colours_are_no_mask_although_equally_bright():
    picture = np.zeros((40, 80, 3), np.uint8)
    for i, colour in enumerate([(255, 0, 0), (0, 255, 0), (0, 0, 255)]):
        picture[5:35, 5 + 25 * i : 25 + 25 * i] = colour
    assert areas(read_stones(picture)) == {255: 600, 65280: 600, 255 * 65536: 600}


def test_mask_is_forced():
    cover = discs((70, 70), [(15, 15), (50, 50)], 10.3)
    blurred = np.round(ndimage.gaussian_filter(cover, 2.0) * 200).astype(np.uint8)
    assert len(read_stones(blurred, settings=ReadSettings(mask=True))) == 2
    labels = many_stones(2, 3, first=200, step=10)
    stones = read_stones(labels, settings=ReadSettings(mask=True))
    assert areas(stones) == dict.fromkeys(range(1, 7), 576)
    labels[0, 0] = 1
    assert read_stones(labels, settings=ReadSettings(mask=True)).total_area_px == 6 * 576


@pytest.mark.parametrize(("count", "lossy"), [(3, False), (30, False), (4, True)])
def test_ids_are_not_forced_into_a_mask(tmp_path, count, lossy):
    labels = many_stones(1, count, first=1, step=1)
    path = tmp_path / ("ids.jpg" if lossy else "ids.png")
    scale = 240 // count if lossy else 1
    Image.fromarray((labels * scale).astype(np.uint8)).save(path)
    with pytest.raises(UsageError, match=r"E118 ids.*plain areas are neither.*leave --mask"):
        read_stones(path, settings=ReadSettings(mask=True))
    labels[labels == count] = 255
    with pytest.raises(UsageError, match=r"E118 array: \d\d%"):
        read_stones(labels, settings=ReadSettings(mask=True))


@pytest.mark.parametrize(("value", "quality"), [(128, 10), (200, 50), (255, 95)])
def test_a_mask_of_any_grey_can_be_forced_in_a_lossy_file(tmp_path, value, quality):
    # Edges overshoot: the brightest pixel is brighter than the stones.
    labels = np.minimum(many_stones(3, 4), 1) * value
    Image.fromarray(labels.astype(np.uint8)).save(tmp_path / "mask.jpg", quality=quality)
    assert len(read_stones(tmp_path / "mask.jpg", settings=ReadSettings(mask=True))) == 12


@given(arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, min_side=3)), st.booleans())
def test_forced_reading_never_crashes_and_loses_nothing(values, mask):
    """Every pixel is a stone's, a listed speck's, or background."""
    labels = values.astype(int) % 3 * 100
    settings = ReadSettings(mask=mask, min_area_px=1, pieces="split", holes="keep")
    if len(np.unique(labels)) < 2 or not (labels == 0).any():
        return
    stones = read_stones(np.pad(labels, 1), settings=settings)
    expected = (labels > 0).sum() if not mask else (2 * labels >= labels.max()).sum()
    assert stones.total_area_px == expected


# -- archives of arrays -------------------------------------------------------------------------


def saved(tmp_path, **arrays):
    np.savez_compressed(tmp_path / "stones.npz", **arrays)
    return tmp_path / "stones.npz"


def test_an_array_of_labels_is_enough(tmp_path):
    path = saved(tmp_path, image=np.zeros((40, 60, 3)), labels=label_image(), x=np.arange(3))
    assert compare(read_stones(path, settings=PIECES)) == (1.0, 0.0, 0.0)


def test_a_mask_a_stone(tmp_path):
    given = {f"stone_{i}": mask.astype(np.uint8) * 255 for i, mask in masks().items()}
    stones = read_stones(saved(tmp_path, **given), settings=PIECES)
    assert compare(stones) == (1.0, 0.0, 0.0)
    assert stones.by_id(300).name == "stone_300"
    by_name = {f"m{i}": mask for i, mask in masks().items()}
    assert {stone.id for stone in read_stones(saved(tmp_path, **by_name), settings=PIECES)} == {
        *range(1, 8)
    }


@pytest.mark.parametrize(
    ("arrays", "text"),
    [
        ({"a": np.zeros((4, 4)), "b": np.zeros((5, 4))}, "not masks of one picture"),
        ({"a": np.zeros(4), "b": np.zeros(4)}, "not masks of one picture"),
        ({"a": np.eye(4), "b": np.arange(16).reshape(4, 4)}, "'b' is not a mask"),
    ],
)
def test_arrays_that_are_no_masks(tmp_path, arrays, text):
    with pytest.raises(InputError, match=rf"E114.*{text}"):
        read_stones(saved(tmp_path, **arrays))


def test_damaged_archives(tmp_path):
    path = saved(tmp_path, a=label_image())
    data = path.read_bytes()
    path.write_bytes(data[:-40])
    with pytest.raises(InputError, match=r"E106"):
        read_stones(path)
    np.savez(path, a=np.array([{}], dtype=object), b=np.zeros(3))
    with pytest.raises(InputError, match=r"E107.*pickle"):
        read_stones(path)
