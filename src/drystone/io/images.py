"""Bytes of a picture file to its values, unchanged: no palette applied, no depth lost."""

import io
import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io import tiff
from drystone.io.file_errors import damaged, several_pages, unread
from drystone.io.foreign import foreign
from drystone.io.pictures import check_size, format_of, opened
from drystone.io.tiff import ORIENTATION, TURNS, turned

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
        raise unread(
            "this PNG has 16 bits a colour channel, which cannot be read without loss.",
            "Export the ids as 16-bit grey PNG, as 8-bit RGB PNG or as TIFF.",
        )
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
    parts = clear if isinstance(clear, tuple) else (clear,)
    planes = np.moveaxis(np.atleast_3d(values), -1, 0)
    if len(planes) != len(parts):
        return None
    seen = np.zeros(values.shape[:2], bool)
    for plane, part in zip(planes, parts, strict=True):
        seen |= plane != (bool(part) if values.dtype == bool else part)
    return seen.view(np.uint8) * np.uint8(255)


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
    values, alpha = tiff.values(data, page, check), None
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
        raise _pickled(data)
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


def _pickled(data: bytes) -> InputError:
    """Make the error for objects of Python; the masks of cellpose lie in such."""
    cellpose = all(name in data for name in (b"masks", b"outlines"))
    what = "objects of cellpose (_seg.npy)" if cellpose else "Python objects"
    masks = "Save masks as PNG" if cellpose else "Save the array of ids by itself"
    return unread(
        f"it holds {what}, and pickle is not read, as it may run programs.",
        f"Export the masks: in the cellpose window 'File > {masks}', or in Python "
        "`np.save('masks.npy', np.load(FILE, allow_pickle=True).item()['masks'])`."
        if cellpose
        else f"{masks}, as whole numbers.",
    )
