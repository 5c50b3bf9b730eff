"""TIFF pages to values: tifffile where it can, Pillow for the codecs that it lacks."""

import io
import math
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL.Image import Transpose

from drystone.io.file_errors import damaged, several_pages
from drystone.io.foreign import foreign
from drystone.io.pictures import opened

_BY_TIFFFILE = {1, 8, 32773, 32946}
"""No compression, deflate, PackBits: decoded by tifffile without further packages."""

_BY_PILLOW = {2, 3, 4, 5}
"""Fax codes and LZW."""

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

_BACK = {
    2: Transpose.FLIP_LEFT_RIGHT, 3: Transpose.ROTATE_180, 4: Transpose.FLIP_TOP_BOTTOM,
    5: Transpose.TRANSPOSE, 6: Transpose.ROTATE_90, 7: Transpose.TRANSVERSE,
    8: Transpose.ROTATE_270,
}  # fmt: skip
"""What takes back the turn of an orientation."""

_MOST_PAGES = 10_000
_MOST_BYTES_A_PX = 8
_EXPANDS = 2**26
"""Bytes that packed ones may become before it is looked at what they do become."""


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


def inspect(data: bytes) -> TiffPage:
    """Read the tags of a TIFF and decode nothing."""
    pages = _count_pages(data)
    if pages > 1:
        raise several_pages(f"{pages} pages")
    with _page(data) as page:
        planes, channels = _planes(page), int(page.samplesperpixel)
        compression, photometric = int(page.compression), int(page.photometric)
        orientation = page.tags.get(ORIENTATION)
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
        )
    if planes > 1 or channels > 4:
        said = f"{planes} planes" if planes > 1 else f"{channels} channels"
        raise several_pages(said)
    return found


def values(data: bytes, check: Callable[[int, int], None]) -> NDArray[Any]:
    """Decode the only page of a TIFF, channels last; palette indices and numbers are kept.

    Pixels are where the file has them: its orientation turns nothing, however it is compressed.
    """
    with _page(data) as page:
        compression, bits, kind = (
            int(n) for n in (page.compression, page.bitspersample, page.sampleformat)
        )
        if len(page.dataoffsets) < math.prod(page.chunked):
            # tifffile fills the rest with 0.
            raise damaged("it does not hold all of its strips")
        negative = int(page.photometric) == 0
        size = math.prod(page.shaped) * max(1, bits // 8)
        packed = [
            (int(a), int(n)) for a, n in zip(page.dataoffsets, page.databytecounts, strict=False)
        ]
    if compression not in _BY_TIFFFILE:
        unsigned = bits == 32 and kind == 1
        return _values_by_pillow(data, check, unsigned=unsigned, negative=negative)
    if compression != 1:
        _check_expanded(data, packed, compression, size)
    with _page(data) as page:
        found = np.asarray(page.asarray())
        return np.moveaxis(found, 0, -1) if page.axes == "SYX" else found


@contextmanager
def _page(data: bytes) -> Iterator[Any]:
    """Open the first page with tifffile, the variants of microscopes that lead elsewhere aside."""
    with foreign(damaged):
        file = tifffile.TiffFile(  # noqa: TID251 - its chain was followed
            io.BytesIO(data), is_lsm=False, is_ndpi=False, is_scanimage=False
        )
        page = file.pages[0]
        if not all(isinstance(side, int) for side in page.shape):
            raise damaged("a side of it is no number")
        yield page


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
    bits = page.bitspersample
    if int(compression) not in _BY_TIFFFILE | _BY_PILLOW | _LOSSY:
        return f"compression {getattr(compression, 'name', int(compression))}"
    if page.dtype is None or page.dtype.itemsize * channels > _MOST_BYTES_A_PX:
        return f"{channels} channels of {bits} bits"
    if int(compression) not in _BY_TIFFFILE and channels > 1 and bits > 8:
        return f"{bits} bits a colour channel and compression"
    return ""


def _check_expanded(
    data: bytes, packed: list[tuple[int, int]], compression: int, size: int
) -> None:
    """Refuse packed bytes that become many more than the picture has."""
    total, most = sum(count for _, count in packed), 2 * size + _EXPANDS
    if total > len(data):
        raise damaged("its strips lie in each other")
    if total * 1032 <= _EXPANDS:  # the most that deflate can do
        return
    expanded = 0
    for start, count in packed:
        piece = data[start : start + count]
        with foreign(damaged):
            expanded += (_inflated if compression != 32773 else _unpacked)(piece, most)
        if expanded > most:
            raise damaged("its strips are larger than the picture")


def _inflated(piece: bytes, most: int) -> int:
    """Return how many bytes deflate makes of some, counted until there are too many."""
    decoder, total = zlib.decompressobj(), 0
    while piece and total <= most:
        total += len(decoder.decompress(piece, 2**24))
        piece = decoder.unconsumed_tail
    return total


def _unpacked(piece: bytes, most: int) -> int:
    """Return the same of PackBits."""
    place = total = 0
    while place < len(piece) and total <= most:
        number = piece[place]
        total += number + 1 if number < 128 else 257 - number
        place += number + 2 if number < 128 else 2
    return total


def _values_by_pillow(
    data: bytes, check: Callable[[int, int], None], *, unsigned: bool, negative: bool
) -> NDArray[Any]:
    with opened(data, check) as image:
        # Pillow turns a picture when it loads it.
        back = _BACK.get(image.getexif().get(ORIENTATION, 1))
        mode = image.mode
        found = np.asarray(image if back is None else image.transpose(back))
    if unsigned and found.dtype.itemsize == 4:
        # Pillow has no unsigned 32-bit mode: the bits are right, the sign is not.
        found = found.view(np.uint32)
    if negative and mode in ("1", "L"):
        # Pillow inverts white-is-zero pictures; values are the file's own, as in tifffile.
        found = ~found
    return found
