"""TIFF of every depth, compression, layout and predictor gives the numbers that were written."""

import io
import struct
import zlib
from itertools import product

import numpy as np
import pytest
import tifffile
from PIL import Image

from drystone.errors import InputError
from drystone.io.images import decode
from drystone.io.read_stones import read_stones
from tests.io.pictures import areas, codes, two_stones
from tests.io.test_formats import LIMIT

NONE, LZW, DEFLATE, PACKBITS = 1, 5, 8, 32773
REVERSED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))
KINDS = {(3, 16): "f2", (3, 32): "f4", (3, 64): "f8", (2, 8): "i1", (2, 16): "i2", (2, 32): "i4"}


def packed(rows, bits, order, sample=1):
    """Numbers of a strip, each row beginning with a byte of its own."""
    if bits in (8, 16, 32, 64):
        return rows.astype(np.dtype(KINDS.get((sample, bits), f"u{bits // 8}")).newbyteorder(order))
    bit = rows[..., None].astype(int) >> np.arange(bits)[::-1] & 1
    return np.packbits(bit.reshape(len(rows), -1).astype(np.uint8), axis=1)


def predicted(rows, bits, order, predictor, sample):
    """What a predictor makes of numbers, (rows, width, channels), and their bytes."""
    if predictor == 2:
        steps = rows.astype(np.int64).copy()
        steps[:, 1:] -= rows.astype(np.int64)[:, :-1]
        rows = steps
    if predictor == 3:
        planes = np.ascontiguousarray(rows.astype(f">f{bits // 8}")).view(np.uint8)
        planes = planes.reshape(len(rows), -1, bits // 8).swapaxes(1, 2)
        steps = planes.reshape(len(rows), -1, rows.shape[2]).copy()
        steps[:, 1:] -= steps[:, :-1].copy()
        return steps.reshape(len(rows), -1)
    return packed(rows.reshape(len(rows), -1), bits, order, sample)


def coded(table, compression, *, reverse):
    """The bytes of a strip as a compression stores them."""
    data = np.ascontiguousarray(table).tobytes()
    if compression == DEFLATE:
        data = zlib.compress(data)
    if compression == PACKBITS:
        data = b"".join(bytes([min(len(data) - i, 128) - 1]) + data[i : i + 128]
                        for i in range(0, len(data), 128))  # fmt: skip
    if compression == LZW:
        image = Image.fromarray(np.frombuffer(data, np.uint8).reshape(len(table), -1))
        image.save(
            buffer := io.BytesIO(), "TIFF", compression="tiff_lzw", tiffinfo={278: len(table)}
        )
        page = tifffile.TiffFile(io.BytesIO(buffer.getvalue())).pages[0]
        data = buffer.getvalue()[page.dataoffsets[0] :][: page.databytecounts[0]]
    if reverse:
        data = data.translate(REVERSED)
    return data


def tiff(values, bits=8, compression=NONE, *, order="<", sample=1, predictor=1, tile=None,
         rows=None, planar=False, reverse=False, photometric=1, sparse=(), tags=(),
         big=False, following=0):  # fmt: skip
    """The bytes of a TIFF, or of a BigTIFF; strips whose number is in `sparse` are not in it.

    `following` is where the directory of the next page is said to be.
    """
    start, word, room, entry = (16, "Q", 8, 20) if big else (8, "I", 4, 12)
    values = values.reshape(*values.shape[:2], -1)
    height, width, channels = values.shape
    down, across = (tile, tile) if tile else (rows or height, width)
    planes = [values[..., i : i + 1] for i in range(channels)] if planar else [values]
    pieces = []
    for plane, top, left in product(planes, range(0, height, down), range(0, width, across)):
        part = plane[top : top + down, left : left + across]
        if tile:
            part = np.pad(part, [(0, tile - part.shape[0]), (0, tile - part.shape[1]), (0, 0)])
        table = predicted(part, bits, order, predictor, sample)
        missing = len(pieces) in sparse
        pieces.append(b"" if missing else coded(table, compression, reverse=reverse))
    sizes = list(map(len, pieces))
    ends = start + np.cumsum(sizes)
    offsets = [int(end - size) if size else 0 for end, size in zip(ends, sizes, strict=True)]
    where = {278: [down], 273: offsets, 279: sizes}
    if tile:
        where = {322: [tile], 323: [tile], 324: offsets, 325: sizes}
    found = {
        256: [width], 257: [height], 258: [bits] * channels, 259: [compression],
        262: [photometric if channels == 1 else 2], 277: [channels], 284: [2 if planar else 1],
        317: [predictor], 339: [sample] * channels, 266: [2 if reverse else 1],
        **where, **dict(tags),
    }  # fmt: skip
    body = b"".join(pieces)
    body += b"\0" * (len(body) % 2)
    first = start + len(body)
    number = struct.pack(order + ("Q" if big else "H"), len(found))
    extra, entries, place = b"", b"", first + len(number) + entry * len(found) + room
    for tag, numbers in sorted(found.items()):
        kind, count, data = 2, len(numbers), numbers
        if not isinstance(numbers, bytes):
            kind, data = 4, struct.pack(f"{order}{count}I", *numbers)
        if len(data) > room:
            data, extra = struct.pack(order + word, place + len(extra)), extra + data
        entries += struct.pack(f"{order}HH{word}", tag, kind, count) + data.ljust(room, b"\0")
    marks = [43, 8, 0] if big else [42]
    head = struct.pack(f"{order}2s{len(marks)}H{word}", b"II" if order == "<" else b"MM",
                       *marks, first)  # fmt: skip
    return head + body + number + entries + struct.pack(order + word, following) + extra


def labels(bits):
    """Ids up to the largest that the depth holds, in a picture whose rows end within a byte."""
    return two_stones(1, 2 ** min(bits, 16) - 1, np.int64)[:, :59]


LAYOUTS = [{}, {"rows": 7, "big": True}, {"tile": 16}]
packings = pytest.mark.parametrize("compression", [NONE, LZW, DEFLATE, PACKBITS])


def read_back(values, bits, compression, **choices):
    """Write and read numbers in all layouts, orders of bytes and combinations of choices."""
    for layout, *chosen in product(LAYOUTS, *choices.values()):
        options = layout | dict(zip(choices, chosen, strict=True))
        found = decode(tiff(values, bits, compression, **options), LIMIT).values
        found = found if found.dtype.kind == "f" else found.astype(np.int64)
        np.testing.assert_array_equal(found, values.squeeze(), err_msg=str(options))


@packings
@pytest.mark.parametrize("bits", [1, 2, 4, 6, 8, 12, 16, 32])
def test_whole_numbers(bits, compression):
    read_back(
        labels(bits), bits, compression, order="<>", reverse=(False, True), photometric=(0, 1)
    )


@packings
@pytest.mark.parametrize(("bits", "channels"), [(8, 1), (16, 1), (32, 1), (8, 3), (16, 3)])
def test_differences(bits, compression, channels):
    values = np.dstack([labels(bits), labels(bits) // 2, labels(bits) // 3])[..., :channels]
    read_back(values, bits, compression, order="<>", planar=(False, True), predictor=[2])


@packings
@pytest.mark.parametrize("bits", [16, 32, 64])
def test_numbers_with_a_point(bits, compression):
    read_back(labels(8) + 0.5, bits, compression, order="<>", predictor=(1, 3), sample=[3])


@packings
@pytest.mark.parametrize("bits", [1, 4, 8, 16])
def test_what_a_sparse_file_leaves_out_is_ground(tmp_path, bits, compression):
    values = two_stones(1, 1, np.int64)
    values[:16] = 0  # two strips or four tiles
    for layout, missing, said in ((LAYOUTS[1], 2, "2 of 6"), (LAYOUTS[2], 4, "4 of 12")):
        data = tiff(values, bits, compression, sparse=range(missing), **layout)
        (tmp_path / "a.tif").write_bytes(data)
        np.testing.assert_array_equal(decode(data, LIMIT).values, values)
        stones = read_stones(tmp_path / "a.tif")
        assert stones.total_area_px == values.sum()
        assert f"{said} strips or tiles are not in the file (sparse)" in str(stones.notices[0])


def test_no_data_of_gdal_is_ground(tmp_path):
    def read(ground, bits, sample, said):
        values = np.where(two_stones() == 0, ground, two_stones(3, 7, np.int64))
        values[0, 0] = 0
        data = tiff(values, bits, DEFLATE, rows=5, sample=sample, tags={42113: said + b"\0"})
        (tmp_path / "a.tif").write_bytes(data)
        return read_stones(tmp_path / "a.tif")

    for case in ((-9999, 32, 3, b"-9999"), (-9999, 16, 2, b"-9999"), (200, 8, 1, b"200 ")):
        stones = read(*case)
        assert areas(stones) == {3: 375, 7: 600}
        assert codes(stones) == ["W135"]
        assert f"1424 px are {case[0]}, which the file says is no data" in str(stones.notices[0])
    with pytest.raises(InputError, match=r"E105 .*value 9 fills"):
        read(9, 8, 1, b"nan")  # no whole number is


def test_what_cannot_be_read_is_refused():
    for bits, options, text in (
        (4, {"predictor": 2}, r"E107 .*predictor 2 of 4 bits"),
        (8, {"tags": {317: [3]}}, r"E107 .*predictor 3 of 8 bits"),
        (8, {"tags": {317: [34892]}}, r"E107 .*predictor 34892"),
        (8, {"tags": {279: [50]}}, r"E106 .*too short"),
        (4, {"tags": {257: [90], 278: [90]}}, r"E106 .*too short"),
    ):
        with pytest.raises(InputError, match=text):
            decode(tiff(labels(bits), bits, **options), LIMIT)
