"""Stones from a file of outlines: labelling tools, drawings, meshes (see docs/formats.md)."""

import hashlib
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from drystone.errors import InputError, UsageError
from drystone.io.found import Found, stone_set
from drystone.io.outlines_in.model import METRES, OutlineFile, numbered, without_wedges
from drystone.io.outlines_in.raster import rastered
from drystone.io.read_settings import ReadSettings
from drystone.model.stone import Source, StoneSet

MOST_TEXT_BYTES = 500_000_000
"""Larger files of outlines are refused; that of all images of COCO has 450 MB."""


def stones_of(
    read: Callable[[bytes, str, ReadSettings], OutlineFile],
    data: bytes,
    where: str,
    settings: ReadSettings,
) -> StoneSet:
    """Read a file of outlines."""
    if len(data) > MOST_TEXT_BYTES:
        megabytes = f"{len(data) / 1e6:.0f} MB, and the limit is {MOST_TEXT_BYTES / 1e6:g} MB"
        raise InputError(
            "E110", f"it has {megabytes}.", where=where,
            cure="Export the outlines of one image, with fewer corners.",
        )  # fmt: skip
    # What is not finite is refused; NumPy would warn of it as well.
    with np.errstate(all="ignore"):
        file = read(data, where, settings)
    check_unit(file.unit_m, settings, where)
    _check_of_outlines(settings, where)
    if not file.names_images:
        check_no_image(settings, where)
    # Half a character pair can be neither printed nor written.
    named = tuple(replace(stone, name=_printable(stone.name)) for stone in file.stones)
    kept, wedges = without_wedges(named)
    stones, renumbered = numbered(kept)
    drawn = rastered(replace(file, stones=stones), settings, where)
    notices = [*file.notices, *wedges, *renumbered, *drawn.notices]
    source = Source(
        where,
        hashlib.sha256(data).hexdigest(),
        drawn.width,
        drawn.height,
        # What has px of its own has no other resolution.
        reading=(settings if drawn.px_per_m else replace(settings, px_per_m=None)).changed(),
        px_per_m=drawn.px_per_m,
    )
    return stone_set(Found(drawn.patches, notices, where), source, settings)


def _printable(name: str) -> str:
    return name.encode("utf-8", "replace").decode()


def check_unit(unit_m: float | None, settings: ReadSettings, where: str) -> None:
    """Refuse a unit in the settings that is not that of the file (E118)."""
    if not settings.unit:
        return
    asked = METRES.get(settings.unit)
    if asked == unit_m or (asked and unit_m and abs(asked / unit_m - 1.0) < 1e-6):
        return
    own = "px" if unit_m is None else f"a unit of its own ({unit_m:g} m)"
    raise UsageError(
        "E118", f"this file is in {own}, not in {settings.unit}.", where=where,
        cure="Leave the unit out: it is for drawings that do not say theirs.",
    )  # fmt: skip


def check_no_image(settings: ReadSettings, where: str) -> None:
    """Refuse the name of an image where there are none to choose from (E118)."""
    if settings.image:
        raise UsageError(
            "E118", f"there is no choice of images here, as for {settings.image!r}.", where=where,
            cure="Leave --image (image in Python) out: it is for annotations that name their "
            "images (COCO, masks of SAM).",
        )  # fmt: skip


def _check_of_outlines(settings: ReadSettings, where: str) -> None:
    """Refuse what tells stone from background in pictures: outlines say it themselves (E118)."""
    mask = "--no-mask" if settings.mask is False else "--mask"
    for given, option, name in (
        (settings.background != 0, "--background", "background"),
        (settings.mask is not None, mask, "mask"),
    ):
        if given:
            raise UsageError(
                "E118", f"this file says itself what is stone, so {option} has no meaning.",
                where=where,
                cure=f"Leave {option} ({name} in Python) out: it is for pictures of stones.",
            )  # fmt: skip
