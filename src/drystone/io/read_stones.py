"""Read stones from pictures, arrays, and files of outlines (paper §3.3; DESIGN 4.1)."""

import hashlib
import json
import math
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io import checks, masks
from drystone.io.files import foreign, given_bytes, listed, naming, short, too_large, unfit
from drystone.io.images import BEGINNING, FORMATS, SUFFIXES, Picture, decode, format_of
from drystone.io.json_text import json_in, json_of
from drystone.io.labels import Census, IdImage, check_no_zero, components, to_ids
from drystone.io.outlines_in import annotations
from drystone.io.outlines_in.classes import of_classes
from drystone.io.outlines_in.dxf import is_dxf, read_dxf
from drystone.io.outlines_in.meshes import mesh_kind, read_mesh
from drystone.io.outlines_in.model import METRES, OutlineFile, numbered, without_wedges
from drystone.io.outlines_in.raster import in_px, rastered
from drystone.io.outlines_in.svg import read_svg
from drystone.io.patches import (
    MIN_AREA_PX,
    StonePatch,
    check_count,
    cut,
    smallest_stone_px,
    stone_set,
)
from drystone.io.photo_beside import LABELS, PAGE, SCHEMA, read_sidecar, scale_beside
from drystone.io.read_settings import ReadSettings
from drystone.model.stone import Source, StoneSet, writable

__all__ = ["ReadSettings", "read_stones"]


def read_stones(
    source: str | Path | NDArray[Any], *, settings: ReadSettings | None = None
) -> StoneSet:
    """Read stones.

    Parameters
    ----------
    source : str, Path or array
        A label image, a picture of ids in colours, a binary mask (PNG, TIFF, BMP, GIF, NPY, NPZ),
        a folder of one-stone masks, an array like one of these; annotations (labelme, COCO, SAM,
        GeoJSON, Label Studio, VIA, CVAT, YOLO), a drawing (DXF, SVG), a mesh (OBJ, PLY, STL); or
        what `drystone segment` wrote.  The content tells them apart.
    settings : ReadSettings, optional
        Background, holes, pieces, units and the like.

    Returns
    -------
    StoneSet
        The stones under the picture's own ids; components of a mask are numbered in row order,
        masks of a folder in natural file order from 1; outlines keep the numbers of their file
        when all have different ones, else they are numbered in its order.  Its notices list every
        pixel that was left out or added.  Its source has a scale when the file says so itself.

    Raises
    ------
    LabelImageError, InputError
        E100 ... E118, see ``docs/errors.md``.
    UsageError
        E118 when the settings do not fit what is read.

    Examples
    --------
    >>> labels = np.zeros((40, 60), np.uint32)
    >>> labels[5:20, 5:30], labels[20:35, 10:50] = 300, 70000
    >>> [(stone.id, stone.area_px) for stone in read_stones(labels)]
    [(300, 375), (70000, 600)]
    """
    settings = settings or ReadSettings()
    if not isinstance(source, str | Path):
        return _read_array(source, settings)
    path = Path(source)
    if path.is_dir():
        labels = path / LABELS
        if read_sidecar(labels) is None:
            # Also of a folder that is given as "." or "..".
            name = path.resolve().name if path.name in ("", "..") else path.name
            with naming(writable(name)):
                return _read_folder(path, writable(name), settings)
        path = labels
    data, name = given_bytes(path), writable(path.name)
    with naming(name):
        reader = outline_reader(data, name)
        if reader is not None:
            return stones_and_outlines(reader, data, name, settings)[0]
        sidecar = read_sidecar(path)
        if masks.is_npz(data):
            arrays = masks.read_npz(data, settings.max_px)
            if isinstance(arrays, OutlineFile):
                return stones_and_outlines(lambda *_: arrays, data, name, settings)[0]
            picture = Picture(arrays)
        else:
            picture = decode(data, settings.max_px)
        # What has no two sides is refused below.
        scale = scale_beside(sidecar, picture.values.shape[1::-1], path)
        photograph = () if sidecar is None else sidecar.photograph
        digest = hashlib.sha256(data).hexdigest()
        del data  # as large as the picture when it is not compressed
        taken = Source(name, digest, px_per_m=scale, photograph=photograph)
        found = _read_picture(picture, taken, settings)
    if sidecar is None or not sidecar.doubtful:
        return found
    text = f"what was found in the photograph is doubtful: {'; '.join(sidecar.doubtful)}."
    notice = Notice("W183", text, f"Correct it in {PAGE} beside it, and give what that saves.")
    return replace(found, notices=(notice, *found.notices))


def _of_px(settings: ReadSettings) -> tuple[tuple[str, Any], ...]:
    """Return what a plan must keep of the settings with which a picture was read."""
    _check_asked(None, {"image": False, "label": False, "up": False}, settings)
    return replace(settings, px_per_m=None).changed()


def _read_array(array: Any, settings: ReadSettings) -> StoneSet:
    if isinstance(array, np.ma.MaskedArray):
        array = array.filled(settings.background)
    values = np.ascontiguousarray(array)
    digest = hashlib.sha256(repr((values.shape, values.dtype.str)).encode())
    if values.dtype.kind in "biuf":
        digest.update(values.data.cast("B") if values.size else b"")
    with naming("array"):
        return _read_picture(Picture(values), Source("", digest.hexdigest()), settings)


def _read_picture(picture: Picture, source: Source, settings: ReadSettings) -> StoneSet:
    """Read a picture of several stones: a mask or ids."""
    reading = _of_px(settings)
    image = to_ids(picture, settings.background)
    height, width = image.ids.shape
    given = image.census.values
    image, binary = _checked(image, picture.lossy, settings)
    if binary is None:
        values = image.census.values
        check_count(len(values) - 1)
        # What became background is left out already.
        skip = tuple(i for i in settings.skip if i in values or i not in given)
        settings = replace(settings, skip=skip)
        check_no_zero(image)
        ids = np.where(values == image.background, 0, values)
        patches = cut(image.census.index, ids, skip=skip)
        notices = image.notices
    else:
        labels, count = components(binary.mask)
        check_count(count)
        patches = cut(labels, np.arange(1, count + 1), skip=settings.skip)
        least_px = math.ceil(smallest_stone_px(patches, settings, mask=True))
        settings = replace(settings, min_area_px=least_px)
        between = ""
        if binary.between_px:
            between = f"; {binary.between_px} px of values between them went to the nearer one"
        said = f"{binary.background} background, {binary.stone} stone{between}"
        text = f"read as a binary mask ({said}): {count} components, numbered in row order."
        notices = (*image.said, Notice("W114", text))
    source = replace(source, width_px=width, height_px=height, reading=reading)
    return stone_set(patches, notices, source, settings)


def _checked(
    image: IdImage, lossy: bool, settings: ReadSettings
) -> tuple[IdImage, masks.BinaryMask | None]:
    """Refuse what is no picture of stones; return it repaired, and the mask if it is one."""
    checks.check_not_uniform(image)
    if lossy and not settings.mask:
        checks.check_not_lossy(image)
    if settings.mask is not False:
        image = checks.cut_out(image)
    binary = masks.find_mask(image, settings.mask, lossy=lossy)
    if binary is None:
        checks.check_not_photo(image.census)
        if settings.mask is None and (net := checks.without_net(image)) is not image:
            image = net
            checks.check_not_uniform(image)
            binary = masks.find_mask(image, None)
    if binary is None:
        checks.check_background(image.census, image.background, rim_px=int(image.has_edges))
        image = checks.without_blends(image, settings.min_area_px or MIN_AREA_PX)
        checks.check_not_resampled(image)
    else:
        ends = np.array([binary.background, binary.stone])
        checks.check_background(
            Census(binary.mask.view(np.uint8) + np.uint8(1), ends), binary.background
        )
    return image, binary


def _read_folder(folder: Path, name: str, settings: ReadSettings) -> StoneSet:
    """Read one-stone masks, numbered from 1 in natural file order."""
    content = None
    with suppress(OSError, ValueError):
        content = json_in(folder / "plan.json")
    if _is_plan(content):
        raise InputError("E113", "this folder is a plan, made of stones already.", cure=_OF_PLAN)
    entries = [entry for entry in folder.iterdir() if not entry.name.startswith(".")]
    files = [entry for entry in entries if entry.is_file() and entry.suffix.lower() in SUFFIXES]
    if not files:
        cure = f"Stones are read from {FORMATS}."
        raise InputError("E111", "the folder has no pictures in it.", cure=cure)
    files.sort(key=_natural_order)
    ignored = sorted({entry.name for entry in entries} - {file.name for file in files})
    notices = []
    if ignored:
        notices.append(Notice("W117", f"not pictures, left aside: {writable(listed(ignored))}."))
    digest, patches, sizes = hashlib.sha256(), [], []
    doubtful: dict[int, LabelImageError] = {}
    names = tuple(writable(file.name) for file in files)
    for number, (file, own) in enumerate(zip(files, names, strict=True), start=1):
        data = given_bytes(file)
        digest.update(hashlib.sha256(data).digest())
        where = f"{name}/{own}"
        with naming(where):
            picture = decode(data, settings.max_px)
            said: tuple[Notice, ...] = ()
            try:
                mask, said = _mask_of_one(picture, where, settings)
            except LabelImageError as error:
                if error.code != "E105":
                    raise
                error.where = where
                doubtful[number] = error
                mask = masks.ground_in(picture, settings.background)
        sizes.append(mask.shape)
        notices += said
        patches += cut(mask.astype(np.int32), np.array([number]), own) or [
            StonePatch(np.zeros((1, 1), bool), 0, 0, number, len(mask), name=own)
        ]
    patches, left_out = masks.without_others(patches, sizes, doubtful, settings)
    notices += left_out
    height, width = np.max(sizes, axis=0).tolist()
    source = Source(name, digest.hexdigest(), width, height, names, _of_px(settings))
    return stone_set(patches, notices, source, settings, range(1, len(files) + 1))


def _natural_order(path: Path) -> tuple[list[str | int], str]:
    parts = re.split(r"([0-9]+)", path.name.casefold())
    # Numbers are every other part; between them there may be digits of other scripts.
    return [int(part) if i % 2 else part for i, part in enumerate(parts)], path.name


def _mask_of_one(
    picture: Picture, where: str, settings: ReadSettings
) -> tuple[NDArray[np.bool_], tuple[Notice, ...]]:
    """Read the mask, (h, w), of one stone; an empty one has no pixel."""
    image = to_ids(picture, settings.background)
    height, width = image.ids.shape
    value = int(image.ids.flat[0])
    if (image.ids == value).all():
        full = value != image.background
        text = f"{where} is stone to all its edges ({width} x {height} px of {value})."
        notice = Notice("W118", text, "Check that it is not an empty picture.")
        return np.full((height, width), full), (notice,) if full else ()
    # mask=False is about pictures of many stones: here every picture is a mask.
    image, binary = _checked(image, picture.lossy, ReadSettings(mask=settings.mask or None))
    said = tuple(replace(notice, message=f"{where}: {notice.message}") for notice in image.said)
    if binary is not None:
        return binary.mask, said
    values = image.census.values
    if len(values) == 2:
        return image.ids != image.background, said
    what = f"{len(values)} values in a mask of one stone."
    cure = "A folder holds one black-and-white mask a stone; give a label image by itself."
    raise LabelImageError("E111", what, cure=cure)


Reader = Callable[[bytes, ReadSettings], OutlineFile]

FEW_PX = 100
"""Drawings that are smaller are hardly in px."""

MOST_TEXT_BYTES = 500_000_000
"""Larger files of outlines are refused; that of all images of COCO has 450 MB."""

_EXPECTED = (
    "labelme (shapes), COCO (annotations, images), masks of SAM (a list with segmentation each), "
    "GeoJSON (type, features), Label Studio, VIA 2 or a nesting instance (items)"
)


_OF_PLAN = "Give the stones, or use it with --from."


def _is_plan(content: Any) -> bool:
    return isinstance(content, Mapping) and content.keys() >= {"steps", "source"}


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
    head, begins = data[:4096], data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
    if suffix in {".json", ".geojson"} or begins in (b"{", b"["):
        return _read_json
    # A drawing names itself; the text of an OBJ is told by its lines, so it comes last.
    readers: tuple[tuple[bool, Reader], ...] = (
        (suffix == ".txt" and bool(annotations.YOLO.match(data)), annotations.read_yolo),
        (begins == b"<" and b"<annotations" in head, annotations.read_cvat),
        (suffix == ".svg" or b"<svg" in head or b":svg" in head, read_svg),
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
    if _is_plan(content):
        return "is a plan, made of stones already", _OF_PLAN
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
    there = {"background": False, "mask": False, "image": file.names_images, "up": file.in_space}
    _check_asked(file.unit_m, there, settings)
    # Half a character pair can be neither printed nor written.
    named = [
        replace(stone, name=stone.name.encode("utf-8", "replace").decode()) for stone in file.stones
    ]
    kept, wedges = without_wedges(named)
    kept, classes = of_classes(kept, settings.label)
    stones, renumbered = numbered(kept)
    file = replace(file, stones=stones)
    if renumbered:
        # What is no stone needs no number; nor may numbers depend on what is skipped or kept.
        found, *_ = rastered(file, replace(settings, skip=(), keep=()))
        left = {stone.id or 0 for stone in stones} - {patch.id for patch in found}
        stones, renumbered = numbered(kept, left)
        file = replace(file, stones=stones)
    patches, size_px, px_per_m, said = rastered(file, settings)
    # What has px of its own has no other resolution.
    reading = (settings if px_per_m else replace(settings, px_per_m=None)).changed()
    px_per_m = px_per_m or file.px_per_m
    digest = hashlib.sha256(data).hexdigest()
    source = Source(name, digest, *size_px, (), reading, px_per_m, file.photograph)
    notices = [*file.notices, *wedges, *classes, *renumbered, *said]
    taken = {stone.id or 0 for stone in stones}
    larger = "Give a larger --px-per-m (px_per_m in Python). "
    if file.unit_m is None:
        few = max(size_px) < FEW_PX
        larger = "Say --unit m if its lengths are metres (unit in Python). " if few else ""
    return stone_set(patches, notices, source, settings, taken, larger), file


_SAID = "this file says itself what is stone, so {option} has no meaning.", "pictures of stones"
_ELSEWHERE = {
    "background": _SAID,
    "mask": _SAID,
    "image": (
        "there is no choice of images here, as for {value!r}.",
        "annotations that name their images (COCO, masks of SAM)",
    ),
    "label": (
        "a picture of stones has no classes, as {value!r}.",
        "annotations; --skip leaves out ids",
    ),
    "up": ("this file has no third axis that could be up, as for {value!r}.", "meshes and DXF"),
}
"""Options that have no meaning for some files: what there is not, and what they are for."""


def _check_asked(unit_m: float | None, there: Mapping[str, bool], settings: ReadSettings) -> None:
    """Refuse a unit that is not that of the file, and options for what is not `there` (E118)."""
    asked = METRES.get(settings.unit)
    same = asked == unit_m or (asked and unit_m and abs(asked / unit_m - 1.0) < 1e-6)
    if settings.unit and not same:
        own = "px" if unit_m is None else f"a unit of its own ({unit_m:g} m)"
        cure = "Leave the unit out: it is for drawings that do not say theirs."
        raise unfit(f"this file is in {own}, not in {settings.unit}.", cure)
    for name, has in there.items():
        value = getattr(settings, name)
        if not has and (value or value is False):
            what, kinds = _ELSEWHERE[name]
            option = "--no-mask" if value is False else f"--{name}"
            cure = f"Leave {option} ({name} in Python) out: it is for {kinds}."
            raise unfit(what.format(option=option, value=value), cure)
