"""TIFF pages to values: tifffile where it can, Pillow for the codecs that it lacks."""

import io
from dataclasses import dataclass
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import TiffImagePlugin
from PIL.Image import Transpose

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

_ORIENTATION = 0x0112
_BACK = {
    2: Transpose.FLIP_LEFT_RIGHT, 3: Transpose.ROTATE_180, 4: Transpose.FLIP_TOP_BOTTOM,
    5: Transpose.TRANSPOSE, 6: Transpose.ROTATE_90, 7: Transpose.TRANSVERSE,
    8: Transpose.ROTATE_270,
}  # fmt: skip
"""What takes back the turn of an orientation."""


@dataclass(frozen=True)
class TiffPage:
    """What must be known before a TIFF is decoded.

    Parameters
    ----------
    width, height : int
        Size in px.
    pages : int
        Number of pictures (planes, slices, pages).
    lossy : bool
        True for JPEG inside TIFF.
    unreadable : str
        Why it cannot be decoded without loss; empty when it can.
    colours : str
        Colour mode that holds no ids, such as CMYK; empty for all others.
    alpha : bool
        True when the last channel is transparency, and says so.
    """

    width: int
    height: int
    pages: int
    lossy: bool
    unreadable: str
    colours: str = ""
    alpha: bool = False


def inspect(data: bytes) -> TiffPage:
    """Read the tags of a TIFF and decode nothing."""
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page: Any = file.pages[0]
        series = file.series[0]
        planes = [n for axis, n in zip(series.axes, series.shape, strict=True) if axis not in "YXS"]
        compression = int(page.compression)
        lossy = compression in _LOSSY
        unreadable = ""
        if compression not in _BY_TIFFFILE | _BY_PILLOW | _LOSSY:
            unreadable = f"compression {page.compression.name}"
        elif (
            compression not in _BY_TIFFFILE and page.samplesperpixel > 1 and page.bitspersample > 8
        ):
            unreadable = f"{page.bitspersample} bits a colour channel and compression"
        return TiffPage(
            width=int(page.imagewidth),
            height=int(page.imagelength),
            pages=max(len(file.series), int(np.prod(planes, dtype=int))),
            lossy=lossy,
            unreadable=unreadable,
            colours="" if lossy and page.photometric == 6 else _NO_IDS.get(page.photometric, ""),
            alpha=bool(page.extrasamples) and int(page.extrasamples[-1]) in _TRANSPARENCY,
        )


def values(data: bytes) -> NDArray[Any]:
    """Decode the only page of a TIFF, channels last; palette indices and numbers are kept.

    Pixels are where the file has them: its orientation turns nothing, however it is compressed.
    """
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page: Any = file.pages[0]
        series = file.series[0]
        if int(page.compression) not in _BY_TIFFFILE:
            return _values_by_pillow(data, page)
        found = np.asarray(series.asarray())
        keep = [i for i, axis in enumerate(series.axes) if axis in "YXS"]
        found = found.reshape([found.shape[i] for i in keep])
        if "S" in series.axes and series.axes.index("S") < series.axes.index("Y"):
            found = np.moveaxis(found, 0, -1)
        return found


def _values_by_pillow(data: bytes, page: Any) -> NDArray[Any]:
    image = TiffImagePlugin.TiffImageFile(io.BytesIO(data))
    # Pillow turns a picture when it loads it.
    back = _BACK.get(image.getexif().get(_ORIENTATION, 1))
    found = np.asarray(image if back is None else image.transpose(back))
    if page.bitspersample == 32 and int(page.sampleformat) == 1:
        # Pillow has no unsigned 32-bit mode: the bits are right, the sign is not.
        found = found.view(np.uint32)
    if int(page.photometric) == 0 and image.mode in ("1", "L"):
        # Pillow inverts white-is-zero pictures; values are the file's own, as in tifffile.
        found = ~found
    return found
