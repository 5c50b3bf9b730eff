"""Bytes of a picture file to its values, unchanged: no palette applied, no depth lost.

Files are opened by Pillow, in formats that are each told by their first bytes.  Nothing else opens
pictures (a rule of the linter): ``Image.open`` tries all that Pillow knows, of which one format
starts another program, and its guard against huge pictures is a module global.

Of a TIFF tifffile reads the tags, and what it needs further packages for is here: strips and tiles
are unpacked one by one, each within the size that the tags give it.
"""

import io
import math
import re
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import (
    BmpImagePlugin,
    GifImagePlugin,
    Image,
    ImageFile,
    JpegImagePlugin,
    PngImagePlugin,
    TiffImagePlugin,
)

from drystone.errors import InputError, Notice
from drystone.io.files import damaged, foreign, several_pages, silent_stderr, too_large, unread

BEGINNING = b"\x93NUMPY"

FORMATS = (
    "PNG, TIFF, BMP, GIF, NPY, NPZ; JSON of labelme, COCO, SAM, Label Studio or VIA; GeoJSON, CVAT "
    "XML, YOLO segments; DXF, SVG, OBJ, PLY, STL; a folder of one-stone masks"
)
SUFFIXES = (".png", ".tif", ".tiff", ".bmp", ".gif", ".npy", ".jpg", ".jpeg")
_MODES = frozenset({"1", "L", "P", "LA", "PA", "I", "I;16", "F", "RGB", "RGBA"})


@dataclass(frozen=True, eq=False)
class Picture:
    """The values of a picture as the file holds them, turned as its orientation says."""

    values: NDArray[Any]
    """(h, w) or (h, w, c): values, palette indices or colour channels, without what says that it is
    alpha.  c = 2 and 4 are left for arrays, and for channels of a TIFF that do not say what they
    are."""
    lossy: bool = False  # the format does not keep values exactly
    alpha: NDArray[Any] | None = None  # (h, w), 0 is transparent; None when the file has none
    nodata: float | None = None  # the value that the file says is none
    notices: tuple[Notice, ...] = ()


def decode(data: bytes, max_px: int) -> Picture:
    """Decode the bytes of a picture file; the format is told by its first bytes.

    Pictures of more than `max_px` are refused (E110) before they are decoded.
    """
    if not data:
        raise InputError("E106", "the file is empty (0 bytes).", cure="Export it again.")
    if data.startswith(BEGINNING):
        return Picture(array_of(data, max_px))
    kind = format_of(data)
    if kind == "TIFF":
        return _read_tiff(data, max_px)
    if kind == "PNG":
        return _read_png(data, max_px)
    if kind:
        return _read_pillow(data, max_px)
    raise unread(
        f"this is none of the formats that stones are read from ({FORMATS}).",
        "Export a label image as PNG or TIFF: one id a stone, 0 where there is none.",
    )


def _read_png(data: bytes, max_px: int) -> Picture:
    if len(data) < 26:
        raise damaged("its header is cut")
    depth, colour_type = data[24], data[25]
    if depth == 16 and colour_type != 0:
        # Pillow would keep the upper 8 bits of each channel, and ids would merge.
        what = "this PNG has 16 bits a colour channel, which cannot be read without loss."
        raise unread(what, "Export the ids as 16-bit grey PNG, as 8-bit RGB PNG or as TIFF.")
    # Pillow stretches 2 and 4 bits to 0 ... 255; the ids are the file's own.
    stretched = colour_type == 0 and depth in (2, 4)
    return _read_pillow(data, max_px, 255 // (2**depth - 1) if stretched else 1)


def _read_pillow(data: bytes, max_px: int, times: int = 1) -> Picture:
    with opened(data, partial(check_size, max_px=max_px)) as image:
        frames, mode, kind = getattr(image, "n_frames", 1), image.mode, image.format
        values = np.asarray(image) if frames == 1 and mode in _MODES else None
        clear = image.info.get("transparency")
        orientation = image.getexif().get(ORIENTATION, 1) if kind in ("PNG", "JPEG") else 1
    if frames > 1:
        raise several_pages(f"{frames} frames")
    if values is None:
        raise _no_ids(mode)
    values, alpha = values // times if times > 1 else values, None
    if mode in {"LA", "PA", "RGBA"}:
        values, alpha = _without_alpha(values)
    elif clear is not None:
        alpha = _alpha_of(values, clear)
    return _turned(Picture(values, kind == "JPEG", alpha), orientation)


def _turned(picture: Picture, orientation: object) -> Picture:
    """Turn a picture as the tag of its orientation says, which programs that show it do too."""
    if not isinstance(orientation, int) or orientation not in TURNS:
        return picture
    alpha = picture.alpha if picture.alpha is None else turned(picture.alpha, orientation)
    what = f"the picture was {TURNS[orientation]}, as its orientation ({orientation}) says."
    cure = "Delete that tag from the file if its rows are upright as they are."
    notices = (*picture.notices, Notice("W173", what, cure))
    return replace(
        picture, values=turned(picture.values, orientation), alpha=alpha, notices=notices
    )


def _no_ids(mode: str) -> InputError:
    what = f"the colour mode {mode} does not hold ids."
    return unread(what, "Export a grey, palette or RGB picture.")


def _without_alpha(values: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Take off the last channel of two or four, which is known to be alpha."""
    return values[:, :, 0] if values.shape[2] == 2 else values[:, :, :-1], values[:, :, -1]


def _alpha_of(values: NDArray[Any], clear: Any) -> NDArray[Any] | None:
    """Return the alpha of a palette (bytes, or the one clear entry), or of one clear colour."""
    if isinstance(clear, bytes):
        table = np.full(256, 255, np.uint8)
        table[: len(clear)] = np.frombuffer(clear[:256], np.uint8)
        return table[values.astype(np.uint8)]
    colours = np.atleast_3d(values)
    colour = np.atleast_1d(clear).astype(bool if values.dtype == bool else np.int64)
    if colours.shape[2] != len(colour):
        return None
    return np.asarray((colours != colour).any(axis=2).view(np.uint8) * np.uint8(255))


def _read_tiff(data: bytes, max_px: int) -> Picture:
    check = partial(check_size, max_px=max_px)
    page = inspect_tiff(data, check)
    if page.unreadable:
        raise unread(
            f"TIFF with {page.unreadable} cannot be read.",
            "Export it uncompressed, with LZW or with deflate; ids of 16 or 32 bits in one "
            "channel.",
        )
    if page.colours:
        raise _no_ids(page.colours)
    values, alpha = tiff_values(data, page, check), None
    # Tags may speak of an alpha that is not there.
    if page.alpha and values.ndim > 2:
        values, alpha = _without_alpha(values)
    notices = []
    if page.missing:
        what = f"{page.missing} are not in the file (sparse): nothing is there."
        notices.append(Notice("W135", what, "Export the file again if stones should be there."))
    picture = Picture(values, page.lossy, alpha, page.nodata, tuple(notices))
    return _turned(picture, page.orientation)


def array_of(data: bytes, max_px: int) -> NDArray[Any]:
    """Return the array of an NPY file; it can be read only."""
    with foreign(damaged):
        file = io.BytesIO(data)
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0
        if version != (1, 0):
            read = np.lib.format.read_array_header_2_0
        shape, fortran, dtype = read(file)
    if dtype.hasobject:
        # The masks of cellpose lie in such.
        what, cure = "Python objects", "Save the array of ids by itself, as whole numbers."
        if b"masks" in data and b"outlines" in data:
            what = "objects of cellpose (_seg.npy)"
            cure = (
                "Export the masks: in the cellpose window 'File > Save masks as PNG', or in Python "
                "`np.save('masks.npy', np.load(FILE, allow_pickle=True).item()['masks'])`."
            )
        raise unread(f"it holds {what}, and pickle is not read, as it may run programs.", cure)
    if min(shape, default=0) < 0 or not dtype.itemsize:
        raise damaged("a side is below 0, or its values have no bytes")
    count, start = math.prod(shape), file.tell()
    if count * dtype.itemsize > len(data) - start:
        raise damaged("there are fewer bytes than its shape asks for")
    if count:
        height, width = (*shape, 1, 1)[:2]
        check_size(width, height, max_px)
    with foreign(damaged):
        values = np.frombuffer(data, dtype, count, start)
        return values.reshape(shape, order="F" if fortran else "C")


_FORMATS: Mapping[str, tuple[tuple[bytes, ...], type[ImageFile.ImageFile]]] = {
    "PNG": ((b"\x89PNG\r\n\x1a\n",), PngImagePlugin.PngImageFile),
    "TIFF": ((b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"), TiffImagePlugin.TiffImageFile),
    "GIF": ((b"GIF87a", b"GIF89a"), GifImagePlugin.GifImageFile),
    "BMP": ((b"BM",), BmpImagePlugin.BmpImageFile),
    "JPEG": ((b"\xff\xd8\xff",), JpegImagePlugin.JpegImageFile),
}

_JPEG_MARKER = re.compile(rb"\xff++([^\x00\xd0-\xd7])")
_MOST_SCANS = 100
"""Progressive pictures have about ten."""

_PIECE = 2**22
"""Bytes that are unpacked at once where they are only counted."""

_MOST_SIDE_PX = 1_000_000
"""Decoders fill whole rows at once, also such as are not there."""

_CURE = (
    "Reduce the picture (nearest neighbour, so that ids survive) or crop it; only in Python can "
    "the limit be raised (max_image_mpx)."
)


def format_of(data: bytes) -> str:
    """Return the format of a picture by its first bytes: PNG, TIFF, GIF, BMP, JPEG or nothing."""
    return next((name for name, (starts, _) in _FORMATS.items() if data.startswith(starts)), "")


@contextmanager
def opened(data: bytes, check: Callable[[int, int], None]) -> Iterator[Image.Image]:
    """Open a picture; what Pillow raises while it is decoded, inside, is a coded error too."""
    kind = format_of(data)
    if not kind:
        raise unread(f"this is not a picture ({', '.join(_FORMATS)}).", "Export it as PNG.")
    if kind == "JPEG" and _scans(data) > _MOST_SCANS:
        raise damaged(f"it has more than {_MOST_SCANS} scans")
    with ExitStack() as around:
        around.enter_context(foreign(damaged))
        if kind == "TIFF":
            around.enter_context(silent_stderr())
        try:
            image = _FORMATS[kind][1](io.BytesIO(data))
            check(*image.size)
            if kind == "PNG" and not _holds_its_rows(data):
                raise damaged("it does not hold all of its rows")
            yield image
        except Image.DecompressionBombError as error:  # a frame larger than the picture
            raise too_large(f"{error}.", _CURE) from error


def _holds_its_rows(data: bytes) -> bool:
    """Tell whether a PNG has as many bytes as its header says: Pillow fills the rest with 0.

    What cannot be told from a damaged file is left to Pillow.
    """
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
    if len(data) < 33 or data[25] not in channels:
        return True
    width, height, bits = struct.unpack_from(">IIB", data, 16)
    row = width * bits * channels[data[25]]
    # Each row begins with its filter; interlaced ones are packed otherwise.
    missing = height * row // 8 if data[28] else height * (1 + -(-row // 8))
    place, decoder = 8, zlib.decompressobj()
    while missing > 0 and place + 8 <= len(data):
        length, name = struct.unpack_from(">I4s", data, place)
        piece = data[place + 8 : place + 8 + length] if name == b"IDAT" else b""
        place += 12 + length
        try:
            while piece and missing > 0:
                missing -= len(decoder.decompress(piece, _PIECE))
                piece = decoder.unconsumed_tail
        except zlib.error:
            return True
    return bool(missing <= 0)


def _scans(data: bytes) -> int:
    """Count how often a JPEG goes over the whole picture, which takes as long each time."""
    place = count = 0
    while count <= _MOST_SCANS and (found := _JPEG_MARKER.search(data, place + 2)):
        if found[1] == b"\xd9":  # what follows the end is no part of it
            break
        count += found[1] == b"\xda"
        place = found.end() + int.from_bytes(data[found.end() : found.end() + 2], "big") - 2
    return count


def check_size(width: int, height: int, max_px: int, cure: str = _CURE) -> None:
    """Refuse pictures that would fill the memory (E110)."""
    if width * height > max_px or max(width, height) > _MOST_SIDE_PX:
        # Numbers of a file may be longer than Python prints.
        size = f"{width} x {height} px" if max(width, height) < 10**12 else "more than 1e12 px"
        raise too_large(
            f"{size} are {min(width * height, 10**18) / 1e6:.0f} million; the limit is "
            f"{max_px / 1e6:g} million, and {_MOST_SIDE_PX} of a side.",
            cure,
        )


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

TURNS = {
    2: "mirrored left to right", 3: "turned by 180 degrees", 4: "mirrored top to bottom",
    5: "mirrored and turned", 6: "turned by 90 degrees clockwise", 7: "mirrored and turned",
    8: "turned by 90 degrees counter-clockwise",
}  # fmt: skip
"""What is done to a picture of an orientation."""

TURNED_BACK = {6: 8, 8: 6}
"""Orientations that another one takes back; all others are their own opposite."""

_NODATA, _PLANES = 42113, 33629
"""Tags of GDAL, the number that stands for nothing, and of MetaMorph: a value a plane."""

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


def inspect_tiff(data: bytes, check: Callable[[int, int], None]) -> TiffPage:
    """Read the tags of a TIFF, check its width and height, and decode nothing."""
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
        with suppress(ValueError):
            nodata = None if nothing is None else float(str(nothing.value).strip("\0 "))
        missing, chunks = sum(count == 0 for count in page.databytecounts), math.prod(page.chunked)
        lossy = compression in _LOSSY
        found = TiffPage(
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
        raise several_pages(f"{planes} planes" if planes > 1 else f"{channels} channels")
    check(int(page.imagewidth), int(page.imagelength))
    return found


def tiff_values(data: bytes, tags: TiffPage, check: Callable[[int, int], None]) -> NDArray[Any]:
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
    said, counts = page.description, [int(page.imagedepth)]
    if page.is_imagej and (stack := re.search(r"^images=(\d{1,9})\s*$", said, re.MULTILINE)):
        counts.append(int(stack[1]))
    if page.is_shaped and (shape := re.search(r'"shape": \[([\d, ]{1,99})\]', said)):
        counts.append(math.prod(map(int, shape[1].split(","))) // math.prod(page.shape))
    if page.is_stk and (tag := page.tags.get(_PLANES)) is not None:
        counts.append(int(tag.count))
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
    if not whole and (bits > 16 or dtype.kind not in "bu"):
        return f"numbers of {bits} bits"
    if int(compression) in _FAX and bits * channels != 1:
        return f"{bits} bits a channel and compression {int(compression)}"
    of_kinds = {1: dtype.kind, 2: "iuf" if whole else "", 3: "f"}
    known = dtype.kind in of_kinds.get(predictor, "")
    return "" if known else f"predictor {predictor} of {bits} bits"
