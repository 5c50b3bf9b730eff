"""Photographs as 8-bit RGB, the right way up."""

import hashlib
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image, ImageOps, JpegImagePlugin, PngImagePlugin, TiffImagePlugin

from drystone.errors import InputError, Notice
from drystone.io import tiff
from drystone.io.images import DAMAGE, check_size, several_pages
from drystone.model.stone import writable

MAX_PX = 200_000_000
"""Larger photographs are refused."""

MAX_SIDE_PX = 32_766
"""Wider or higher ones too: OpenCV turns none that are."""

_ORIENTATION = 0x0112
"""Tag of EXIF and TIFF: how the camera was held."""

_REDUCE = "Reduce it or crop it; only in Python can the limit be raised (max_px)."

_TURNS = {
    2: "mirrored left to right", 3: "turned by 180 degrees", 4: "mirrored top to bottom",
    5: "mirrored and turned", 6: "turned by 90 degrees clockwise", 7: "mirrored and turned",
    8: "turned by 90 degrees counter-clockwise",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Photo:
    """A photograph.

    Parameters
    ----------
    values : (h, w, 3) uint8 array
        RGB, the right way up.
    name : str
        Base name of its file.
    sha256 : str
        Of the file, in hexadecimal digits.
    notices : tuple of Notice
        W173 it was turned as its EXIF data say; W174 its depth was reduced or its alpha ignored.
    """

    values: NDArray[np.uint8]
    name: str
    sha256: str
    notices: tuple[Notice, ...] = ()

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height, px."""
        return self.values.shape[1], self.values.shape[0]


def read_photo(path: str | Path, max_px: int = MAX_PX) -> Photo:
    """Read a JPEG, PNG or TIFF photograph.

    Parameters
    ----------
    path : str or Path
        The file.
    max_px : int
        Larger photographs are refused before they are decoded.

    Raises
    ------
    InputError
        E100 it cannot be read, E106 empty or damaged, E107 no photograph that is known, E109
        several pages, E110 too large.
    """
    path = Path(path)
    data = _bytes_of(path)
    try:
        values, orientation, deep = _decode(data, str(path), max_px)
    except MemoryError as error:
        raise InputError(
            "E110", "there is not enough memory for this photograph.", where=str(path),
            cure="Reduce it.",
        ) from error  # fmt: skip
    except DAMAGE as error:
        raise InputError(
            "E106", f"the file is damaged or cut short ({error}).", where=str(path),
            cure="Copy or export it again.",
        ) from error  # fmt: skip
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
        data = path.read_bytes()
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
    if data.startswith(b"\xff\xd8\xff"):
        return *_by_pillow(JpegImagePlugin.JpegImageFile(io.BytesIO(data)), where, max_px), False
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        found = _by_pillow(PngImagePlugin.PngImageFile(io.BytesIO(data)), where, max_px)
        # Colours of 16 bits come from Pillow as their upper 8.
        return *found, data[24] == 16
    if data.startswith((b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")):
        values, orientation = _tiff(data, where, max_px)
        return values, orientation, values.dtype == np.uint16
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


def _by_pillow(image: Image.Image, where: str, max_px: int) -> tuple[NDArray[Any], int]:
    _check(*image.size, where, max_px)
    orientation = int(image.getexif().get(_ORIENTATION, 1))
    if image.mode in ("1", "CMYK", "YCbCr", "LAB", "HSV"):
        return np.asarray(image.convert("RGB")), orientation
    if image.mode in ("P", "PA"):
        transparent = image.mode == "PA" or "transparency" in image.info
        return np.asarray(image.convert("RGBA" if transparent else "RGB")), orientation
    if image.mode == "I":
        # Pillow reads grey PNG of 16 bits so in some versions.
        return np.asarray(image).astype(np.uint16), orientation
    return np.asarray(image), orientation


def _tiff(data: bytes, where: str, max_px: int) -> tuple[NDArray[Any], int]:
    page = tiff.inspect(data)
    _check(page.width, page.height, where, max_px)
    if page.pages > 1:
        raise several_pages(f"{page.pages} pages", where)
    bits, orientation, negative = _tiff_tags(data)
    if bits <= 8:
        # Pillow turns a TIFF by itself when it reads it: taken back, so that it is said.
        image = TiffImagePlugin.TiffImageFile(io.BytesIO(data))
        values, orientation = _by_pillow(image, where, max_px)
        return _turned(values, _BACK.get(orientation, orientation)), orientation
    if page.unreadable:
        raise InputError(
            "E107", f"TIFF with {page.unreadable} cannot be read.", where=where,
            cure="Export it uncompressed or with LZW.",
        )  # fmt: skip
    if page.colours:
        raise InputError(
            "E107", f"TIFF of {bits} bits a channel in {page.colours} cannot be read.", where=where,
            cure="Export it in RGB, or with 8 bits a channel.",
        )  # fmt: skip
    values = tiff.values(data)
    # Pillow takes this back for 8 bits; ids keep the numbers of the file, light does not.
    if negative and values.dtype == np.uint16:
        grey = np.atleast_3d(values)[..., :1]
        np.subtract(65535, grey, out=grey)
    return values, orientation


def _tiff_tags(data: bytes) -> tuple[int, int, bool]:
    """Return bits of a channel, the orientation, and whether 0 is white."""
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page: Any = file.pages[0]
        tag = page.tags.get(_ORIENTATION)
        turned = 1 if tag is None else int(tag.value)
        negative = page.photometric == tifffile.PHOTOMETRIC.MINISWHITE
        return int(page.bitspersample), turned, negative


_BACK = {6: 8, 8: 6}
"""Orientations whose opposite is another."""


def _turned(values: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Turn a picture as its orientation says."""
    if orientation not in _TURNS:
        return values
    image = Image.fromarray(values)
    image.getexif()[_ORIENTATION] = orientation
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
