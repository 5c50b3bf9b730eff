"""Channels beside the ids, colours that hold none, and the orientation of label images."""

import io

import numpy as np
import pytest
import tifffile
from PIL import Image

from drystone.errors import InputError
from drystone.io.images import decode
from drystone.io.read_stones import read_stones
from drystone.io.wall_image import read_wall_image
from tests.io.pictures import areas, codes, two_stones
from tests.io.test_formats import LIMIT, pillow, rgb

MASKS = np.stack([two_stones() == 300, two_stones() == 70000], axis=-1)
FULL = np.full((40, 60, 1), 255, np.uint8)


def with_last(values, last):
    return np.concatenate([np.atleast_3d(values), np.atleast_3d(last)], axis=-1)


# -- orientation -------------------------------------------------------------------------------


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("dtype", [bool, np.uint8, np.uint16, np.int32])
def test_an_orientation_turns_no_label_image_in_any_compression(orientation, dtype):
    labels = two_stones(0 if dtype is bool else 7, 1, dtype)
    packed = ["raw", "packbits", "tiff_adobe_deflate", "tiff_lzw"]
    for compression in [*packed, *(["group4", "group3"] if dtype is bool else [])]:
        data = pillow(labels, "TIFF", compression=compression, tiffinfo={274: orientation})
        values = decode(data, LIMIT).values
        np.testing.assert_array_equal(values.astype(dtype), labels, err_msg=compression)


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_an_orientation_turns_no_mask_in_other_formats(kind):
    mask = (two_stones() > 0).astype(np.uint8) * np.uint8(255)
    exif = Image.Exif()
    exif[0x0112] = 6
    values = decode(pillow(mask, kind, exif=exif), LIMIT).values
    np.testing.assert_array_equal(values > 127, mask > 0)


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
        with pytest.raises(InputError, match=r"E109.*no transparency.*one channel.*a folder"):
            read_stones(source)


@pytest.mark.parametrize("colour", [False, True])
@pytest.mark.parametrize(
    "alpha", [FULL, FULL * 0, (two_stones() > 0) * np.uint8(255), (two_stones() > 0)]
)
def test_an_array_with_alpha_is_read(colour, alpha):
    values = rgb(two_stones()) if colour else two_stones()
    assert areas(read_stones(with_last(values, alpha))) == {300: 375, 70000: 600}


@pytest.mark.parametrize("kind", ["PNG", "TIFF", "lzw"])
@pytest.mark.parametrize("channels", [2, 4])
def test_alpha_that_a_file_declares_is_ignored_whatever_it_holds(tmp_path, kind, channels):
    grey = two_stones(8, 255, np.uint8)
    alpha = np.random.default_rng(1).integers(0, 256, (40, 60), dtype=np.uint8)
    options = {"compression": "tiff_lzw"} if kind == "lzw" else {}
    values = np.dstack([grey] * (channels - 1) + [alpha])
    data = pillow(values, "TIFF" if kind == "lzw" else kind, **options)
    (tmp_path / "a.any").write_bytes(data)
    stones = read_stones(tmp_path / "a.any")
    assert areas(stones) == {8: 375, 255: 600}
    assert codes(stones) == []
    np.testing.assert_array_equal(read_wall_image(tmp_path / "a.any"), grey)


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
        assert areas(read_stones(tmp_path / "a.tif")) == {1: 375}
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
