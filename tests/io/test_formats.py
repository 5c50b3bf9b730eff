"""Every format that stones are read from keeps ids and pixels."""

import hashlib
import io
import struct
from itertools import product

import numpy as np
import pytest
from fuzz.containers import png_of
from fuzz.pictures import colours, held, npy, pillow, png, tiff
from PIL import Image, ImageOps
from scipy import ndimage

from drystone.errors import InputError
from drystone.io.images import decode
from drystone.io.read_stones import ReadSettings, read_stones
from drystone.io.wall_image import read_wall_image
from drystone.io.walls import read_wall
from tests.io.pictures import areas, codes, said, two_stones

LIMIT = 10**6


def test_ids_of_8_16_and_32_bits_survive(tmp_path):
    small = two_stones(7, 255, np.uint8)
    # GIF: keep unused colours
    kinds = ("PNG", "TIFF", "BMP", "GIF")
    files = [(255, pillow(small, kind, optimize=False)) for kind in kinds]
    indices = Image.fromarray(small)  # whose colours all look the same
    indices.putpalette([0, 0, 0, *[9] * 765])
    for kind in kinds[:3]:
        indices.save(buffer := io.BytesIO(), kind)
        files.append((255, buffer.getvalue()))
    files += [(65535, pillow(two_stones(7, 65535, np.uint16), "PNG"))]
    files += [(top, tiff(two_stones(7, top))) for top in (65535, 70000, 2**32 - 1)]
    for top, data in files:
        assert areas(read_stones(written(tmp_path, data))) == {7: 375, top: 600}


@pytest.mark.parametrize(("depth", "top"), [(1, 1), (2, 3), (4, 15)])
@pytest.mark.parametrize("colour_type", [0, 3])
def test_png_of_few_bits_keeps_its_own_values(depth, top, colour_type):
    # Pillow would stretch grey 2- and 4-bit values to 0 ... 255, and a palette has colours.
    labels = two_stones(1, top, np.uint8)
    values = decode(png(labels, depth, colour_type), LIMIT).values
    np.testing.assert_array_equal(values, labels)


def with_last(values, last):
    return np.concatenate([np.atleast_3d(values), np.atleast_3d(last)], axis=-1)


def written(folder, data):
    (folder / "a.any").write_bytes(data)
    return folder / "a.any"


def test_colours_are_ids_unless_they_have_16_bits_and_are_no_greys(tmp_path):
    stones = read_stones(written(tmp_path, pillow(colours(two_stones()), "PNG")))
    assert areas(stones) == {300: 375, 70000: 600}
    (notice,) = stones.notices
    assert notice.code == "W115"
    assert "3 colours read as ids R + 256 G + 65536 B: 2 stones." in notice.message
    values = np.dstack([two_stones(7, 300, np.uint16)] * 3)
    assert areas(read_stones(values)) == {7: 375, 300: 600}
    values[0, 0, 0] = 9
    with pytest.raises(InputError, match=r"E108.*outside 0 ... 255"):
        read_stones(values)


def test_arrays_and_npy(tmp_path):
    for array in (
        two_stones(), two_stones().astype(np.int64), two_stones().astype(np.float64),
        np.asfortranarray(two_stones()), two_stones()[None], two_stones()[:, :, None],
        two_stones().astype(">u4"), two_stones().astype(np.uint64), colours(two_stones()),
    ):  # fmt: skip
        np.save(tmp_path / "a.npy", array)
        for source in (array, tmp_path / "a.npy", str(tmp_path / "a.npy")):
            stones = read_stones(source)
            assert areas(stones) == {300: 375, 70000: 600}
            assert (stones.source.width_px, stones.source.height_px) == (60, 40)


def test_source_names_the_bytes(tmp_path):
    path = written(tmp_path, pillow(two_stones(7, 9, np.uint8), "PNG"))
    source = read_stones(path).source
    assert source.path == "a.any"
    assert source.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    array = two_stones()
    digests = {read_stones(a).source.sha256 for a in (array, array.astype(np.int64), array[:, :59])}
    assert len(digests) == 3
    assert read_stones(array).source.sha256 == read_stones(array.copy()).source.sha256


NOISY = np.random.default_rng(0).integers(0, 9, (60, 60)).astype(np.uint8)
TWO = np.stack([NOISY, NOISY])
PAGES = {"save_all": True, "append_images": [Image.fromarray(NOISY[::-1])]}
HEIGHTS = [struct.pack("<HHII", 257, 4, 1, height) for height in (60, 99)]


def test_files_that_are_refused_for_their_bytes_their_absence_or_a_limit(tmp_path):
    for data, text in (
        (b"", "E106 a.png: .*0 bytes"),
        (b"%PDF-1.7", "E107 a.png: .*PNG, TIFF, BMP, GIF, NPY, NPZ; JSON"),
        (b"PK\x03\x04...", "E107 a.png: .*PNG"),
        *((pillow(NOISY, kind)[:-size], "E106 a.png: .*damaged or cut short")
          for kind in ("PNG", "BMP", "GIF", "TIFF") for size in (300, 1000)),
        (png_of(8, 6, 1, 0, bytes(5 * 2)), "E106 .*all of its rows"),
        (png_of(8, 6, 2, 3, bytes(5 * 3), bytes(12)), "E106 .*all of its rows"),
        (png_of(8, 6, 16, 0, bytes(5 * 17)), "E106 .*all of its rows"),
        (png_of(8, 6, 8, 6, bytes(5 * 33)), "E106 .*all of its rows"),
        (tiff(NOISY, compression="deflate").replace(*HEIGHTS), "E106 .*all of its strips"),
        (npy(NOISY)[:-1], "E106"),
        (npy(NOISY)[:20], "E106"),
        (npy(np.array([{}, {}])), "E107.*pickle"),
        (png_of(2, 2, 16, 2, bytes(26)), "E107.*16 bits a colour channel"),  # and not halved
        *((data, "E109.*where one picture is needed") for data in (
            pillow(NOISY, "GIF", **PAGES), pillow(NOISY, "TIFF", **PAGES),
            tiff(TWO, photometric="minisblack"), npy(TWO))),
        (png_of(100_000, 50_000, 8, 0, bytes(9)), r"E110.*100000 x 50000 px are 5000 million.*200 "
         r"million.*crop it; only in Python .* raised \(max_image_mpx\)\.$"),
    ):  # fmt: skip
        (tmp_path / "a.png").write_bytes(data)
        with pytest.raises(InputError, match=text) as caught:
            read_stones(tmp_path / "a.png")
        assert caught.value.where == "a.png"
    with pytest.raises(InputError, match=r"E100.*no such file"):
        read_stones(tmp_path / "b.png")
    for data in (tiff(NOISY), pillow(NOISY, "BMP"), npy(NOISY)):
        with pytest.raises(InputError, match=r"E110"):
            read_stones(written(tmp_path, data), settings=ReadSettings(max_image_mpx=0.001))


def test_pictures_beyond_pillows_guard_are_read(monkeypatch):
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 100)
    data = pillow(two_stones(7, 9, np.uint8), "PNG")
    assert decode(data, LIMIT).values.shape == (40, 60)
    with pytest.raises(Image.DecompressionBombError):
        Image.open(io.BytesIO(data))


MASKS = np.stack([two_stones() == 300, two_stones() == 70000], axis=-1)
FULL = np.full((40, 60, 1), 255, np.uint8)


def upright(values, orientation):
    """The picture as a program shows it that follows its orientation."""
    image = Image.fromarray(values.astype(np.int32), "I")
    image.getexif()[274] = orientation
    return np.asarray(ImageOps.exif_transpose(image))


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("dtype", [bool, np.uint8, np.int32])
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
    values = mask if kind == "JPEG" else np.dstack([mask, alpha])
    picture = decode(pillow(values, kind, exif=held(orientation)), LIMIT)
    np.testing.assert_array_equal(picture.values > 127, upright(mask, orientation) > 0)
    if kind == "PNG":
        np.testing.assert_array_equal(picture.alpha, upright(alpha, orientation))


ONE = two_stones() == 300


def test_a_last_channel_is_alpha_and_refused_where_it_may_be_a_stone(tmp_path):
    for values in (
        MASKS,
        MASKS.astype(np.uint8) * np.uint8(255),
        with_last(two_stones(7, 9, np.uint8), ONE * np.uint8(255)),
        with_last(colours(two_stones()), ONE * np.uint8(255)),
        np.stack([ONE, ~ONE, ONE, ~ONE], -1),
    ):
        np.save(tmp_path / "two.npy", values)
        np.savez(tmp_path / "two.npz", values)
        for source in (values, tmp_path / "two.npy", tmp_path / "two.npz"):
            with pytest.raises(InputError, match=r"E109.*not transparency.*one channel.*a folder"):
                read_stones(source)
    seen = two_stones() > 0
    channels = (FULL, FULL * 0, seen * np.uint8(255), seen)
    for labels, alpha in product((two_stones(), colours(two_stones())), channels):
        assert areas(read_stones(with_last(labels, alpha))) == {300: 375, 70000: 600}


GREY = two_stones(8, 255, np.uint8)
NOISE = np.random.default_rng(1).integers(1, 256, (40, 60), dtype=np.uint8)
ERASED = (GREY != 8) * np.uint8(255)  # the colours of stone 8 are there, under alpha 0
SOFT = np.round(ndimage.gaussian_filter((GREY > 0) * 255.0, 1)).astype(np.uint8)


def with_alpha(folder, kind, values, alpha):
    """A file of grey values with alpha: a channel, or an entry of the palette that is clear."""
    image, options = Image.fromarray(values), {}
    if kind in CHANNELS:
        channels = [values] * (1 if kind == "L" else 3)
        image = Image.fromarray(np.dstack([*channels, alpha]))
        options = {"compression": "tiff_lzw"} if kind == "lzw" else {}
    else:
        if kind in ("P", "GIF"):
            image.putpalette([i // 3 for i in range(768)])
        elif kind == "16":
            image = Image.fromarray(values.astype(np.uint16))
        options = {"transparency": int(values[alpha == 0].max()), "optimize": False}
    form = {"TIFF": "TIFF", "lzw": "TIFF", "GIF": "GIF"}.get(kind, "PNG")
    image.save(folder / "a.any", form, **options)
    return folder / "a.any"


CHANNELS = ["L", "RGB", "TIFF", "lzw"]
NO_MASK = ReadSettings(mask=False)


@pytest.mark.parametrize("kind", [*CHANNELS, "P", "GIF", "16", "8"])
def test_a_transparent_pixel_is_background_whatever_its_colour(tmp_path, kind):
    path = with_alpha(tmp_path, kind, GREY, ERASED)
    stones = read_stones(path, settings=NO_MASK)
    assert areas(stones) == {255: 600}
    assert codes(stones) == ["W135"]
    assert "375 px are transparent, whatever their colour" in str(stones.notices[0])
    wall = read_wall(path)
    np.testing.assert_array_equal(wall.labels, GREY * (ERASED > 0))
    assert codes(wall) == ["W135"]


@pytest.mark.parametrize("kind", CHANNELS)
def test_alpha_that_hides_no_stone_changes_nothing(tmp_path, kind):
    for alpha in (NOISE, FULL[..., 0], (GREY > 0) * np.uint8(255), GREY * 0):
        path = with_alpha(tmp_path, kind, GREY, alpha)
        stones = read_stones(path)
        assert areas(stones) == {8: 375, 255: 600}
        assert codes(stones) == ([] if alpha.any() else ["W174"])
        np.testing.assert_array_equal(read_wall_image(path), GREY)


@pytest.mark.parametrize("kind", CHANNELS)
@pytest.mark.parametrize(("colour", "under"), [(0, 0), (90, 90), (255, 0)])
def test_a_mask_that_lives_in_alpha(tmp_path, kind, colour, under):
    for alpha in ((GREY > 0) * np.uint8(255), (GREY > 0) * np.uint8(1), SOFT):
        values = np.where(alpha > 0, colour, under).astype(np.uint8)
        stones = read_stones(with_alpha(tmp_path, kind, values, alpha))
        assert len(stones) == 2
        assert stones.total_area_px == ((SOFT >= 128) if alpha is SOFT else (alpha > 0)).sum()
        assert "W114" in codes(stones)


@pytest.mark.parametrize("kind", CHANNELS)
def test_a_photograph_that_was_cut_out_is_read_by_its_alpha(tmp_path, kind):
    for alpha, under in product(((GREY > 0) * np.uint8(255), SOFT), (0, NOISE)):
        path = with_alpha(tmp_path, kind, np.where(alpha > 0, NOISE, under).astype(np.uint8), alpha)
        stones = read_stones(path)
        assert len(stones) == 2
        assert stones.total_area_px == (alpha >= 128).sum()
        assert codes(stones)[-2:] == ["W135", "W114"]
        assert "alpha was read in place" in said(stones)
        for read in (read_wall_image, lambda path: read_stones(path, settings=NO_MASK)):
            with pytest.raises(InputError, match="E102"):
                read(path)
    round_corners, fading = FULL[..., 0].copy(), np.tile(np.linspace(0, 255, 60), (40, 1))
    round_corners[[0, 0, -1, -1], [0, -1, 0, -1]] = 0
    for alpha in (FULL[..., 0], 0 * FULL[..., 0], round_corners, fading.astype(np.uint8)):
        with pytest.raises(InputError, match="E102"):
            read_stones(with_alpha(tmp_path, kind, NOISE, alpha))


def test_a_photograph_that_was_turned_is_no_stone(tmp_path):
    """Large stones have no four straight sides."""
    y, x = np.mgrid[-200:200, -300:300]
    noise = np.random.default_rng(1).integers(0, 256, (400, 600), np.uint8)
    across, up = abs(x + y / 8) / 250, abs(y - x / 8) / 150
    turned = with_alpha(tmp_path, "RGB", noise, (np.maximum(across, up) < 1) * np.uint8(255))
    with pytest.raises(InputError, match="E102"):
        read_stones(turned)
    stone = with_alpha(tmp_path, "RGB", noise, (across**4 + up**4 < 1) * np.uint8(255))
    assert codes(read_stones(stone))[0] == "W135"


def test_a_stone_of_0_on_a_transparent_ground_is_refused(tmp_path):
    values = np.select([GREY == 8, GREY == 255], [0, 5], 9).astype(np.uint8)
    with pytest.raises(InputError, match=r"E108 a.any: 375 px are 0 .*add 1"):
        read_stones(with_alpha(tmp_path, "P", values, (values != 9) * 255))


def test_an_extra_channel_of_a_tiff_is_alpha_only_where_it_says_so(tmp_path):
    values, options = MASKS.astype(np.uint8) * np.uint8(255), {"photometric": "minisblack"}
    options["planarconfig"] = "contig"
    stones = read_stones(written(tmp_path, tiff(values, extrasamples=["unassalpha"], **options)))
    # All that can be seen is 0 where the other mask is 255.
    assert areas(stones) == {1: 600}
    assert codes(stones) == ["W135", "W114"]
    with pytest.raises(InputError, match=r"E109 a.any: the last channel"):
        read_stones(written(tmp_path, tiff(values, extrasamples=["unspecified"], **options)))


def test_colours_that_hold_no_ids(tmp_path):
    for kind, mode in (*product(["TIFF", "lzw"], ["CMYK", "LAB", "YCbCr"]), ("JPEG", "CMYK")):
        image = Image.fromarray(colours(two_stones()))
        image = Image.new("LAB", image.size, (3, 3, 3)) if mode == "LAB" else image.convert(mode)
        options = {"compression": "tiff_lzw"} if kind == "lzw" else {}
        image.save(tmp_path / "a.any", "TIFF" if kind == "lzw" else kind, **options)
        with pytest.raises(InputError, match=rf"E107 a.any: .* mode {mode} does not hold ids"):
            read_stones(tmp_path / "a.any")
