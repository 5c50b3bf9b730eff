"""Bytes of a picture file to its values, unchanged: no palette applied, no depth lost."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError
from drystone.io import npy, tiff
from drystone.io.pictures import check_size, damaged, format_of, opened, several_pages

FORMATS = (
    "PNG, TIFF, BMP, GIF, NPY, NPZ, JSON of labelme, COCO or SAM, GeoJSON, DXF, SVG, OBJ, PLY, STL "
    "or a folder of one-stone masks"
)
SUFFIXES = (".png", ".tif", ".tiff", ".bmp", ".gif", ".npy", ".jpg", ".jpeg")
_MODES = frozenset({"1", "L", "P", "LA", "PA", "I", "I;16", "F", "RGB", "RGBA"})


@dataclass(frozen=True, eq=False)
class Picture:
    """The values of a picture as the file holds them."""

    # (h, w), values, palette indices or colour channels, without what says that it is alpha; c =
    # 2 and 4 are left for arrays, and for channels of a TIFF that do not say what they are
    values: NDArray[Any]
    lossy: bool = False  # true when the format does not keep values exactly


def decode(data: bytes, where: str, max_px: int) -> Picture:
    """Decode the bytes of a picture file; the format is told by its first bytes."""
    if not data:
        raise InputError(
            "E106", "the file is empty (0 bytes).", where=where, cure="Export it again."
        )
    kind = "NPY" if data.startswith(npy.BEGINNING) else format_of(data)
    if kind not in _READERS:
        raise InputError(
            "E107",
            f"this is none of the formats that stones are read from ({FORMATS}).",
            where=where,
            cure="Export a label image as PNG or TIFF: one id a stone, 0 where there is none.",
        )
    return _READERS[kind](data, where, max_px)


def _read_png(data: bytes, where: str, max_px: int) -> Picture:
    if len(data) < 26:
        raise damaged("its header is cut", where)
    depth, colour_type = data[24], data[25]
    if depth == 16 and colour_type != 0:
        # Pillow would keep the upper 8 bits of each channel, and ids would merge.
        raise InputError(
            "E107",
            "this PNG has 16 bits a colour channel, which cannot be read without loss.",
            where=where,
            cure="Export the ids as 16-bit grey PNG, as 8-bit RGB PNG or as TIFF.",
        )
    picture = _read_pillow(data, where, max_px)
    if colour_type == 0 and depth in (2, 4):
        # Pillow stretches 2 and 4 bits to 0 ... 255; the ids are the file's own.
        return Picture(picture.values // (255 // (2**depth - 1)))
    return picture


def _read_jpeg(data: bytes, where: str, max_px: int) -> Picture:
    return Picture(_read_pillow(data, where, max_px).values, lossy=True)


def _read_pillow(data: bytes, where: str, max_px: int) -> Picture:
    with opened(data, where, partial(check_size, where=where, max_px=max_px)) as image:
        frames, mode = getattr(image, "n_frames", 1), image.mode
        values = np.asarray(image) if frames == 1 and mode in _MODES else None
    if frames > 1:
        raise several_pages(f"{frames} frames", where)
    if values is None:
        raise _no_ids(mode, where)
    return Picture(_without_alpha(values) if mode in {"LA", "PA", "RGBA"} else values)


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


def _read_tiff(data: bytes, where: str, max_px: int) -> Picture:
    check = partial(check_size, where=where, max_px=max_px)
    page = tiff.inspect(data, where)
    check(page.width, page.height)
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
    values = tiff.values(data, where, check)
    # Tags may speak of an alpha that is not there.
    alpha = page.alpha and values.ndim > 2
    return Picture(_without_alpha(values) if alpha else values, lossy=page.lossy)


def _read_npy(data: bytes, where: str, max_px: int) -> Picture:
    return Picture(npy.array_of(data, where, max_px))


_READERS: Mapping[str, Callable[[bytes, str, int], Picture]] = MappingProxyType(
    {
        "PNG": _read_png, "TIFF": _read_tiff, "GIF": _read_pillow, "BMP": _read_pillow,
        "JPEG": _read_jpeg, "NPY": _read_npy,
    }
)  # fmt: skip
