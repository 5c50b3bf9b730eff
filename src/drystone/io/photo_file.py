"""Photographs as 8-bit RGB, the right way up."""

import hashlib
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

from drystone.errors import InputError, Notice
from drystone.io import tiff
from drystone.io.file_bytes import file_bytes
from drystone.io.pictures import check_size, format_of, opened
from drystone.io.tiff import ORIENTATION
from drystone.model.stone import writable

MAX_PX = 200_000_000
"""Larger photographs are refused."""

MAX_SIDE_PX = 32_766
"""Wider or higher ones too: OpenCV turns none that are."""

_REDUCE = "Reduce it or crop it; only in Python can the limit be raised (max_px)."

_TURNS = {
    2: "mirrored left to right", 3: "turned by 180 degrees", 4: "mirrored top to bottom",
    5: "mirrored and turned", 6: "turned by 90 degrees clockwise", 7: "mirrored and turned",
    8: "turned by 90 degrees counter-clockwise",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Photo:
    """A photograph."""

    values: NDArray[np.uint8]  # (h, w, 3), RGB, the right way up
    name: str  # base name of its file
    sha256: str  # of the file, in hexadecimal digits
    # W173 it was turned as its EXIF data say; W174 its depth was reduced or its alpha ignored
    notices: tuple[Notice, ...] = ()

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height, px."""
        return self.values.shape[1], self.values.shape[0]


def read_photo(path: str | Path, max_px: int = MAX_PX) -> Photo:
    """Read a JPEG, PNG or TIFF photograph."""
    path = Path(path)
    data = _bytes_of(path)
    values, orientation, deep = _decode(data, str(path), max_px)
    name = writable(path.name)
    rgb, notices = _to_rgb(values, str(path))
    if deep:
        notices = (Notice("W174", "16 bits a channel were scaled to 8."), *notices)
    if orientation in _TURNS:
        rgb = _turned(rgb, orientation)
        said = f"{name} was {_TURNS[orientation]}, as its EXIF data say."
        notices = (*notices, Notice("W173", said))
    return Photo(rgb, name, hashlib.sha256(data).hexdigest(), notices)


def _bytes_of(path: Path) -> bytes:
    try:
        data = file_bytes(path)
    except OSError as error:
        raise InputError(
            "E100", f"the photograph cannot be read ({error.strerror}).", where=str(path),
            cure="Check the path and your right to read it.",
        ) from error  # fmt: skip
    if not data:
        raise InputError(
            "E106", "the file is empty (0 bytes).", where=str(path), cure="Copy it again."
        )
    return data


def _decode(data: bytes, where: str, max_px: int) -> tuple[NDArray[Any], int, bool]:
    """Return values (palettes and CMYK as RGB), the orientation, and if there were 16 bits."""
    kind = format_of(data)
    if kind == "TIFF":
        values, orientation = _tiff(data, where, max_px)
        return values, orientation, values.dtype == np.uint16
    if kind in ("JPEG", "PNG"):
        # Colours of 16 bits come from Pillow as their upper 8.
        return *_by_pillow(data, where, max_px), kind == "PNG" and data[24:25] == b"\x10"
    raise InputError(
        "E107", "this is no JPEG, PNG or TIFF.", where=where,
        cure="Export the photograph as JPEG (phones: 'most compatible').",
    )  # fmt: skip


def _check(width: int, height: int, where: str, max_px: int) -> None:
    """Refuse photographs that would fill the memory, or that OpenCV cannot turn (E110)."""
    check_size(width, height, where, max_px, _REDUCE)
    if max(width, height) > MAX_SIDE_PX:
        raise InputError(
            "E110",
            f"{width} x {height} px; the limit of a side is {MAX_SIDE_PX} px.",
            where=where,
            cure="Reduce it or crop it.",
        )


def _by_pillow(data: bytes, where: str, max_px: int) -> tuple[NDArray[Any], int]:
    with opened(data, where, partial(_check, where=where, max_px=max_px)) as image:
        orientation = int(image.getexif().get(ORIENTATION, 1))
        mode = image.mode
        if mode in ("1", "CMYK", "YCbCr", "LAB", "HSV"):
            values = np.asarray(image.convert("RGB"))
        elif mode in ("P", "PA"):
            transparent = mode == "PA" or "transparency" in image.info
            values = np.asarray(image.convert("RGBA" if transparent else "RGB"))
        else:
            values = np.asarray(image)
    # Pillow reads grey PNG of 16 bits as "I" in some versions.
    return values.astype(np.uint16) if mode == "I" else values, orientation


def _tiff(data: bytes, where: str, max_px: int) -> tuple[NDArray[Any], int]:
    page = tiff.inspect(data, where)
    _check(page.width, page.height, where, max_px)
    if page.bits <= 8:
        # Pillow turns a TIFF by itself when it reads it: taken back, so that it is said.
        values, orientation = _by_pillow(data, where, max_px)
        return _turned(values, _BACK.get(orientation, orientation)), orientation
    if page.unreadable:
        raise InputError(
            "E107", f"TIFF with {page.unreadable} cannot be read.", where=where,
            cure="Export it uncompressed or with LZW.",
        )  # fmt: skip
    if page.colours:
        raise InputError(
            "E107", f"TIFF of {page.bits} bits a channel in {page.colours} cannot be read.",
            where=where, cure="Export it in RGB, or with 8 bits a channel.",
        )  # fmt: skip
    values = tiff.values(data, where, partial(_check, where=where, max_px=max_px))
    # Pillow takes this back for 8 bits; ids keep the numbers of the file, light does not.
    if page.negative and values.dtype == np.uint16:
        values = values.copy()
        grey = np.atleast_3d(values)[..., :1]
        np.subtract(65535, grey, out=grey)
    return values, page.orientation


_BACK = {6: 8, 8: 6}
"""Orientations whose opposite is another."""


def _turned(values: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Turn a picture as its orientation says."""
    if orientation not in _TURNS:
        return values
    image = Image.fromarray(values)
    image.getexif()[ORIENTATION] = orientation
    return np.array(ImageOps.exif_transpose(image))


def _to_rgb(values: NDArray[Any], where: str) -> tuple[NDArray[np.uint8], tuple[Notice, ...]]:
    """Return three channels of 8 bits, and what was lost."""
    notices: list[Notice] = []
    values = values[..., None] if values.ndim == 2 else values
    if values.dtype == np.uint16:
        values = np.round(values / 257.0).astype(np.uint8)
    if values.dtype != np.uint8 or values.ndim != 3 or not 1 <= values.shape[2] <= 4:
        raise InputError(
            "E107", f"values of type {values.dtype} are no photograph.", where=where,
            cure="Export it with 8 or 16 bits a channel.",
        )  # fmt: skip
    if values.shape[2] in (2, 4):
        if (values[..., -1] < 255).any():
            notices.append(Notice("W174", "Transparency was ignored."))
        values = values[..., :-1]
    if values.shape[2] == 1:
        values = np.repeat(values, 3, axis=2)
    return np.ascontiguousarray(values), tuple(notices)
