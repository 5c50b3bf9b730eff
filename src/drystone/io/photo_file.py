"""Photographs as 8-bit RGB, the right way up: of stones, and beside a plan."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

from drystone.errors import InputError, Notice
from drystone.io import images
from drystone.io.files import file_bytes, given_bytes, naming, too_large, unread
from drystone.model.stone import writable

MAX_PX = 200_000_000
"""Larger photographs are refused."""

MAX_SIDE_PX = 32_766
"""Wider or higher ones too: OpenCV turns none that are."""

SAME_SHAPE = 0.02
"""Widths over heights may differ by this share: a photograph of few px rounds them."""

LEAST_JUDGED_PX, PLAIN = 5000, 0.7
"""From so many px on a picture is one of ids if so many neighbours on its stones are equal."""

_REDUCE = "Reduce it or crop it; only in Python can the limit be raised (max_px)."


@dataclass(frozen=True, eq=False)
class Photo:
    """A photograph."""

    values: NDArray[np.uint8]  # (h, w, 3), RGB, the right way up
    name: str  # base name of its file
    sha256: str  # of the file, in hexadecimal digits
    notices: tuple[Notice, ...] = ()
    """W173 it was turned as its EXIF data say; W174 its depth was reduced or its alpha ignored."""

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height, px."""
        return self.values.shape[1], self.values.shape[0]


def read_photo(path: str | Path, max_px: int = MAX_PX) -> Photo:
    """Read a JPEG, PNG or TIFF photograph."""
    path = Path(path)
    with naming(str(path)):
        data = given_bytes(path)
        if not data:
            raise InputError("E106", "the file is empty (0 bytes).", cure="Copy it again.")
        values, orientation = _decode(data, partial(_check, max_px=max_px))
        _refuse_labels(values, path.name)
        rgb, notices = _to_rgb(values)
    name = writable(path.name)
    if orientation in images.TURNS:
        rgb = images.turned(rgb, orientation)
        said = f"{name} was {images.TURNS[orientation]}, as its EXIF data say."
        notices = (*notices, Notice("W173", said))
    return Photo(rgb, name, hashlib.sha256(data).hexdigest(), notices)


def _refuse_labels(values: NDArray[Any], name: str) -> None:
    """Refuse a label image (E175): plain areas of other values on 0; nothing is so even in light.

    Pairs of neighbours of which one is no ground are looked at, and few px are not judged.
    """
    colours = np.atleast_3d(values)
    colours = colours[..., :3] if colours.shape[2] > 2 else colours[..., :1]
    stone = (colours != 0).any(axis=2)
    if stone.size < LEAST_JUDGED_PX or stone.mean() > 0.95:
        return
    pairs = stone[:, :-1] | stone[:, 1:]
    equal = (colours[:, :-1] == colours[:, 1:]).all(axis=2)[pairs]
    if equal.size and equal.mean() > PLAIN:
        what = "this is a label image already, plain areas on 0, and not a photograph."
        raise InputError("E175", what, cure=f"`drystone plan {name}` reads it.")


def _decode(data: bytes, check: Callable[[int, int], None]) -> tuple[NDArray[Any], int]:
    """Return values (palettes and CMYK as RGB) and the orientation."""
    kind = images.format_of(data)
    if kind == "TIFF":
        return _tiff(data, check)
    if kind not in ("JPEG", "PNG"):
        cure = "Export the photograph as JPEG (phones: 'most compatible')."
        raise unread("this is not a JPEG, PNG or TIFF.", cure)
    values, orientation = _by_pillow(data, check)
    if kind == "PNG" and data[24] == 16 and values.dtype == np.uint8:
        # Colours of 16 bits come from Pillow as their upper 8.
        if values[..., :3].max() < 64:
            what = "this PNG has 16 bits a channel, and its colours fill 14 of them or fewer."
            raise unread(what, "Export it with 8 bits a channel, or as TIFF.")
        values = values * np.uint16(257)
    return values, orientation


def _check(width: int, height: int, max_px: int) -> None:
    """Refuse photographs that would fill the memory, or that OpenCV cannot turn (E110)."""
    images.check_size(width, height, max_px, _REDUCE)
    if max(width, height) > MAX_SIDE_PX:
        what = f"{width} x {height} px; the limit of a side is {MAX_SIDE_PX} px."
        raise too_large(what, "Reduce it or crop it.")


def _by_pillow(data: bytes, check: Callable[[int, int], None]) -> tuple[NDArray[Any], int]:
    with images.opened(data, check) as image:
        orientation = int(image.getexif().get(images.ORIENTATION, 1))
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


def _tiff(data: bytes, check: Callable[[int, int], None]) -> tuple[NDArray[Any], int]:
    page = images.inspect_tiff(data, check)
    if page.bits <= 8:
        # Pillow turns a TIFF by itself when it reads it: taken back, so that it is said.
        values, orientation = _by_pillow(data, check)
        return images.turned(values, images.TURNED_BACK.get(orientation, orientation)), orientation
    if page.unreadable:
        what = f"TIFF with {page.unreadable} cannot be read."
        cure = "Export it with 8 or 16 bits a channel, uncompressed or with LZW."
        raise unread(what, cure)
    if page.colours:
        what = f"TIFF of {page.bits} bits a channel in {page.colours} cannot be read."
        raise unread(what, "Export it in RGB, or with 8 bits a channel.")
    values = images.tiff_values(data, page, check)
    # Pillow takes this back for 8 bits; ids keep the numbers of the file, light does not.
    if page.negative and values.dtype == np.uint16:
        values = values.copy()
        grey = np.atleast_3d(values)[..., :1]
        np.subtract(_white(values), grey, out=grey)
    return values, page.orientation


def _white(values: NDArray[Any]) -> int:
    """Return the largest number of 16 bits, or of the 10, 12 or 14 that a camera fills."""
    bits = int(values.max()).bit_length()
    return (1 << max(8, bits + bits % 2)) - 1


def _to_rgb(values: NDArray[Any]) -> tuple[NDArray[np.uint8], tuple[Notice, ...]]:
    """Return three channels of 8 bits, and what was lost."""
    notices: list[Notice] = []
    values = values[..., None] if values.ndim == 2 else values
    if values.dtype == np.uint16:
        white = _white(values)
        values = (np.arange(white + 1) * 255 / white).round().astype(np.uint8)[values]
        notices.append(Notice("W174", f"16 bits a channel were scaled to 8: white is {white}."))
    if values.dtype != np.uint8 or values.ndim != 3 or not 1 <= values.shape[2] <= 4:
        what = f"values of type {values.dtype} are not those of a photograph."
        raise unread(what, "Export it with 8 or 16 bits a channel.")
    if values.shape[2] in (2, 4):
        if (values[..., -1] < 255).any():
            cure = "Where it cuts the stones out, give the picture itself to `drystone plan`."
            notices.append(Notice("W174", "Transparency was ignored.", cure))
        values = values[..., :-1]
    if values.shape[2] == 1:
        values = np.repeat(values, 3, axis=2)
    return np.ascontiguousarray(values), tuple(notices)


def read_photo_picture(photo: Path, source_px: tuple[float, float]) -> Image.Image:
    """Read the photograph beside a plan as RGB, turned as its EXIF data say.

    It shows the whole source image, of `source_px` (width, height), at any resolution; one that
    cannot be read, or has another shape, is refused (E189).
    """
    try:
        with images.opened(file_bytes(photo), partial(images.check_size, max_px=MAX_PX)) as read:
            image = ImageOps.exif_transpose(read).convert("RGB")
    except (InputError, OSError) as error:
        why = f"{error.strerror}." if isinstance(error, OSError) else error.what
        raise _of_no_use(photo, f"the photograph cannot be read: {why}") from error
    width, height = source_px
    ratio = (image.width / image.height) / (width / height) if width and height else 0.0
    if abs(ratio - 1.0) > SAME_SHAPE:
        raise _of_no_use(
            photo,
            f"the photograph has {image.width} x {image.height} px and shows something else than "
            f"the source image of {width:g} x {height:g} px.",
        )
    return image


def _of_no_use(photo: Path, what: str) -> InputError:
    cure = "Remove the file, or put the photograph there that the stones were found in."
    return InputError("E189", what, where=photo.name, cure=cure)
