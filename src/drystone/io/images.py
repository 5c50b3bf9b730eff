"""Bytes of a picture file to its values, unchanged: no palette applied, no depth lost."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError
from drystone.io import npy, tiff
from drystone.io.file_errors import damaged, several_pages, unread
from drystone.io.pictures import check_size, format_of, opened

FORMATS = (
    "PNG, TIFF, BMP, GIF, NPY, NPZ, JSON of labelme, COCO, SAM, Label Studio or VIA, GeoJSON, CVAT "
    "XML, YOLO segments, DXF, SVG, OBJ, PLY, STL or a folder of one-stone masks"
)
SUFFIXES = (".png", ".tif", ".tiff", ".bmp", ".gif", ".npy", ".jpg", ".jpeg")
_MODES = frozenset({"1", "L", "P", "LA", "PA", "I", "I;16", "F", "RGB", "RGBA"})


@dataclass(frozen=True, eq=False)
class Picture:
    """The values of a picture as the file holds them."""

    values: NDArray[Any]
    """(h, w) or (h, w, c): values, palette indices or colour channels, without what says that it is
    alpha.  c = 2 and 4 are left for arrays, and for channels of a TIFF that do not say what they
    are."""
    lossy: bool = False  # the format does not keep values exactly


def decode(data: bytes, max_px: int) -> Picture:
    """Decode the bytes of a picture file; the format is told by its first bytes.

    Pictures of more than `max_px` are refused (E110) before they are decoded.
    """
    if not data:
        raise InputError("E106", "the file is empty (0 bytes).", cure="Export it again.")
    if data.startswith(npy.BEGINNING):
        return Picture(npy.array_of(data, max_px))
    kind = format_of(data)
    if kind == "TIFF":
        return _read_tiff(data, max_px)
    if kind == "PNG":
        return _read_png(data, max_px)
    if kind:
        return Picture(_read_pillow(data, max_px), lossy=kind == "JPEG")
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
        raise unread(
            "this PNG has 16 bits a colour channel, which cannot be read without loss.",
            "Export the ids as 16-bit grey PNG, as 8-bit RGB PNG or as TIFF.",
        )
    values = _read_pillow(data, max_px)
    # Pillow stretches 2 and 4 bits to 0 ... 255; the ids are the file's own.
    stretched = colour_type == 0 and depth in (2, 4)
    return Picture(values // (255 // (2**depth - 1)) if stretched else values)


def _read_pillow(data: bytes, max_px: int) -> NDArray[Any]:
    with opened(data, partial(check_size, max_px=max_px)) as image:
        frames, mode = getattr(image, "n_frames", 1), image.mode
        values = np.asarray(image) if frames == 1 and mode in _MODES else None
    if frames > 1:
        raise several_pages(f"{frames} frames")
    if values is None:
        raise _no_ids(mode)
    return _without_alpha(values) if mode in {"LA", "PA", "RGBA"} else values


def _no_ids(mode: str) -> InputError:
    what = f"the colour mode {mode} does not hold ids."
    return unread(what, "Export a grey, palette or RGB picture.")


def _without_alpha(values: NDArray[Any]) -> NDArray[Any]:
    """Drop the last channel of two or four, which is known to be alpha."""
    return values[:, :, 0] if values.shape[2] == 2 else values[:, :, :-1]


def _read_tiff(data: bytes, max_px: int) -> Picture:
    check = partial(check_size, max_px=max_px)
    page = tiff.inspect(data)
    check(page.width, page.height)
    if page.unreadable:
        raise unread(
            f"TIFF with {page.unreadable} cannot be read.",
            "Export it uncompressed, with LZW or with deflate; ids of 16 or 32 bits in one "
            "channel.",
        )
    if page.colours:
        raise _no_ids(page.colours)
    values = tiff.values(data, check)
    # Tags may speak of an alpha that is not there.
    alpha = page.alpha and values.ndim > 2
    return Picture(_without_alpha(values) if alpha else values, lossy=page.lossy)
