"""Coordinates that are shares of the picture, 0 ... 1, as YOLO and others write them."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from drystone.errors import InputError, Notice
from drystone.io.file_bytes import file_bytes
from drystone.io.file_errors import naming
from drystone.io.outlines_in.model import OutlineFile
from drystone.io.pictures import format_of, opened
from drystone.io.read_settings import ReadSettings
from drystone.io.tiff import ORIENTATION

_BEYOND = 0.5
"""How far an outline may reach over the picture, as a share of it."""


def in_px(file: OutlineFile, settings: ReadSettings) -> OutlineFile:
    """Return a file whose shares are px; all others as they are.

    They are told by the whole file: in px, no stone of it would have a pixel.  Its proportions are
    those of the picture; where the file does not say its size (E116), `image` names the picture.
    """
    if not _are_shares(file):
        return file
    size = file.size_px or _size_of(settings.image)
    if size is None:
        raise InputError(
            "E116",
            "its coordinates are shares of a picture (0 ... 1), and it does not say its size.",
            cure="Name the picture with --image PHOTO.jpg (ReadSettings.image), or export in px.",
        )
    stones = [stone.moved(lambda ring: np.asarray(ring * size)) for stone in file.stones]
    text = f"its coordinates are shares of the picture: taken times {size[0]} x {size[1]} px."
    return replace(file, stones=stones, size_px=size, notices=[*file.notices, Notice("W119", text)])


def _are_shares(file: OutlineFile) -> bool:
    if (
        file.unit_m is not None
        or file.seen_by == "none"
        or any(stone.masks for stone in file.stones)
    ):
        return False
    rings = [ring for stone in file.stones for ring in stone.rings]
    if not rings or (file.size_px and max(file.size_px) < 3):
        return False
    points = np.concatenate(rings)
    return bool(points.min() >= -_BEYOND and points.max() <= 1.0 + _BEYOND)


def _size_of(image: str) -> tuple[int, int] | None:
    """Return width and height of a picture as it is seen; None when no file is named."""
    path = Path(image)
    if not image or not path.is_file():
        return None
    data = file_bytes(path)
    if not format_of(data):
        return None
    with naming(path.name), opened(data, lambda *_: None) as picture:
        width, height = picture.size
        turned = picture.getexif().get(ORIENTATION, 1) in {5, 6, 7, 8}
    return (height, width) if turned else (width, height)
