"""The photograph beside a plan as a picture of the source image."""

from functools import partial
from pathlib import Path

from PIL import Image, ImageOps

from drystone.errors import InputError
from drystone.io.file_bytes import file_bytes
from drystone.io.photo_file import MAX_PX
from drystone.io.pictures import check_size, opened

SAME_SHAPE = 0.02
"""Widths over heights may differ by this share: a photograph of few px rounds them."""


def read_photo_picture(photo: Path, source_px: tuple[float, float]) -> Image.Image:
    """Read the photograph of the stones as RGB, turned as its EXIF data say."""
    try:
        check = partial(check_size, where=photo.name, max_px=MAX_PX)
        with opened(file_bytes(photo), photo.name, check) as read:
            image = ImageOps.exif_transpose(read).convert("RGB")
    except InputError as error:
        raise _unusable(photo, f"the photograph cannot be read: {error.what}") from error
    except OSError as error:
        raise _unusable(photo, f"the photograph cannot be read ({error.strerror}).") from error
    width, height = source_px
    ratio = (image.width / image.height) / (width / height) if width and height else 0.0
    if abs(ratio - 1.0) > SAME_SHAPE:
        raise _unusable(
            photo,
            f"the photograph has {image.width} x {image.height} px and shows something else than "
            f"the source image of {width:g} x {height:g} px.",
        )
    return image


def _unusable(path: Path, what: str) -> InputError:
    return InputError(
        "E189", what, where=path.name,
        cure="Remove the file, or put the photograph there that the stones were found in.",
    )  # fmt: skip
