"""Annotations in JSON: labelme, COCO, the automatic masks of Segment Anything (SAM)."""

import base64
import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io.file_errors import MANY, entry, listed
from drystone.io.outlines_in.classes import class_of
from drystone.io.outlines_in.exports import image_needed
from drystone.io.outlines_in.fill import Room, trimmed
from drystone.io.outlines_in.model import (
    MOST_PX,
    Area,
    OutlinedStone,
    OutlineFile,
    Slivers,
    ellipse,
    left_aside,
    number_in,
    place_px,
    side_px,
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
    parts: dict[object, tuple[str, list[Area], list[PlacedMask]]] = {}
    aside, slivers = Counter[str](), Slivers()
    room = Room(int(settings.max_image_mpx * 1e6))
    for number, shape in enumerate(content["shapes"]):
        with entry(f"shape {number} (from 0)"):
            kind, label = shape.get("shape_type") or "polygon", str(shape.get("label") or "")
            mask = _mask(shape, room) if kind == "mask" else None
            corners = None if mask else _corners(kind, shape["points"])
            if mask is None and corners is None:
                aside[f"{kind}s"] += 1
                continue
            found = () if corners is None else slivers.areas(f"shape {number}", [[corners]])
            if mask is None and not found:
                continue
            group = shape.get("group_id")
            key = ("alone", number) if group is None else (label, str(group))
            _, areas, masks = parts.setdefault(key, (label, [], []))
            areas += found
            masks += [] if mask is None else [mask]
    stones = [
        OutlinedStone(number_in(name), name, tuple(areas), tuple(masks), class_of(name))
        for name, areas, masks in parts.values()
    ]
    with entry("the size of the image"):
        sides = content.get("imageWidth"), content.get("imageHeight")
        size = None if None in sides else (side_px(sides[0]), side_px(sides[1]))
    notices = left_aside(aside) + slivers.notices()
    with entry("the table drystone"):
        return _of_page(OutlineFile(stones, size_px=size), notices, content.get("drystone") or {})


def _of_page(file: OutlineFile, notices: list[Notice], own: Mapping[str, Any]) -> OutlineFile:
    """Take scale and ground from what our page of outlines adds, and leave out what it marks."""
    kept = file.stones
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
    return replace(file, px_per_m=None if scale is None else float(scale), ground=ground)


def _corners(kind: str, points: Any) -> Any:
    """Return the corners of a shape; None when it encloses nothing."""
    # X-AnyLabeling writes all four corners of a rectangle, also of one that is turned.
    if kind == "rectangle" and len(points) != 4:
        (x0, y0), (x1, y1) = points
        points = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    elif kind == "circle":
        (x, y), (on_x, on_y) = points
        points = ellipse((x, y), (math.hypot(on_x - x, on_y - y),) * 2)
    elif kind not in {"polygon", "rectangle", "oriented_rectangle", "rotation"}:
        return None
    return points


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


class _Stones:
    """Stones that are read one by one, and the size of the image that they are in."""

    def __init__(self, settings: ReadSettings) -> None:
        self.settings = settings
        self.room = Room(int(settings.max_image_mpx * 1e6))
        self.stones: list[OutlinedStone] = []
        self.sizes: set[tuple[int, int]] = set()
        self.slivers = Slivers()

    def add(
        self, segmentation: Any, number: int | None, where: str, name: str = "", label: str = ""
    ) -> None:
        """Add a stone of polygons or run lengths, which take of the room."""
        areas: tuple[Area, ...] = ()
        mask = None
        if _is_runs(segmentation):
            mask = mask_of(segmentation, self.room)
            self.sizes.add(_size_of(segmentation))
        else:
            if any(len(flat) % 2 for flat in segmentation):
                raise ValueError("a polygon has an odd number of coordinates")
            flats = [list(zip(flat[0::2], flat[1::2], strict=True)) for flat in segmentation]
            areas = self.slivers.areas(where, [[flat] for flat in flats])
            if not areas:
                return
        masks = () if mask is None else (mask,)
        self.stones.append(OutlinedStone(number, name, areas, masks, label))

    def add_rows(self, segmentation: Any, number: int) -> None:
        """Add a stone of rows of truth values."""
        rows = np.asarray(segmentation)
        if rows.ndim != 2 or rows.dtype.kind not in "biu":
            raise ValueError("its rows are not of one length, or of no truth values")
        self.sizes.add((rows.shape[1], rows.shape[0]))
        mask = trimmed(PlacedMask(rows.astype(bool), 0, 0))
        self.stones.append(OutlinedStone(number, masks=() if mask is None else (mask,)))

    def size_in(self, image: Mapping[str, Any] | None) -> tuple[int, int] | None:
        """Return the size that the image and all masks agree on; E114 when they do not."""
        with entry("the image"):
            if image is not None and image.get("width") and image.get("height"):
                self.sizes.add((side_px(image["width"]), side_px(image["height"])))
            if len(self.sizes) > 1:
                found = listed(f"{width} x {height}" for width, height in sorted(self.sizes))
                raise ValueError(f"its sizes differ: {found} px")
        return next(iter(self.sizes), None)


def read_coco(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read the annotations of one image.

    Polygons of one annotation are united, which is COCO's own rule: it has no holes but in run
    lengths.  Files that the automatic masks of SAM were released in have ``image`` instead of
    ``images``; their masks may lie in each other, as those of :func:`read_sam`.
    """
    chosen, image = _chosen(content, settings.image)
    with entry("the list of categories"):
        classes = {c.get("id"): str(c.get("name", "")) for c in content.get("categories") or ()}
    stones, aside, masks_of_crowds = _Stones(settings), Counter[str](), 0
    only_crowds = all(map(_is_crowd, chosen))
    for number, found in enumerate(chosen):
        with entry(f"annotation {found.get('id', number)}"):
            segmentation = found.get("segmentation")
            if _is_crowd(found):
                # CVAT (datumaro) calls every mask a crowd; the attributes are its own, too.
                if not _is_runs(segmentation) or not (only_crowds or "attributes" in found):
                    aside["crowd regions (several stones as one)"] += 1
                    continue
                masks_of_crowds += 1
            if not segmentation:
                aside["annotations without an outline"] += 1
                continue
            label = classes.get(found.get("category_id"), "")
            name = label if len(classes) > 1 else ""
            where = f"annotation {found.get('id', number)}"
            stones.add(segmentation, number_in(found.get("id")), where, name, label)
    size = stones.size_in(image)
    notices = left_aside(aside) + stones.slivers.notices()
    if masks_of_crowds:
        text = f"{masks_of_crowds} masks are marked as crowds, as CVAT marks all: a stone each."
        notices.append(Notice("W119", text, "Skip the ids of those that are several stones."))
    by_model = any(name in found for found in chosen for name in _OF_MODEL)
    return OutlineFile(
        stones.stones,
        size_px=size,
        notices=notices,
        names_images=True,
        seen_by="program" if by_model else "people",
    )


def read_sam(content: list[Mapping[str, Any]], settings: ReadSettings) -> OutlineFile:
    """Read a list of masks, numbered from 1 in the order of the file.

    Masks may lie in each other: what is ground, a group or a part of a stone is left out as
    :func:`~drystone.io.outlines_in.nested.not_stones` says.
    """
    images = {str(found["image_id"]) for found in content if "image_id" in found}
    several = len({str(found.get("image_id")) for found in content}) > 1
    if images and (several or settings.image):
        if settings.image not in images:
            no_such = f"no image is called {settings.image!r}"
            what = no_such if settings.image else f"masks of {len(images)} images are in it"
            raise image_needed(what, sorted(images))
        content = [found for found in content if str(found.get("image_id")) == settings.image]
    stones = _Stones(settings)
    for number, found in enumerate(content, start=1):
        with entry(f"mask {number}"):
            segmentation = found["segmentation"]
            if _is_nested_list(segmentation):
                stones.add_rows(segmentation, number)
            else:
                stones.add(segmentation, number, f"mask {number}")
    return OutlineFile(
        stones.stones,
        size_px=stones.size_in(None),
        notices=stones.slivers.notices(),
        names_images=bool(images),
        seen_by="program",
    )


def _is_nested_list(segmentation: Any) -> bool:
    """Tell rows of truth values from polygons, which have at least 6 numbers that are none."""
    if not isinstance(segmentation, list) or not segmentation:
        return False
    first = segmentation[0]
    return isinstance(first, list) and all(value in (0, 1) for value in first)


def _is_crowd(found: Mapping[str, Any]) -> bool:
    return found.get("iscrowd") not in (None, 0, "0", "")


def _chosen(
    content: Mapping[str, Any], name: str
) -> tuple[list[Mapping[str, Any]], Mapping[str, Any] | None]:
    """Return the annotations of the image that was asked for, or of the only one."""
    annotations = content["annotations"]
    images = content.get("images") or ()
    if isinstance(content.get("image"), Mapping):
        images = ({**content["image"], "id": None},)
    with entry("the list of images"):
        if not all(isinstance(found, Mapping) for found in annotations):
            raise TypeError("annotations are not objects")
        known = {image.get("id"): image for image in images}
        names = {i: str(image.get("file_name", i)) for i, image in known.items()}
        used = list(dict.fromkeys(found.get("image_id") for found in annotations))
    if name:
        used = [i for i in known if name in (names[i], PurePath(names[i]).name, str(i))]
        if len(used) != 1:
            raise image_needed(f"no image or several are called {name!r}", names.values())
    if len(used) > 1:
        what = f"stones of {len(used)} images are in it"
        raise image_needed(what, [names.get(i, str(i)) for i in used])
    only = used[0] if used else None
    image = known.get(only) or (next(iter(known.values())) if len(known) == 1 else None)
    return [found for found in annotations if found.get("image_id") == only], image


def _is_runs(value: object) -> bool:
    return isinstance(value, Mapping) and "counts" in value


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
