"""Bytes of a picture file to its values, unchanged: no palette applied, no depth lost."""

import io
import struct
import tokenize
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import BmpImagePlugin, GifImagePlugin, Image, JpegImagePlugin, PngImagePlugin

from drystone.errors import InputError
from drystone.io import tiff

FORMATS = (
    "PNG, TIFF, BMP, GIF, NPY, NPZ, JSON of labelme, COCO or SAM, GeoJSON, DXF, SVG, OBJ, PLY, STL "
    "or a folder of one-stone masks"
)
SUFFIXES = (".png", ".tif", ".tiff", ".bmp", ".gif", ".npy", ".jpg", ".jpeg")
DAMAGE = (
    OSError, ValueError, TypeError, KeyError, IndexError, EOFError, SyntaxError, RuntimeError,
    struct.error, zlib.error, tokenize.TokenError,
)  # fmt: skip
"""What Pillow, tifffile and NumPy raise on damaged files."""


@dataclass(frozen=True, eq=False)
class Picture:
    """The values of a picture as the file holds them.

    Parameters
    ----------
    values : (h, w) or (h, w, c) array
        Values, palette indices or colour channels, without what says that it is alpha; c = 2 and
        4 are left for arrays, and for channels of a TIFF that do not say what they are.
    lossy : bool
        True when the format does not keep values exactly.
    """

    values: NDArray[Any]
    lossy: bool = False


def decode(data: bytes, where: str, max_px: int) -> Picture:
    """Decode the bytes of a picture file; the format is told by its first bytes.

    Parameters
    ----------
    data : bytes
        The whole file.
    where : str
        Its name, for messages.
    max_px : int
        Larger pictures are refused (E110) before they are decoded.

    Raises
    ------
    InputError
        E106 empty or damaged, E107 unknown format, E109 several pages, E110 too large.
    """
    if not data:
        raise InputError(
            "E106", "the file is empty (0 bytes).", where=where, cure="Export it again."
        )
    reader = _reader(data, where)
    try:
        return reader(data, where, max_px)
    except MemoryError as error:
        raise InputError(
            "E110",
            "there is not enough memory for this picture.",
            where=where,
            cure="Reduce the picture (nearest neighbour, so that ids survive) or crop it.",
        ) from error
    except DAMAGE as error:
        raise InputError(
            "E106",
            f"the file is damaged or cut short ({error}).",
            where=where,
            cure="Copy or export it again.",
        ) from error


def _reader(data: bytes, where: str) -> Callable[[bytes, str, int], Picture]:
    readers: tuple[tuple[tuple[bytes, ...], Callable[[bytes, str, int], Picture]], ...] = (
        ((b"\x89PNG\r\n\x1a\n",), _read_png),
        ((b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"), _read_tiff),
        ((b"GIF87a", b"GIF89a"), _read_gif),
        ((b"BM",), _read_bmp),
        ((b"\xff\xd8\xff",), _read_jpeg),
        ((b"\x93NUMPY",), _read_npy),
    )
    for beginnings, reader in readers:
        if data.startswith(beginnings):
            return reader
    raise InputError(
        "E107",
        f"this is none of the formats that stones are read from ({FORMATS}).",
        where=where,
        cure="Export a label image as PNG or TIFF: one id a stone, 0 where there is none.",
    )


def check_size(
    width: int,
    height: int,
    where: str,
    max_px: int,
    cure: str = "Reduce the picture (nearest neighbour, so that ids survive) or crop it; only in "
    "Python can the limit be raised (max_image_mpx).",
) -> None:
    """Refuse pictures that would fill the memory (E110)."""
    if width * height > max_px:
        raise InputError(
            "E110",
            f"{width} x {height} px are {width * height / 1e6:.0f} million; the limit is "
            f"{max_px / 1e6:g} million.",
            where=where,
            cure=cure,
        )


def _read_png(data: bytes, where: str, max_px: int) -> Picture:
    depth, colour_type = data[24], data[25]
    if depth == 16 and colour_type != 0:
        # Pillow would keep the upper 8 bits of each channel, and ids would merge.
        raise InputError(
            "E107",
            "this PNG has 16 bits a colour channel, which cannot be read without loss.",
            where=where,
            cure="Export the ids as 16-bit grey PNG, as 8-bit RGB PNG or as TIFF.",
        )
    picture = _read_pillow(PngImagePlugin.PngImageFile(io.BytesIO(data)), where, max_px)
    if colour_type == 0 and depth in (2, 4):
        # Pillow stretches 2 and 4 bits to 0 ... 255; the ids are the file's own.
        return Picture(picture.values // (255 // (2**depth - 1)))
    return picture


def _read_gif(data: bytes, where: str, max_px: int) -> Picture:
    return _read_pillow(GifImagePlugin.GifImageFile(io.BytesIO(data)), where, max_px)


def _read_bmp(data: bytes, where: str, max_px: int) -> Picture:
    return _read_pillow(BmpImagePlugin.BmpImageFile(io.BytesIO(data)), where, max_px)


def _read_jpeg(data: bytes, where: str, max_px: int) -> Picture:
    image = JpegImagePlugin.JpegImageFile(io.BytesIO(data))
    return Picture(_read_pillow(image, where, max_px).values, lossy=True)


def _read_pillow(image: Image.Image, where: str, max_px: int) -> Picture:
    # The plug-in's own class is opened, not Image.open: Pillow's guard against huge pictures is
    # a module global; the limit here is the caller's.
    check_size(*image.size, where, max_px)
    if getattr(image, "n_frames", 1) > 1:
        raise several_pages(f"{image.n_frames} frames", where)  # type: ignore[attr-defined]
    if image.mode not in {"1", "L", "P", "LA", "PA", "I", "I;16", "F", "RGB", "RGBA"}:
        raise _no_ids(image.mode, where)
    values = np.asarray(image)
    return Picture(_without_alpha(values) if image.mode in {"LA", "PA", "RGBA"} else values)


def _no_ids(mode: str, where: str) -> InputError:
    return InputError(
        "E107",
        f"the colour mode {mode} does not hold ids.",
        where=where,
        cure="Export a grey, palette or RGB picture.",
    )


def _without_alpha(values: NDArray[Any]) -> NDArray[Any]:
    """Drop the last channel of two or four, which is known to be alpha."""
    return values[:, :, 0] if values.shape[2] == 2 else values[:, :, :-1]


def several_pages(found: str, where: str) -> InputError:
    """Make the error for stacks and animations (E109)."""
    return InputError(
        "E109",
        f"{found} were found where one picture is needed.",
        where=where,
        cure="Give one page as a picture of its own, or a folder of one-stone masks.",
    )


def _read_tiff(data: bytes, where: str, max_px: int) -> Picture:
    page = tiff.inspect(data)
    check_size(page.width, page.height, where, max_px)
    if page.pages > 1:
        raise several_pages(f"{page.pages} pages", where)
    if page.unreadable:
        raise InputError(
            "E107",
            f"TIFF with {page.unreadable} cannot be read.",
            where=where,
            cure="Export it uncompressed, with LZW or with deflate; ids of 16 or 32 bits in one "
            "channel.",
        )
    if page.colours:
        raise _no_ids(page.colours, where)
    values = tiff.values(data)
    return Picture(_without_alpha(values) if page.alpha else values, lossy=page.lossy)


def _read_npy(data: bytes, where: str, max_px: int) -> Picture:
    values = np.load(io.BytesIO(data), allow_pickle=False)
    shape = (*values.shape, 1, 1)
    check_size(shape[1], shape[0], where, max_px)
    return Picture(values)
