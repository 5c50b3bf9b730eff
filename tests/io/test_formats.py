"""Every format that stones are read from keeps ids and pixels."""

import hashlib
import io
import struct

import numpy as np
import pytest
import tifffile
from PIL import Image

from drystone.errors import InputError
from drystone.io.images import decode
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas, codes, png_of, two_stones

LIMIT = 10**6


def png(values, depth, colour_type):
    """A PNG of values below 2 ** depth."""
    height, width = values.shape[:2]
    bits = np.unpackbits(values.astype(np.uint8)[..., None], axis=2)[..., 8 - depth :]
    lines = np.packbits(bits.reshape(height, -1), axis=1)
    palette = bytes(range(3 * 2**depth)) if colour_type == 3 else b""
    body = b"".join(b"\0" + line.tobytes() for line in lines)
    return png_of(width, height, depth, colour_type, body, palette)


def pillow(values, kind, mode=None, **options):
    buffer = io.BytesIO()
    Image.fromarray(values, mode).save(buffer, kind, **options)
    return buffer.getvalue()


def tiff(values, **options):
    buffer = io.BytesIO()
    tifffile.imwrite(buffer, values, **options)
    return buffer.getvalue()


PICTURES = [
    # GIF: keep unused colours
    *((255, lambda a, k=kind: pillow(a.astype(np.uint8), k, optimize=False))
      for kind in ("PNG", "TIFF", "BMP", "GIF")),
    *((65535, write) for write in (lambda a: pillow(a.astype(np.uint16), "PNG"), tiff)),
    *((top, tiff) for top in (70000, 2**32 - 1)),
]  # fmt: skip


@pytest.mark.parametrize(("top", "write"), PICTURES)
def test_ids_of_8_16_and_32_bits_survive(tmp_path, top, write):
    (tmp_path / "stones.any").write_bytes(write(two_stones(7, top)))
    assert areas(read_stones(tmp_path / "stones.any")) == {7: 375, top: 600}


@pytest.mark.parametrize(("depth", "top"), [(1, 1), (2, 3), (4, 15)])
@pytest.mark.parametrize("colour_type", [0, 3])
def test_png_of_few_bits_keeps_its_own_values(depth, top, colour_type):
    # Pillow would stretch grey 2- and 4-bit values to 0 ... 255, and a palette has colours.
    labels = two_stones(1, top, np.uint8)
    values = decode(png(labels, depth, colour_type), LIMIT).values
    np.testing.assert_array_equal(values, labels)


def test_palette_picture_gives_indices_not_colours(tmp_path):
    image = Image.fromarray(two_stones(1, 2, np.uint8))
    image.putpalette([0, 0, 0, 9, 9, 9, 9, 9, 9])  # both stones look the same
    for suffix in ("png", "tif", "bmp"):
        image.save(tmp_path / f"p.{suffix}")
        assert areas(read_stones(tmp_path / f"p.{suffix}")) == {1: 375, 2: 600}


def rgb(labels):
    return np.stack([labels >> shift & 255 for shift in (0, 8, 16)], axis=-1).astype(np.uint8)


@pytest.mark.parametrize("alpha", [None, 255, 0])
def test_colours_are_ids_and_alpha_is_ignored(tmp_path, alpha):
    values = rgb(two_stones())
    if alpha is not None:
        values = np.dstack([values, np.full(values.shape[:2], alpha, np.uint8)])
    Image.fromarray(values).save(tmp_path / "rgb.png")
    stones = read_stones(tmp_path / "rgb.png")
    assert areas(stones) == {300: 375, 70000: 600}
    assert codes(stones) == (["W174", "W115"] if alpha == 0 else ["W115"])
    assert "3 colours" in stones.notices[-1].message
    assert "2 stones" in stones.notices[-1].message


@pytest.mark.parametrize(
    "array",
    [
        two_stones(),
        two_stones().astype(np.int64),
        two_stones().astype(np.float64),
        np.asfortranarray(two_stones()),
        two_stones()[None],
        two_stones()[:, :, None],
        two_stones().astype(">u4"),
        rgb(two_stones()),
    ],
)
def test_arrays_and_npy(tmp_path, array):
    np.save(tmp_path / "a.npy", array)
    for source in (array, tmp_path / "a.npy", str(tmp_path / "a.npy")):
        stones = read_stones(source)
        assert areas(stones) == {300: 375, 70000: 600}
        assert (stones.source.width_px, stones.source.height_px) == (60, 40)


def test_source_names_the_bytes(tmp_path):
    path = tmp_path / "stones.png"
    path.write_bytes(pillow(two_stones(7, 9, np.uint8), "PNG"))
    source = read_stones(path).source
    assert source.path == "stones.png"
    assert source.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    array = two_stones()
    digests = {read_stones(a).source.sha256 for a in (array, array.astype(np.int64), array[:, :59])}
    assert len(digests) == 3
    assert read_stones(array).source.sha256 == read_stones(array.copy()).source.sha256


@pytest.mark.parametrize("kind", ["PNG", "BMP", "GIF", "TIFF"])
@pytest.mark.parametrize("kept", [0.3, 0.9])
def test_truncated_files(tmp_path, kind, kept):
    rng = np.random.default_rng(0)
    data = pillow(rng.integers(0, 9, (60, 60)).astype(np.uint8), kind)
    path = tmp_path / "a.png"
    path.write_bytes(data[: int(kept * len(data))])
    with pytest.raises(InputError, match=r"E106.*damaged or cut short") as caught:
        read_stones(path)
    assert caught.value.where == "a.png"


@pytest.mark.parametrize(
    ("depth", "colour_type"), [(1, 0), (2, 3), (8, 0), (16, 0), (8, 2), (8, 6)]
)
def test_a_png_that_ends_before_its_last_row_is_damaged(tmp_path, depth, colour_type):
    row = 8 * depth * {0: 1, 2: 3, 3: 1, 6: 4}[colour_type] // 8
    palette = bytes(3 * 2**depth) if colour_type == 3 else b""
    data = png_of(8, 6, depth, colour_type, bytes(1 + row) * 5, palette)
    (tmp_path / "a.png").write_bytes(data)
    with pytest.raises(InputError, match=r"E106 .*all of its rows"):
        read_stones(tmp_path / "a.png")


def test_a_tiff_that_lacks_a_strip_is_damaged(tmp_path):
    data = tiff(np.ones((5, 7), np.uint8), compression="deflate")
    height = data.index(struct.pack("<H", 257))
    (tmp_path / "a.tif").write_bytes(
        data[: height + 8] + struct.pack("<H", 50) + data[height + 10 :]
    )
    with pytest.raises(InputError, match=r"E106 .*all of its strips"):
        read_stones(tmp_path / "a.tif")


def test_empty_and_missing_files(tmp_path):
    (tmp_path / "a.png").write_bytes(b"")
    with pytest.raises(InputError, match=r"E106.*0 bytes"):
        read_stones(tmp_path / "a.png")
    with pytest.raises(InputError, match=r"E100.*no such file"):
        read_stones(tmp_path / "b.png")


@pytest.mark.parametrize("content", [b"%PDF-1.7", b"PK\x03\x04...", b"hello"])
def test_unknown_formats_name_the_known_ones(tmp_path, content):
    path = tmp_path / "stones.any"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"E107.*PNG, TIFF, BMP, GIF, NPY, NPZ; JSON"):
        read_stones(path)


def test_damaged_npy():
    buffer = io.BytesIO()
    np.save(buffer, two_stones())
    for data in (buffer.getvalue()[:-1], buffer.getvalue()[:20]):
        with pytest.raises(InputError, match=r"E106"):
            decode(data, LIMIT)
    np.save(buffer := io.BytesIO(), np.array([{}, {}]), allow_pickle=True)
    with pytest.raises(InputError, match=r"E107.*pickle"):
        decode(buffer.getvalue(), LIMIT)


def test_16_bit_colour_png_is_refused_not_halved():
    with pytest.raises(InputError, match=r"E107.*16 bits a colour channel"):
        decode(png_of(2, 2, 16, 2, bytes(26)), LIMIT)


def test_16_bit_colour_tiff():
    values = np.dstack([two_stones(7, 300, np.uint16)] * 3)
    found = decode(tiff(values, photometric="rgb"), LIMIT).values
    assert areas(read_stones(found)) == {7: 375, 300: 600}
    values[0, 0, 0] = 9
    with pytest.raises(InputError, match=r"E108.*outside 0 ... 255"):
        read_stones(values)


def test_several_pages(tmp_path):
    stack = np.stack([two_stones()] * 2)
    frames = [Image.fromarray(two_stones(i, 9, np.uint8)) for i in (5, 7)]
    frames[0].save(tmp_path / "a.gif", save_all=True, append_images=frames[1:])
    frames[0].save(tmp_path / "a.tif", save_all=True, append_images=frames[1:])
    tifffile.imwrite(tmp_path / "b.tif", stack, photometric="minisblack")
    np.save(tmp_path / "a.npy", stack)
    for source in (*(tmp_path / n for n in ("a.gif", "a.tif", "b.tif", "a.npy")), stack):
        with pytest.raises(InputError, match=r"E109.*where one picture is needed"):
            read_stones(source)


def test_huge_pictures_are_refused_before_decoding_and_the_limit_is_a_setting(tmp_path):
    path = tmp_path / "a.png"
    path.write_bytes(png_of(100_000, 50_000, 8, 0, bytes(9)))
    with pytest.raises(InputError, match=r"E110.*100000 x 50000 px are 5000 million.*200 million"):
        read_stones(path)
    with pytest.raises(InputError, match=r"crop it; only in Python .* raised \(max_image_mpx\)\.$"):
        read_stones(path)
    for name in ("b.tif", "b.npy", "b.bmp"):
        target = tmp_path / name
        small = two_stones(7, 9, np.uint8)
        np.save(target, small) if name == "b.npy" else Image.fromarray(small).save(target)
        with pytest.raises(InputError, match=r"E110"):
            read_stones(target, settings=ReadSettings(max_image_mpx=0.001))


def test_pictures_beyond_pillows_guard_are_read(monkeypatch):
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 100)
    data = pillow(two_stones(7, 9, np.uint8), "PNG")
    assert decode(data, LIMIT).values.shape == (40, 60)
    with pytest.raises(Image.DecompressionBombError):
        Image.open(io.BytesIO(data))


def test_what_reading_was_told_is_kept_with_the_source():
    labels = np.full((40, 60), 255, np.uint32)
    labels[5:25, 5:30] = 3
    labels[5:25, 35:55] = 4
    plain = read_stones(np.where(labels == 255, 0, labels))
    assert plain.source.reading == ()
    told = read_stones(labels, settings=ReadSettings(background=255, skip=(4,)))
    assert dict(told.source.reading) == {"background": 255, "skip": [4]}
    assert [stone.id for stone in told] == [3]
