"""Stones from a file of outlines: labelling tools, drawings, meshes (see docs/formats.md)."""

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import PurePath
from typing import Any

import numpy as np

from drystone.errors import InputError
from drystone.io.files import foreign, listed, short, too_large, unfit
from drystone.io.images import BEGINNING, format_of
from drystone.io.json_text import json_of
from drystone.io.outlines_in import annotations
from drystone.io.outlines_in.classes import of_classes
from drystone.io.outlines_in.dxf import is_dxf, read_dxf
from drystone.io.outlines_in.meshes import mesh_kind, read_mesh
from drystone.io.outlines_in.model import METRES, OutlineFile, numbered, without_wedges
from drystone.io.outlines_in.raster import in_px, rastered
from drystone.io.outlines_in.svg import is_svg, read_svg
from drystone.io.patches import stone_set
from drystone.io.photo_beside import LABELS, SCHEMA
from drystone.io.read_settings import ReadSettings
from drystone.model.stone import Source, StoneSet

Reader = Callable[[bytes, ReadSettings], OutlineFile]

MOST_TEXT_BYTES = 500_000_000
"""Larger files of outlines are refused; that of all images of COCO has 450 MB."""

_EXPECTED = (
    "labelme (shapes), COCO (annotations, images), masks of SAM (a list with segmentation each), "
    "GeoJSON (type, features), Label Studio, VIA 2 or a nesting instance (items)"
)


def _holds(key: str) -> Callable[[Any], bool]:
    """Return what tells a table with a list of that name."""
    return lambda content: isinstance(content, Mapping) and isinstance(content.get(key), list)


def _is_sam(content: Any) -> bool:
    return isinstance(content, list) and all(
        isinstance(found, Mapping) and "segmentation" in found for found in content
    )


# The first of these that a file is; an empty list is one of masks.
_KINDS: tuple[tuple[Callable[[Any], bool], Callable[[Any, ReadSettings], OutlineFile]], ...] = (
    (_is_sam, annotations.read_sam),
    (annotations.is_label_studio, annotations.read_label_studio),
    (_holds("shapes"), annotations.read_labelme),
    (_holds("annotations"), annotations.read_coco),
    (annotations.is_geojson, annotations.read_geojson),
    (annotations.is_via, annotations.read_via),
    (annotations.is_nesting, annotations.read_nesting),
)


def outline_reader(data: bytes, name: str) -> Reader | None:
    """Return what reads a file of outlines; None when it is none, so perhaps a picture."""
    suffix = PurePath(name).suffix.lower()
    # The two letters of a BMP may begin a text, too.
    if not data or data.startswith(BEGINNING) or format_of(data) not in ("", "BMP"):
        return None
    begins = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
    if suffix in {".json", ".geojson"} or begins in (b"{", b"["):
        return _read_json
    # A drawing names itself; the text of an OBJ is told by its lines, so it comes last.
    readers: tuple[tuple[bool, Reader], ...] = (
        (suffix == ".txt" and annotations.is_yolo(data), annotations.read_yolo),
        (begins == b"<" and annotations.is_cvat(data), annotations.read_cvat),
        (is_svg(data, suffix), read_svg),
        (suffix != ".bmp" and is_dxf(data, suffix), read_dxf),
    )
    for is_one, reader in readers:
        if is_one:
            return reader
    kind = "" if suffix == ".bmp" else mesh_kind(data, suffix)
    return partial(read_mesh, kind) if kind else None


def _read_json(data: bytes, settings: ReadSettings) -> OutlineFile:
    with foreign(lambda why: _no_stones(f"cannot be read, it may be cut short ({why})")):
        content = json_of(data.decode(json.detect_encoding(data), "surrogatepass"))
    for is_one, reader in _KINDS:
        if is_one(content):
            return reader(content, settings)
    raise _no_stones(*_what_else(content))


def _what_else(content: Any) -> tuple[str, ...]:
    """Say what JSON that holds no outlines is, and what to give instead."""
    if not isinstance(content, Mapping):
        return ("has none of the known forms",)
    if content.get("schema") == SCHEMA:
        return f"stands beside the label image {LABELS}", f"Give {LABELS}, or their folder."
    if "steps" in content and "source" in content:
        return "is a plan, made of stones already", "Give the stones, or use it with --from."
    if "blocks" in content or "blocks_xywh" in content:
        return "is a block model of a wall", "Give the stones; `drystone analyse` reads it."
    keys = listed(short(repr(key)) for key in content) or "nothing"
    return (f"has none of the known forms (its keys are {keys})",)


def _no_stones(what: str, cure: str = f"Stones are read from {_EXPECTED}.") -> InputError:
    return InputError("E113", f"this JSON {what}.", cure=cure)


def stones_and_outlines(
    read: Reader, data: bytes, name: str, settings: ReadSettings
) -> tuple[StoneSet, OutlineFile]:
    """Read a file of outlines: stones, and the outlines of those and others under the same ids.

    The source has a scale when the file has a unit.
    """
    if len(data) > MOST_TEXT_BYTES:
        megabytes = f"{len(data) / 1e6:.0f} MB, and the limit is {MOST_TEXT_BYTES / 1e6:g} MB"
        cure = "Export the outlines of one image, with fewer corners."
        raise too_large(f"it has {megabytes}.", cure)
    # What is not finite is refused; NumPy would warn of it as well.
    with np.errstate(all="ignore"):
        file = in_px(read(data, settings), settings)
    check_unit(file.unit_m, settings)
    # Outlines say themselves what tells stone from background in pictures.
    mask = "--no-mask" if settings.mask is False else "--mask"
    for which, option in (("background", "--background"), ("mask", mask)):
        if which in dict(settings.changed()):
            what = f"this file says itself what is stone, so {option} has no meaning."
            cure = f"Leave {option} ({which} in Python) out: it is for pictures of stones."
            raise unfit(what, cure)
    there = {"image": file.names_images, "up": file.in_space}
    check_not_asked(settings, *(option for option, has in there.items() if not has))
    # Half a character pair can be neither printed nor written.
    named = [
        replace(stone, name=stone.name.encode("utf-8", "replace").decode()) for stone in file.stones
    ]
    kept, wedges = without_wedges(named)
    kept, classes = of_classes(kept, settings.label)
    stones, renumbered = numbered(kept)
    file = replace(file, stones=stones)
    patches, size_px, px_per_m, said = rastered(file, settings)
    # What has px of its own has no other resolution.
    reading = (settings if px_per_m else replace(settings, px_per_m=None)).changed()
    px_per_m = px_per_m or file.px_per_m
    digest = hashlib.sha256(data).hexdigest()
    source = Source(name, digest, *size_px, (), reading, px_per_m, file.photograph)
    notices = [*file.notices, *wedges, *classes, *renumbered, *said]
    return stone_set(patches, notices, source, settings), file


def check_unit(unit_m: float | None, settings: ReadSettings) -> None:
    """Refuse a unit in the settings that is not that of the file (E118)."""
    asked = METRES.get(settings.unit)
    same = asked == unit_m or (asked and unit_m and abs(asked / unit_m - 1.0) < 1e-6)
    if settings.unit and not same:
        own = "px" if unit_m is None else f"a unit of its own ({unit_m:g} m)"
        cure = "Leave the unit out: it is for drawings that do not say theirs."
        raise unfit(f"this file is in {own}, not in {settings.unit}.", cure)


_ELSEWHERE = {
    "image": (
        "there is no choice of images here, as for {}.",
        "annotations that name their images (COCO, masks of SAM)",
    ),
    "label": ("a picture of stones has no classes, as {}.", "annotations; --skip leaves out ids"),
    "up": ("this file has no third axis that could be up, as for {}.", "meshes and DXF"),
}
"""Options that have no meaning for some files: what there is not, and what they are for."""


def check_not_asked(settings: ReadSettings, *options: str) -> None:
    """Refuse options that have no meaning for what is read (E118)."""
    for option in options:
        if value := getattr(settings, option):
            what, kinds = _ELSEWHERE[option]
            cure = f"Leave --{option} ({option} in Python) out: it is for {kinds}."
            raise unfit(what.format(repr(value)), cure)
