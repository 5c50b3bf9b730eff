"""Channels beside the ids, colours that hold none, and the orientation of label images."""

import io

import numpy as np
import pytest
import tifffile
from PIL import Image, ImageOps
from scipy import ndimage

from drystone.errors import InputError, LabelImageError
from drystone.io.images import decode
from drystone.io.read_stones import ReadSettings, read_stones
from drystone.io.wall_image import read_wall_image
from drystone.io.walls import read_wall
from tests.io.pictures import areas, codes, two_stones
from tests.io.test_formats import LIMIT, pillow, rgb

MASKS = np.stack([two_stones() == 300, two_stones() == 70000], axis=-1)
FULL = np.full((40, 60, 1), 255, np.uint8)


def with_last(values, last):
    return np.concatenate([np.atleast_3d(values), np.atleast_3d(last)], axis=-1)


# -- orientation -------------------------------------------------------------------------------


def upright(values, orientation):
    """The picture as a program shows it that follows its orientation."""
    image = Image.fromarray(values.astype(np.int32), "I")
    image.getexif()[274] = orientation
    return np.asarray(ImageOps.exif_transpose(image))


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("dtype", [bool, np.uint8, np.uint16, np.int32])
def test_an_orientation_turns_a_label_image_in_any_compression(orientation, dtype):
    labels = two_stones(0 if dtype is bool else 7, 1, dtype)
    packed = ["raw", "packbits", "tiff_adobe_deflate", "tiff_lzw"]
    for compression in [*packed, *(["group4", "group3"] if dtype is bool else [])]:
        data = pillow(labels, "TIFF", compression=compression, tiffinfo={274: orientation})
        picture = decode(data, LIMIT)
        np.testing.assert_array_equal(
            picture.values.astype(int), upright(labels, orientation), err_msg=compression
        )
        assert [notice.code for notice in picture.notices] == ["W173"] * (orientation > 1)


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
@pytest.mark.parametrize("orientation", [4, 6])
def test_an_orientation_turns_a_mask_with_its_alpha_in_other_formats(kind, orientation):
    mask = (two_stones() > 0).astype(np.uint8) * np.uint8(255)
    alpha = (two_stones() != 300) * np.uint8(255)
    exif = Image.Exif()
    exif[0x0112] = orientation
    values = mask if kind == "JPEG" else np.dstack([mask, alpha])
    picture = decode(pillow(values, kind, exif=exif), LIMIT)
    np.testing.assert_array_equal(picture.values > 127, upright(mask, orientation) > 0)
    if kind == "PNG":
        np.testing.assert_array_equal(picture.alpha, upright(alpha, orientation))


def test_all_readers_of_a_wall_turn_it_alike(tmp_path):
    labels = two_stones(7, 9, np.uint8)
    (tmp_path / "a.tif").write_bytes(pillow(labels, "TIFF", tiffinfo={274: 4}))
    wall = read_wall(tmp_path / "a.tif")
    np.testing.assert_array_equal(wall.labels, labels[::-1])
    assert [notice.code for notice in wall.notices] == ["W173"]
    assert "mirrored top to bottom, as its orientation (4) says" in str(wall.notices[0])
    assert read_stones(tmp_path / "a.tif").by_id(7).bottom_px == 5


# -- channels ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "values",
    [
        MASKS,
        MASKS.astype(np.uint8) * np.uint8(255),
        np.stack([two_stones() > 0, two_stones() == 300], axis=-1),
        with_last(two_stones(7, 9, np.uint8), (two_stones() == 300) * np.uint8(255)),
        with_last(rgb(two_stones()), (two_stones() == 300) * np.uint8(255)),
        np.stack([two_stones() == 300, two_stones() == 70000, MASKS[..., 0], ~MASKS[..., 0]], -1),
    ],
)
def test_a_last_channel_that_may_be_a_stone_is_refused(tmp_path, values):
    np.save(tmp_path / "two.npy", values)
    np.savez(tmp_path / "two.npz", values)
    for source in (values, tmp_path / "two.npy", tmp_path / "two.npz"):
        with pytest.raises(InputError, match=r"E109.*not transparency.*one channel.*a folder"):
            read_stones(source)


@pytest.mark.parametrize("colour", [False, True])
@pytest.mark.parametrize(
    "alpha", [FULL, FULL * 0, (two_stones() > 0) * np.uint8(255), (two_stones() > 0)]
)
def test_an_array_with_alpha_is_read(colour, alpha):
    values = rgb(two_stones()) if colour else two_stones()
    assert areas(read_stones(with_last(values, alpha))) == {300: 375, 70000: 600}


GREY = two_stones(8, 255, np.uint8)
NOISE = np.random.default_rng(1).integers(1, 256, (40, 60), dtype=np.uint8)
ERASED = (GREY != 8) * np.uint8(255)  # the colours of stone 8 are there, under alpha 0
SOFT = np.round(ndimage.gaussian_filter((GREY > 0) * 255.0, 1)).astype(np.uint8)


def with_alpha(kind, values, alpha):
    """A file of grey values with alpha: a channel, or an entry of the palette that is clear."""
    if kind in ("L", "RGB"):
        channels = [values] * (1 if kind == "L" else 3)
        return pillow(np.dstack([*channels, alpha]), "PNG")
    if kind in ("TIFF", "lzw"):
        options = {"compression": "tiff_lzw"} if kind == "lzw" else {}
        return pillow(np.dstack([values] * 3 + [alpha]), "TIFF", **options)
    image = Image.fromarray(values)
    clear = int(values[alpha == 0].max())
    if kind in ("P", "GIF"):
        image.putpalette([i // 3 for i in range(768)])
    elif kind == "16":
        image = Image.fromarray(values.astype(np.uint16))
    buffer = io.BytesIO()
    image.save(buffer, "GIF" if kind == "GIF" else "PNG", transparency=clear, optimize=False)
    return buffer.getvalue()


CHANNELS = ["L", "RGB", "TIFF", "lzw"]


@pytest.mark.parametrize("kind", [*CHANNELS, "P", "GIF", "16", "8"])
def test_a_transparent_pixel_is_background_whatever_its_colour(tmp_path, kind):
    (tmp_path / "a.any").write_bytes(with_alpha(kind, GREY, ERASED))
    stones = read_stones(tmp_path / "a.any", settings=ReadSettings(mask=False))
    assert areas(stones) == {255: 600}
    assert codes(stones) == ["W135"]
    assert "375 px are transparent, whatever their colour" in str(stones.notices[0])
    wall = read_wall(tmp_path / "a.any")
    np.testing.assert_array_equal(wall.labels, GREY * (ERASED > 0))
    assert [notice.code for notice in wall.notices] == ["W135"]


@pytest.mark.parametrize("kind", CHANNELS)
@pytest.mark.parametrize(
    ("alpha", "said"),
    [(NOISE, []), (FULL[..., 0], []), ((GREY > 0) * np.uint8(255), []), (GREY * 0, ["W174"])],
)
def test_alpha_that_hides_no_stone_changes_nothing(tmp_path, kind, alpha, said):
    (tmp_path / "a.any").write_bytes(with_alpha(kind, GREY, alpha))
    stones = read_stones(tmp_path / "a.any")
    assert areas(stones) == {8: 375, 255: 600}
    assert codes(stones) == said
    np.testing.assert_array_equal(read_wall_image(tmp_path / "a.any"), GREY)


@pytest.mark.parametrize("kind", CHANNELS)
@pytest.mark.parametrize("colour", [0, 90, 255])
@pytest.mark.parametrize("alpha", [(GREY > 0) * np.uint8(255), (GREY > 0) * np.uint8(1), SOFT])
def test_a_mask_that_lives_in_alpha(tmp_path, kind, colour, alpha):
    for under in {colour, 0}:
        values = np.where(alpha > 0, colour, under).astype(np.uint8)
        (tmp_path / "a.any").write_bytes(with_alpha(kind, values, alpha))
        stones = read_stones(tmp_path / "a.any")
        expected = (alpha > 0) if alpha is not SOFT else (SOFT >= 128)
        assert len(stones) == 2
        assert stones.total_area_px == expected.sum()
        assert "W114" in codes(stones)


@pytest.mark.parametrize("kind", ["GIF", "P", "16"])
def test_a_stone_of_0_on_a_transparent_ground_is_refused(tmp_path, kind):
    values = np.select([GREY == 8, GREY == 255], [0, 5], 9).astype(np.uint8)
    (tmp_path / "a.any").write_bytes(with_alpha(kind, values, (values != 9) * 255))
    with pytest.raises(LabelImageError, match=r"E108 a.any: 375 px are 0 .*add 1"):
        read_stones(tmp_path / "a.any")
    values[values == 0] = 7
    (tmp_path / "a.any").write_bytes(with_alpha(kind, values, (values != 9) * 255))
    assert areas(read_stones(tmp_path / "a.any")) == {7: 375, 5: 600}


@pytest.mark.parametrize("declared", [False, True])
def test_an_extra_channel_of_a_tiff_is_alpha_only_where_it_says_so(tmp_path, declared):
    values = MASKS.astype(np.uint8) * np.uint8(255)
    extra = ["unassalpha" if declared else "unspecified"]
    buffer = io.BytesIO()
    tifffile.imwrite(
        buffer, values, photometric="minisblack", planarconfig="contig", extrasamples=extra
    )
    (tmp_path / "a.tif").write_bytes(buffer.getvalue())
    if declared:
        # All that can be seen is 0 where the other mask is 255.
        stones = read_stones(tmp_path / "a.tif")
        assert areas(stones) == {1: 600}
        assert codes(stones) == ["W135", "W114"]
        return
    with pytest.raises(InputError, match=r"E109 a.tif: the last channel"):
        read_stones(tmp_path / "a.tif")


@pytest.mark.parametrize("kind", ["TIFF", "lzw", "JPEG"])
@pytest.mark.parametrize("mode", ["CMYK", "LAB", "YCbCr"])
def test_colours_that_hold_no_ids(tmp_path, kind, mode):
    if kind == "JPEG" and mode != "CMYK":
        return
    image = Image.fromarray(rgb(two_stones()))
    image = Image.new("LAB", image.size, (3, 3, 3)) if mode == "LAB" else image.convert(mode)
    options = {"compression": "tiff_lzw"} if kind == "lzw" else {}
    image.save(tmp_path / "a.any", "TIFF" if kind == "lzw" else kind, **options)
    with pytest.raises(InputError, match=rf"E107 a.any: the colour mode {mode} does not hold ids"):
        read_stones(tmp_path / "a.any")


# -- no warnings of NumPy (errors in these tests) ----------------------------------------------


@pytest.mark.parametrize("suffix", ["tif", "npy"])
def test_numbers_of_16_bits_with_a_point(tmp_path, suffix):
    labels = two_stones(7, 300, np.float16)
    path = tmp_path / f"a.{suffix}"
    np.save(path, labels) if suffix == "npy" else tifffile.imwrite(path, labels)
    assert areas(read_stones(path)) == {7: 375, 300: 600}
    labels[3, 4] = np.inf
    with pytest.raises(InputError, match=r"E108.*1 px are not finite"):
        read_stones(labels)
