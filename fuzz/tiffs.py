"""TIFF of every depth, compression, layout and predictor, which no other writer makes."""

import io
import struct
import zlib
from collections.abc import Container, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image

Array = NDArray[Any]

NONE, LZW, DEFLATE, PACKBITS = 1, 5, 8, 32773
_REVERSED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))
_KINDS = {(3, 16): "f2", (3, 32): "f4", (3, 64): "f8", (2, 8): "i1", (2, 16): "i2", (2, 32): "i4"}
"""By the kind of sample and its bits; all others are whole numbers without a sign."""


def write_tiff(  # noqa: PLR0913 - one for each choice of the format
    values: Array,
    bits: int = 8,
    compression: int = NONE,
    *,
    order: str = "<",
    sample: int = 1,
    predictor: int = 1,
    tile: int | None = None,
    rows: int | None = None,
    planar: bool = False,
    reverse: bool = False,
    photometric: int = 1,
    sparse: Container[int] = (),
    tags: Mapping[int, Sequence[int] | bytes] | None = None,
    big: bool = False,
    following: int = 0,
) -> bytes:
    """Return the bytes of a TIFF, or of a BigTIFF.

    Strips or tiles whose number is in `sparse` are not in it.  `tags` replace or add some.
    `following` is where the directory of the next page is said to be.
    """
    start, word, room, entry = (16, "Q", 8, 20) if big else (8, "I", 4, 12)
    values = values.reshape(*values.shape[:2], -1)
    height, width, channels = values.shape
    down, across = (tile, tile) if tile else (rows or height, width)
    planes = [values[..., i : i + 1] for i in range(channels)] if planar else [values]
    pieces: list[bytes] = []
    for plane, top, left in product(planes, range(0, height, down), range(0, width, across)):
        part = plane[top : top + down, left : left + across]
        if tile:
            part = np.pad(part, [(0, tile - part.shape[0]), (0, tile - part.shape[1]), (0, 0)])
        table = _predicted(part, bits, order, predictor, sample)
        missing = len(pieces) in sparse
        pieces.append(b"" if missing else _coded(table, compression, reverse=reverse))
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
        **where, **(tags or {}),
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


def _predicted(rows: Array, bits: int, order: str, predictor: int, sample: int) -> Array:
    """Return what a predictor makes of numbers, (rows, width, channels), and their bytes."""
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
    rows = rows.reshape(len(rows), -1)
    if bits in (8, 16, 32, 64):
        return rows.astype(
            np.dtype(_KINDS.get((sample, bits), f"u{bits // 8}")).newbyteorder(order)
        )
    # Each row begins with a byte of its own.
    bit = rows[..., None].astype(int) >> np.arange(bits)[::-1] & 1
    return np.packbits(bit.reshape(len(rows), -1).astype(np.uint8), axis=1)


def _coded(table: Array, compression: int, *, reverse: bool) -> bytes:
    """Return the bytes of a strip as a compression stores them."""
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
        page = tifffile.TiffFile(io.BytesIO(buffer.getvalue())).pages[0]  # noqa: TID251 - our own
        data = buffer.getvalue()[page.dataoffsets[0] :][: page.databytecounts[0]]
    return data.translate(_REVERSED) if reverse else data
