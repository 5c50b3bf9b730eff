"""Annotations in JSON: labelme, COCO, the automatic masks of Segment Anything (SAM)."""

import base64
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io.file_errors import MANY, entry, listed
from drystone.io.outlines_in.fill import Room, trimmed
from drystone.io.outlines_in.gathered import Gathered, Pictured, chosen
from drystone.io.outlines_in.model import (
    MOST_PX,
    OutlineFile,
    ellipse,
    number_in,
    place_px,
    rectangle,
    size_px,
)
from drystone.io.patches import PlacedMask
from drystone.io.photo_beside import photograph_in
from drystone.io.pictures import check_size, opened
from drystone.io.read_settings import MOST_PX_PER_M, ReadSettings

_MARKED = {"proposed": "proposals that nobody accepted", "not_used": "marked as not to be used"}
_BACK = "Open the file in outlines.html to change that."
_OF_MODEL = ("predicted_iou", "stability_score")
_MOST_PX_OF_MASK = 2**31
_AT_ONCE = 64


def read_labelme(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons, rectangles, circles and masks.

    Shapes of one label and ``group_id`` are one stone.  A label that is a number, also after
    the word stone, is its id.  The table ``drystone`` is that of our own page of outlines.
    """
    gathered = Gathered(settings)
    for number, shape in enumerate(content["shapes"]):
        with entry(f"shape {number} (from 0)"):
            kind, label = shape.get("shape_type") or "polygon", str(shape.get("label") or "")
            group = None if shape.get("group_id") is None else (label, str(shape["group_id"]))
            if kind == "mask":
                gathered.labelled("", label, _mask(shape, gathered.room), group)
            elif (corners := _corners(kind, shape["points"])) is not None:
                gathered.labelled(f"shape {number}", label, [[corners]], group)
            else:
                gathered.aside[f"{kind}s"] += 1
    with entry("the size of the image"):
        size = size_px(content.get("imageWidth"), content.get("imageHeight"))
    with entry("the table drystone"):
        file = gathered.file(size_px=size, names_images=False)
        return _of_page(file, content.get("drystone") or {})


def _of_page(file: OutlineFile, own: Mapping[str, Any]) -> OutlineFile:
    """Take scale and ground from what our page of outlines adds, and leave out what it marks."""
    kept, notices = file.stones, list(file.notices)
    for key, why in _MARKED.items():
        marked = frozenset(own.get(key) or ())
        if left := [stone.id for stone in kept if stone.id in marked]:
            kept = [stone for stone in kept if stone.id not in marked]
            notices.append(Notice("W119", f"{why}, left out: {listed(left, most=MANY)}.", _BACK))
    scale, ends = own.get("px_per_m"), own.get("ground")
    if scale is not None and not 0.0 < float(scale) <= MOST_PX_PER_M:
        raise ValueError(f"{scale} px in a metre")
    ground = None if ends is None else np.array(ends, float).reshape(2, 2)
    if ground is not None and not (np.ptp(ground[:, 0]) > 0.0 and np.abs(ground).max() <= MOST_PX):
        raise ValueError("the ground is not a line from left to right")
    file = replace(file, stones=kept, notices=notices, photograph=photograph_in(own))
    return replace(file, px_per_m=scale and float(scale), ground=ground)


def _corners(kind: str, points: Any) -> Any:
    """Return the corners of a shape; None when it encloses nothing."""
    # X-AnyLabeling writes all four corners of a rectangle, also of one that is turned.
    if kind == "rectangle" and len(points) != 4:
        return rectangle(*points)
    if kind == "circle":
        (x, y), (on_x, on_y) = points
        return ellipse((x, y), (math.hypot(on_x - x, on_y - y),) * 2)
    kinds = {"polygon", "rectangle", "oriented_rectangle", "rotation"}
    return points if kind in kinds else None


def _mask(shape: Mapping[str, Any], room: Room) -> PlacedMask:
    """Return a shape that is a picture within a box, as a model draws it."""

    def check(width: int, height: int) -> None:
        check_size(width, height, room.max_px)
        room.take(width * height)

    (x0, y0), _ = shape["points"]
    data = base64.b64decode(shape["mask"], validate=True)
    try:
        with opened(data, check) as image:
            mask = np.asarray(image.convert("L")) > 0
    except InputError as error:
        if error.code == "E110":
            raise
        raise ValueError(f"its mask is not a picture: {error.what}") from error
    return PlacedMask(mask, place_px(y0), place_px(x0))


def _outline(segmentation: Any, room: Room) -> tuple[Any, tuple[int, int] | None]:
    """Return polygons, or a mask of run lengths or rows, which take of the room, and its size.

    Rows of truth values are told from polygons, which have at least 6 numbers that are none.
    """
    if isinstance(segmentation, Mapping) and "counts" in segmentation:
        return mask_of(segmentation, room), _size_of(segmentation)
    first = segmentation[0] if isinstance(segmentation, list) and segmentation else None
    if isinstance(first, list) and all(value in (0, 1) for value in first):
        rows = np.asarray(segmentation)
        if rows.ndim != 2 or rows.dtype.kind not in "biu":
            raise ValueError("its rows are not of one length, or of no truth values")
        return trimmed(PlacedMask(rows.astype(bool), 0, 0)), (rows.shape[1], rows.shape[0])
    if any(len(flat) % 2 for flat in segmentation):
        raise ValueError("a polygon has an odd number of coordinates")
    return [[list(zip(flat[0::2], flat[1::2], strict=True))] for flat in segmentation], None


def read_coco(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read the annotations of one image.

    Polygons of one annotation are united, which is COCO's own rule: it has no holes but in run
    lengths.  Files that the automatic masks of SAM were released in have ``image`` instead of
    ``images``; their masks may lie in each other, as those of :func:`read_sam`.
    """
    picture = _picture_of(content, settings.image)
    with entry("the list of categories"):
        classes = {c.get("id"): str(c.get("name", "")) for c in content.get("categories") or ()}
    by_model = any(name in found for found in picture.shapes for name in _OF_MODEL)
    return _annotated(picture, settings, "annotation", classes, by_model=by_model)


def read_sam(content: list[Mapping[str, Any]], settings: ReadSettings) -> OutlineFile:
    """Read a list of masks, numbered from 1 in the order of the file.

    Masks may lie in each other: what is ground, a group or a part of a stone is left out as
    :func:`~drystone.io.outlines_in.nested.not_stones` says.
    """
    named = any(found.get("image_id", "") != "" for found in content)
    picture = _picture_of({"annotations": content}, settings.image if named else "")
    shapes = [{**found, "id": number} for number, found in enumerate(picture.shapes, start=1)]
    picture = replace(picture, shapes=shapes)
    file = _annotated(picture, settings, "mask", {}, by_model=True)
    return replace(file, names_images=named)


def _annotated(
    picture: Pictured,
    settings: ReadSettings,
    what: str,
    classes: Mapping[Any, str],
    *,
    by_model: bool,
) -> OutlineFile:
    gathered, masks_of_crowds, sizes = Gathered(settings), 0, {picture.size_px}
    only_crowds = all(map(_is_crowd, picture.shapes))
    for number, found in enumerate(picture.shapes):
        where = f"{what} {found.get('id', number)}"
        with entry(where):
            segmentation = found.get("segmentation")
            if _is_crowd(found):
                # CVAT (datumaro) calls every mask a crowd; the attributes are its own, too.
                runs = isinstance(segmentation, Mapping) and "counts" in segmentation
                if not runs or not (only_crowds or "attributes" in found):
                    gathered.aside["crowd regions (several stones as one)"] += 1
                    continue
                masks_of_crowds += 1
            if not segmentation:
                gathered.aside["annotations without an outline"] += 1
                continue
            label = classes.get(found.get("category_id"), "")
            name = label if len(classes) > 1 else ""
            outline, size = _outline(segmentation, gathered.room)
            sizes.add(size)
            gathered.add(where, outline, number_in(found.get("id")), name, label)
    notices = gathered.notices()
    if masks_of_crowds:
        text = f"{masks_of_crowds} masks are marked as crowds, as CVAT marks all: a stone each."
        notices.append(Notice("W119", text, "Skip the ids of those that are several stones."))
    known = sorted(size for size in sizes if size)
    with entry("the image"):
        if len(known) > 1:
            shown = listed(f"{width} x {height}" for width, height in known)
            raise ValueError(f"its sizes differ: {shown} px")
    seen_by = "program" if by_model else "people"
    return gathered.file(size_px=known[0] if known else None, notices=notices, seen_by=seen_by)


def _is_crowd(found: Mapping[str, Any]) -> bool:
    return found.get("iscrowd") not in (None, 0, "0", "")


def _picture_of(content: Mapping[str, Any], asked: str) -> Pictured:
    """Return the annotations of the image that was asked for, or of the only one."""
    images = content.get("images") or ()
    if isinstance(content.get("image"), Mapping):
        images = ({**content["image"], "id": None},)
    shapes: dict[Any, list[Any]] = {}
    with entry("the list of images"):
        known = {image.get("id"): image for image in images}
        for found in content["annotations"]:
            if not isinstance(found, Mapping):
                raise TypeError("annotations are not objects")
            shapes.setdefault(found.get("image_id"), []).append(found)
        only = next(iter(known.values())) if len(known) == 1 else {}
        pictures = []
        for i in dict.fromkeys((*known, *shapes)):
            image = known.get(i, only)
            size = size_px(image.get("width") or None, image.get("height") or None)
            name = str(known.get(i, {}).get("file_name", i))
            pictures.append(Pictured(name, size, shapes.get(i, []), str(i)))
    return chosen(pictures, asked)


def _size_of(value: Mapping[str, Any]) -> tuple[int, int]:
    """Return width and height of run lengths."""
    height, width = (int(side) for side in value["size"])
    if min(height, width) < 1 or height * width > _MOST_PX_OF_MASK:
        raise ValueError(f"a picture of {width} x {height} px")
    return width, height


def mask_of(value: Mapping[str, Any], room: Room) -> PlacedMask | None:
    """Return the mask of run lengths, cut to its bounding box; None when no pixel is set.

    They are column by column, background first: ``size`` (height, width) and ``counts``, which are
    numbers, or text as pycocotools packs them.
    """
    width, height = _size_of(value)
    check_size(width, height, room.max_px)
    counts = value["counts"]
    runs = unpacked(counts) if isinstance(counts, str | bytes) else _numbers(counts)
    if int(runs.sum()) != width * height:
        raise ValueError(f"counts add up to {int(runs.sum())}, not to {width} x {height} px")
    ends = np.cumsum(runs)
    starts, stops = ends[0::2][: len(ends) // 2], ends[1::2]
    starts, stops = starts[stops > starts], stops[stops > starts]
    if not len(starts):
        return None
    first, last = int(starts[0]) // height, (int(stops[-1]) - 1) // height
    ends = np.clip(ends, first * height, (last + 1) * height)
    runs = ends - np.concatenate(([first * height], ends[:-1]))
    columns = np.repeat(np.arange(len(runs)) % 2 == 1, runs).reshape(-1, height)
    rows = np.flatnonzero(columns.any(axis=0))
    top, bottom = int(rows[0]), int(rows[-1]) + 1
    room.take((bottom - top) * len(columns))
    mask = np.empty((bottom - top, len(columns)), bool)
    for begin in range(0, len(columns), _AT_ONCE):  # what a cache holds
        some = slice(begin, begin + _AT_ONCE)
        mask[:, some] = columns[some, top:bottom].T
    return PlacedMask(mask, top, first)


def unpacked(text: str | bytes) -> NDArray[np.int64]:
    """Return the counts of compressed run lengths.

    Five bits a character, least first, 32 for one more to come; from the fourth count on it is
    the difference to the one before the last.
    """
    data = text.encode() if isinstance(text, str) else text
    counts: list[int] = []
    number, shift = 0, 0
    for byte in data:
        bits = byte - 48
        if not 0 <= bits < 64 or shift > 30:
            raise ValueError(f"{chr(byte)!r} does not belong into packed counts")
        number |= (bits & 31) << shift
        shift += 5
        if bits & 32:
            continue
        if bits & 16:
            number -= 1 << shift
        counts.append(number + counts[-2] if len(counts) > 2 else number)
        number, shift = 0, 0
    if shift:
        raise ValueError("packed counts are cut short")
    return _numbers(counts)


def _numbers(counts: Any) -> NDArray[np.int64]:
    runs = np.asarray(counts)
    if runs.ndim != 1 or (runs.size and runs.dtype.kind not in "iu"):
        raise ValueError("counts are whole numbers")
    if runs.size and (int(runs.min()) < 0 or int(runs.max()) > _MOST_PX_OF_MASK):
        raise ValueError("a count is below 0 or too large")
    return runs.astype(np.int64)
