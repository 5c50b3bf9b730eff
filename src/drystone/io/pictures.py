"""Picture files through Pillow: the formats that are read, each told by its first bytes.

Nothing else opens pictures (a rule of the linter): ``Image.open`` tries all that Pillow knows, of
which one format starts another program, and its guard against huge pictures is a module global.
"""

import io
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

from PIL import (
    BmpImagePlugin,
    GifImagePlugin,
    Image,
    ImageFile,
    JpegImagePlugin,
    PngImagePlugin,
    TiffImagePlugin,
)

from drystone.errors import InputError
from drystone.io.file_errors import damaged, too_large
from drystone.io.foreign import foreign, silent_stderr

_FORMATS: tuple[tuple[str, tuple[bytes, ...], type[ImageFile.ImageFile]], ...] = (
    ("PNG", (b"\x89PNG\r\n\x1a\n",), PngImagePlugin.PngImageFile),
    ("TIFF", (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"), TiffImagePlugin.TiffImageFile),
    ("GIF", (b"GIF87a", b"GIF89a"), GifImagePlugin.GifImageFile),
    ("BMP", (b"BM",), BmpImagePlugin.BmpImageFile),
    ("JPEG", (b"\xff\xd8\xff",), JpegImagePlugin.JpegImageFile),
)

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
    return next((name for name, starts, _ in _FORMATS if data.startswith(starts)), "")


@contextmanager
def opened(data: bytes, check: Callable[[int, int], None]) -> Iterator[Image.Image]:
    """Open a picture; what Pillow raises while it is decoded, inside, is a coded error too."""
    kind = format_of(data)
    plugin = next((plugin for name, _, plugin in _FORMATS if name == kind), None)
    if plugin is None:
        raise InputError(
            "E107", f"this is not a picture ({', '.join(name for name, _, _ in _FORMATS)}).",
            cure="Export it as PNG.",
        )  # fmt: skip
    if kind == "JPEG" and _scans(data) > _MOST_SCANS:
        raise damaged(f"it has more than {_MOST_SCANS} scans")
    with ExitStack() as around:
        around.enter_context(foreign(damaged))
        if kind == "TIFF":
            around.enter_context(silent_stderr())
        try:
            image = plugin(io.BytesIO(data))
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
