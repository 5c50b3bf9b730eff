"""TIFF pages to values: tifffile reads the tags, and what it needs further packages for is here.

Strips and tiles are unpacked one by one, each within the size that the tags give it.
"""

import io
import math
import re
import struct
import zlib
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray

from drystone.io.file_errors import damaged, several_pages
from drystone.io.foreign import foreign
from drystone.io.pictures import opened

_FAX, _DEFLATE = {2, 3, 4}, {8, 32946}
_PACKED = _FAX | _DEFLATE | {5, 32773}
"""Also LZW and PackBits: all but deflate are unpacked by the library behind Pillow."""

_FAX_OPTIONS = (292, 293)

_LOSSY = {6, 7}
"""JPEG."""

_NO_IDS = {5: "CMYK", 6: "YCbCr", 8: "LAB", 9: "LAB", 10: "LAB"}
"""Colours that are neither grey, nor of a palette, nor RGB; JPEG is decoded to RGB."""

_TRANSPARENCY = {1, 2}
"""Extra channels that say of themselves that they are alpha."""

ORIENTATION = 0x0112
"""Tag of EXIF and TIFF: how the camera was held."""

_PLANES = 33629
"""Tag of MetaMorph, of which the number of values is that of planes behind one page."""

TURNS = {
    2: "mirrored left to right", 3: "turned by 180 degrees", 4: "mirrored top to bottom",
    5: "mirrored and turned", 6: "turned by 90 degrees clockwise", 7: "mirrored and turned",
    8: "turned by 90 degrees counter-clockwise",
}  # fmt: skip
"""What is done to a picture of an orientation."""

TURNED_BACK = {6: 8, 8: 6}
"""Orientations that another one takes back; all others are their own opposite."""

_NODATA = 42113
"""Tag of GDAL: the number that stands for nothing."""

_REVERSED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))
"""Bytes with their bits in the other order."""

_MOST_PAGES = 10_000
_MOST_BYTES_A_PX = 8
_ROOM = 2**26
"""Bytes that tiles may have beyond those of the picture."""

_BLOCK_PX = 2**20
"""Numbers of few bits that are made at once."""


@dataclass(frozen=True)
class TiffPage:
    """What must be known before a TIFF is decoded."""

    width: int  # px
    height: int
    lossy: bool  # JPEG inside TIFF
    unreadable: str  # why it cannot be decoded without loss; empty when it can
    colours: str  # colour mode that holds no ids, such as CMYK; empty for all others
    alpha: bool  # the last channel is transparency, and says so
    bits: int  # of a channel
    orientation: int  # how the camera was held, 1 to 8
    negative: bool  # 0 is white
    nodata: float | None  # the number that stands for nothing
    missing: str  # strips that are not in the file, which are ground; empty for none
    page: Any  # of tifffile


def inspect(data: bytes) -> TiffPage:
    """Read the tags of a TIFF and decode nothing."""
    pages = _count_pages(data)
    if pages > 1:
        raise several_pages(f"{pages} pages")
    with foreign(damaged):
        # The variants of microscopes that lead elsewhere aside.
        file = tifffile.TiffFile(  # noqa: TID251 - its chain was followed
            io.BytesIO(data), is_lsm=False, is_ndpi=False, is_scanimage=False
        )
        page: Any = file.pages[0]
        if not all(isinstance(side, int) for side in page.shape):
            raise damaged("a side of it is not a number")
        planes, channels = _planes(page), int(page.samplesperpixel)
        compression, photometric = int(page.compression), int(page.photometric)
        orientation, nothing = page.tags.get(ORIENTATION), page.tags.get(_NODATA)
        nodata = None
        if nothing is not None:
            with suppress(ValueError):
                nodata = float(str(nothing.value).strip("\0 "))
        missing, chunks = sum(count == 0 for count in page.databytecounts), math.prod(page.chunked)
        lossy = compression in _LOSSY
        found = TiffPage(
            width=int(page.imagewidth),
            height=int(page.imagelength),
            lossy=lossy,
            unreadable=_unreadable(page),
            colours="" if lossy and photometric == 6 else _NO_IDS.get(photometric, ""),
            alpha=bool(page.extrasamples) and int(page.extrasamples[-1]) in _TRANSPARENCY,
            bits=int(np.max(page.bitspersample)),
            orientation=1 if orientation is None else int(orientation.value),
            negative=photometric == 0,
            nodata=nodata,
            missing=f"{missing} of {chunks} strips or tiles" if missing else "",
            page=page,
        )
    if planes > 1 or channels > 4:
        said = f"{planes} planes" if planes > 1 else f"{channels} channels"
        raise several_pages(said)
    return found


def values(data: bytes, tags: TiffPage, check: Callable[[int, int], None]) -> NDArray[Any]:
    """Decode the only page of a TIFF, channels last; palette indices and numbers are kept.

    Pixels are where the file has them: its orientation turns nothing here.
    """
    if tags.lossy:
        # Pillow turns a picture when it loads it.
        with opened(data, check) as image:
            orientation = int(image.getexif().get(ORIENTATION, 1))
            return turned(np.asarray(image), TURNED_BACK.get(orientation, orientation))
    with foreign(damaged):
        page = tags.page
        channels, planes = int(page.samplesperpixel), 1
        if int(page.planarconfig) == 2:
            channels, planes = 1, channels
        height, width = int(page.imagelength), int(page.imagewidth)
        rows = int(page.tilelength if page.is_tiled else min(int(page.rowsperstrip), height))
        cols = int(page.tilewidth) if page.is_tiled else width
        if min(rows, cols, height, width, channels) < 1:
            raise damaged("a side of it is 0")
        kind = np.dtype(page.dtype).newbyteorder(page.parent.byteorder)
        row_bytes = -(-cols * channels * int(page.bitspersample) // 8)
        offsets, counts = page.dataoffsets, page.databytecounts
        places = [(int(start), int(n)) for start, n in zip(offsets, counts, strict=False)]
    down, across = math.ceil(height / rows), math.ceil(width / cols)
    if len(places) < down * across * planes:
        raise damaged("it does not hold all of its strips")
    room = down * across * planes * rows * row_bytes
    if room > 2 * planes * height * math.ceil(width / cols) * row_bytes + _ROOM:
        raise damaged("its tiles are larger than the picture")
    if sum(count for _, count in places) > len(data):
        raise damaged("its strips lie in each other")
    found = np.zeros((height, width, planes * channels), kind.newbyteorder("="))
    if tags.nodata is not None:
        limits = np.iinfo(kind) if kind.kind in "iu" else None
        holds = limits and limits.min <= tags.nodata <= limits.max and tags.nodata.is_integer()
        if kind.kind == "f" or holds:
            found[:] = tags.nodata
    for place, (plane, i, j) in enumerate(np.ndindex(planes, down, across)):
        start, count = places[place]
        if not count:  # sparse
            continue
        top, left = i * rows, j * cols
        there = min(rows, height - top)
        piece, high = data[start : start + count], rows if page.is_tiled else there
        with foreign(damaged):
            raw = _unpacked(page, piece, (high, cols, row_bytes))
        if len(raw) < high * row_bytes:
            raise damaged("a strip of it is too short")
        table = np.frombuffer(raw, np.uint8, high * row_bytes).reshape(high, row_bytes)
        chunk = _numbers(page, kind, table, cols * channels, channels).reshape(high, cols, channels)
        part = chunk[:there, : width - left]
        found[top : top + there, left : left + cols, plane : plane + channels] = part
    return found if found.shape[2] > 1 else found[:, :, 0]


def _unpacked(page: Any, piece: bytes, shape: tuple[int, int, int]) -> bytes:
    """Return what a packed strip or tile holds; its rows, px and bytes in a row."""
    rows, width, row_bytes = shape
    compression, order = int(page.compression), int(page.fillorder)
    if compression in _DEFLATE | {1}:
        # 2 has the bits of every byte the other way round.
        piece = piece.translate(_REVERSED) if order == 2 else piece
        if compression == 1:
            return piece
        # As far as it is wanted; what holds far more is refused.
        decoder, want = zlib.decompressobj(), rows * row_bytes
        found = decoder.decompress(piece, want)
        if len(found) == want and len(decoder.decompress(decoder.unconsumed_tail, _ROOM)) == _ROOM:
            raise damaged("its strips are larger than the picture")
        return found
    # A TIFF of one strip, whose bytes are wanted, or bits of fax codes.
    bits = 1 if compression in _FAX else 8
    tags = {256: width if bits == 1 else row_bytes, 257: rows, 258: bits, 259: compression, 262: 1}
    tags |= {266: order, 273: 8, 277: 1, 278: rows, 279: len(piece)}
    tags |= {tag: int(page.tags[tag].value) for tag in _FAX_OPTIONS if tag in page.tags}
    entries = b"".join(struct.pack("<HHII", tag, 4, 1, n) for tag, n in sorted(tags.items()))
    place = 8 + len(piece) + len(piece) % 2
    head = (struct.pack("<2sHI", b"II", 42, place) + piece).ljust(place, b"\0")
    data = head + struct.pack("<H", len(tags)) + entries + b"\0" * 4
    with opened(data, lambda *_: None) as image:
        values = np.asarray(image)
    return bytes((values if bits == 8 else np.packbits(values, axis=1)).data)


def _numbers(
    page: Any, kind: np.dtype[Any], table: NDArray[np.uint8], count: int, channels: int
) -> NDArray[Any]:
    """Return the numbers, `count` a row, that stand in the bytes of rows."""
    rows, bits = len(table), int(page.bitspersample)
    if int(page.predictor) == 3:
        # Differences of bytes, of which those of one rank stand together.
        steps = np.cumsum(table.reshape(rows, -1, channels), axis=1, dtype=np.uint8)
        ranks = steps.reshape(rows, kind.itemsize, -1).swapaxes(1, 2)
        return np.ascontiguousarray(ranks).view(kind.newbyteorder(">"))
    if bits < 8 or bits % 8:
        found = np.empty((rows, count), np.uint8 if bits < 8 else np.uint16)
        weights = (1 << np.arange(bits)[::-1]).astype(found.dtype)
        for top in range(0, rows, step := max(1, _BLOCK_PX // count)):
            part = np.unpackbits(table[top : top + step], axis=1)[:, : bits * count]
            found[top : top + step] = part.reshape(-1, count, bits) @ weights
        return found
    if int(page.predictor) != 2:
        return table.view(kind)
    whole = np.dtype(f"u{kind.itemsize}")
    steps = table.view(whole.newbyteorder(kind.byteorder)).reshape(rows, -1, channels)
    return np.cumsum(steps, axis=1, dtype=whole).view(kind.newbyteorder("="))


def turned(values: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Turn a picture as its orientation says, 1 to 8."""
    if orientation in (5, 6, 7, 8):
        values = values.swapaxes(0, 1)
    down = slice(None, None, -1 if orientation in (3, 4, 7, 8) else 1)
    right = slice(None, None, -1 if orientation in (2, 3, 6, 7) else 1)
    return np.ascontiguousarray(values[down, right])


def _count_pages(data: bytes) -> int:
    """Follow the chain of pages, which tifffile does without end where it runs in a circle."""
    order = "<" if data[:2] == b"II" else ">"
    big = data[2:4] in (b"+\0", b"\0+")
    count, offset, entry, place = ("Q", "Q", 20, 8) if big else ("H", "I", 12, 4)
    seen: set[int] = set()
    try:
        (place,) = struct.unpack_from(f"{order}{offset}", data, place)
        while place and place < len(data) and len(seen) < _MOST_PAGES:
            if place in seen:
                raise damaged("its pages lead in a circle")
            seen.add(place)
            (entries,) = struct.unpack_from(f"{order}{count}", data, place)
            place += struct.calcsize(f"{order}{count}") + entry * entries
            (place,) = struct.unpack_from(f"{order}{offset}", data, place)
    except (struct.error, OverflowError):  # cut short: what there is may be enough
        pass
    return len(seen)


def _planes(page: Any) -> int:
    """Return how many pictures lie behind one page, as programs for microscopes write them."""
    said = page.description
    stack = re.search(r"^images=(\d{1,9})\s*$", said, re.MULTILINE) if page.is_imagej else None
    shape = re.search(r'"shape": \[([\d, ]{1,99})\]', said) if page.is_shaped else None
    tag = page.tags.get(_PLANES) if page.is_stk else None
    counts = [
        int(page.imagedepth),
        0 if stack is None else int(stack[1]),
        0 if shape is None else math.prod(map(int, shape[1].split(","))) // math.prod(page.shape),
        0 if tag is None else int(tag.count),
    ]
    return max(counts)


def _unreadable(page: Any) -> str:
    """Say why a page cannot be decoded without loss; nothing when it can."""
    compression, channels = page.compression, int(page.samplesperpixel)
    bits, predictor, dtype = page.bitspersample, int(page.predictor), page.dtype
    if int(compression) not in _PACKED | _LOSSY | {1}:
        return f"compression {getattr(compression, 'name', int(compression))}"
    if dtype is None or not isinstance(bits, int) or dtype.itemsize * channels > _MOST_BYTES_A_PX:
        return f"{channels} channels of {bits} bits"
    whole = bits == 8 * dtype.itemsize
    wrong = {
        f"numbers of {bits} bits": not whole and (bits > 16 or dtype.kind not in "bu"),
        f"{bits} bits a channel and compression {int(compression)}": (
            int(compression) in _FAX and bits * channels != 1
        ),
        f"predictor {predictor} of {bits} bits": (
            predictor not in (1, 2, 3)
            or (predictor == 2 and (not whole or dtype.kind not in "iuf"))
            or (predictor == 3 and dtype.kind != "f")
        ),
    }
    return next((what for what, found in wrong.items() if found), "")
