"""Outlines of labelling tools and other programs: JSON of many kinds, XML of CVAT, text of YOLO.

The JSON is that of labelme, COCO, Segment Anything (SAM), GeoJSON, nesting programs, Label Studio
and VIA.
"""

import base64
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io.files import MANY, entry, listed, short, too_large
from drystone.io.images import check_size, opened
from drystone.io.outlines_in import model
from drystone.io.outlines_in.classes import Gathered, Pictured, chosen, class_of
from drystone.io.outlines_in.model import OutlinedStone, OutlineFile, Room, trimmed
from drystone.io.patches import PlacedMask
from drystone.io.photo_beside import photograph_in
from drystone.io.read_settings import MOST_PX_PER_M, ReadSettings
from drystone.kernels.polygons import Points

_MARKED = {"proposed": "proposals that nobody accepted", "not_used": "marked as not to be used"}
_BACK = "Open the file in outlines.html to change that."
_OF_MODEL = ("predicted_iou", "stability_score")
_MOST_PX_OF_MASK = 2**31


def read_labelme(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons, rectangles, circles and masks.

    Shapes of one label and ``group_id`` are one stone.  A label that is a number, also after
    the word stone, is its id.  The table ``drystone`` is that of our own page of outlines.
    """
    gathered = Gathered(settings.max_px)
    for number, shape in enumerate(content["shapes"]):
        with entry(f"shape {number} (from 0)"):
            kind, label = shape.get("shape_type") or "polygon", _text(shape.get("label") or "")
            group = None if shape.get("group_id") is None else (label, str(shape["group_id"]))
            if kind == "mask":
                gathered.labelled("", label, _mask(shape, gathered.room), group)
            elif (corners := _corners(kind, shape["points"])) is not None:
                gathered.labelled(f"shape {number}", label, [[corners]], group)
            else:
                gathered.aside[f"{kind}s"] += 1
    with entry("the size of the image"):
        size = model.size_px(content.get("imageWidth"), content.get("imageHeight"))
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
    if ground is not None and not (
        np.ptp(ground[:, 0]) > 0.0 and np.abs(ground).max() <= model.MOST_PX
    ):
        raise ValueError("the ground is not a line from left to right")
    file = replace(file, stones=kept, notices=notices, photograph=photograph_in(own))
    return replace(file, px_per_m=scale and float(scale), ground=ground)


def _corners(kind: str, points: Any) -> Any:
    """Return the corners of a shape; None when it encloses nothing."""
    # X-AnyLabeling writes all four corners of a rectangle, also of one that is turned.
    if kind == "rectangle" and len(points) != 4:
        return model.rectangle(*points)
    if kind == "circle":
        (x, y), (on_x, on_y) = points
        return model.ellipse((x, y), (math.hypot(on_x - x, on_y - y),) * 2)
    known = kind in {"polygon", "rectangle", "oriented_rectangle", "rotation"}
    return points if known else None


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
    return PlacedMask(mask, model.place_px(y0), model.place_px(x0))


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
    gathered, masks_of_crowds, sizes = Gathered(settings.max_px), 0, {picture.size_px}
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
            gathered.add(where, outline, model.number_in(found.get("id")), name, label)
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
            size = model.size_px(image.get("width") or None, image.get("height") or None)
            name = str(known.get(i, {}).get("file_name", i))
            pictures.append(Pictured(name, size, shapes.get(i, []), str(i)))
    return chosen(pictures, asked)


def _size_of(value: Mapping[str, Any]) -> tuple[int, int]:
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
    runs = unpacked(counts) if isinstance(counts, str) else _numbers(counts)
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
    return PlacedMask(np.ascontiguousarray(columns[:, top:bottom].T), top, first)


def unpacked(text: str) -> NDArray[np.int64]:
    """Return the counts of compressed run lengths.

    Five bits a character, least first, 32 for one more to come; from the fourth count on it is
    the difference to the one before the last.
    """
    counts: list[int] = []
    number, shift = 0, 0
    for byte in text.encode():
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


_KINDS = (
    "FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon", "Point",
    "MultiPoint", "LineString", "MultiLineString",
)  # fmt: skip
_CLASSES = ("classification", "class", "label", "category", "type")
_DEGREES = ("CRS84", "4326", "WGS84")
_TURN, _SMALLEST = 360.0, 0.002
"""No degrees are larger, and no stone of a map in metres is smaller; in degrees this is 200 m."""


def is_geojson(content: Any) -> bool:
    """Tell GeoJSON, or a list of its features, which is what QuPath exports."""
    if isinstance(content, list):
        return all(isinstance(one, Mapping) and one.get("type") == "Feature" for one in content)
    kind = content.get("type") if isinstance(content, Mapping) else None
    return isinstance(kind, str) and kind in _KINDS


def read_geojson(content: Any, settings: ReadSettings) -> OutlineFile:
    """Read polygons and multi-polygons, a stone a feature.

    A foreign member ``unit`` of the file ("m", "mm" …), or the setting, makes it a drawing with y
    up; without one, or with "px", coordinates are px of an image with y down, as image tools
    write them, unless its ``frame`` is that of a wall of drystone, or all y are negative.  The id
    of a stone is the ``id`` of its feature or of its properties, its name their ``name``.
    """
    if isinstance(content, list):
        content = {"type": "FeatureCollection", "features": content}
    unit = content.get("unit", "px")
    if unit not in (*model.METRES, "px"):
        what = f"its unit {short(repr(unit))} is not known."
        raise InputError("E116", what, cure=f"Use one of px, {', '.join(model.METRES)}.")
    gathered = Gathered(settings.max_px)
    with entry("the list of features"):
        kind = content["type"]
        alone = content if kind == "Feature" else {"geometry": content}
        features = list(content["features"]) if kind == "FeatureCollection" else [alone]
    for number, feature in enumerate(features):
        with entry(f"feature {number} (from 0)"):
            _add_feature(feature, f"feature {number}", gathered)
    rings = [one for stone in gathered.stones for one in stone.rings]
    crs = str(content.get("crs") or "")
    degrees = any(re.search(rf"(?<!\d){name}(?!\d)", crs) for name in _DEGREES)
    if crs and "unit" not in content and rings and np.abs(np.concatenate(rings)).max() <= _TURN:
        degrees |= bool(np.median([np.ptp(one, axis=0).max() for one in rings]) < _SMALLEST)
    if degrees:
        what = "its coordinates are degrees of latitude and longitude."
        cure = 'Project it to metres, and give the file a member "unit": "m".'
        raise InputError("E116", what, cure=cure)
    if crs and not settings.unit and "unit" not in content:
        what = "its coordinates are those of a map, and it does not say their unit."
        cure = "Say it with --unit m (or ft; ReadSettings.unit), or px if they are px of an image "
        raise InputError("E116", what, cure=f"{cure}after all.")
    unit_m = model.METRES.get(unit if "unit" in content else settings.unit or "px")
    upwards = unit_m is not None or str(content.get("frame")).startswith("wall")
    notices = gathered.notices()
    # Below a picture's upper edge with y up, where y down has no pixel: nearly all, as an outline
    # may reach over the edge.
    if not upwards and rings and float(np.median(np.concatenate(rings)[:, 1])) < 0.0:
        upwards = True
        text = "most y are negative: y runs up, as GIS programs have it over a picture."
        notices.append(Notice("W119", text))
    return gathered.file(unit_m=unit_m, y_up=upwards, notices=notices, names_images=False)


def _add_feature(feature: Mapping[str, Any], where: str, gathered: Gathered) -> None:
    geometry = feature["geometry"]
    if geometry is None:
        gathered.aside["features without a geometry"] += 1
        return
    said = {**(feature.get("properties") or {})}
    own = model.number_in(feature.get("id"))
    if own is None:
        own = model.number_in(said.get("id", said.get("stone")))
    name = str(said.get("name") or (feature["id"] if isinstance(feature.get("id"), str) else ""))
    kind = geometry["type"]
    if kind == "GeometryCollection":
        for part in geometry["geometries"]:
            _add_feature({**feature, "geometry": part}, where, gathered)
    elif said.get("kind", "stone") != "stone":
        gathered.aside[f"features of the kind {said['kind']!r}"] += 1
    elif kind in {"Polygon", "MultiPolygon"}:
        polygons = [geometry["coordinates"]] if kind == "Polygon" else geometry["coordinates"]
        if not polygons or not all(polygons):
            raise ValueError("a polygon has no ring")
        gathered.add(where, polygons, own, name, _class_in(said))
    else:
        gathered.aside[f"{kind}s"] += 1


def _class_in(said: Mapping[str, Any]) -> str:
    """Return the class of a feature, as QuPath and GIS programs write it."""
    for key in _CLASSES:
        found = said.get(key)
        if isinstance(found, Mapping):
            found = found.get("name")
        if isinstance(found, str):
            return class_of(found)
    return ""


_MOST_COPIES = 10_000
_GAP = 0.05
"""Between pieces that are laid in a row, as a share of the largest."""


def is_nesting(content: Any) -> bool:
    """Tell an instance of sparrow or jagua-rs."""
    items = _lower(content).get("items") if isinstance(content, Mapping) else None
    if not isinstance(items, list):
        return False
    return all(isinstance(item, Mapping) and "shape" in _lower(item) for item in items)


def _lower(table: Mapping[str, Any]) -> dict[str, Any]:
    return {str(key).lower(): value for key, value in table.items()}


def read_nesting(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read the items of an instance, each as often as it is demanded.

    Where items lie over each other, as each has an origin of its own, they are laid in a row.
    """
    gathered, copies = Gathered(settings.max_px), 0
    stones = gathered.stones
    for number, item in enumerate(map(_lower, _lower(content)["items"])):
        where, before = f"item {number} (from 0)", len(stones)
        with entry(where):
            demand = int(item.get("demand", 1))
            if demand < 0:
                raise ValueError(f"{demand} of it are demanded")
            own = model.number_in(item.get("id")) if demand == 1 else None
            gathered.add(where, _of_nesting(_lower(item["shape"])), own)
        copies += demand
        if copies > _MOST_COPIES:
            cure = "Ask for fewer of each."
            raise too_large(f"more than {_MOST_COPIES} items are demanded.", cure)
        stones[before:] = stones[before:] * demand
    unit_m = model.METRES.get(settings.unit)
    notices = gathered.notices()
    if not settings.unit:
        text = "an instance says no unit: its numbers are taken as px, with y down."
        notices.append(Notice("W119", text, "Name the unit with --unit (unit in Python)."))
    corners = [np.concatenate(stone.rings) for stone in stones]
    low, high = (
        np.reshape([of(one, axis=0) for one in corners], (-1, 2)) for of in (np.min, np.max)
    )
    if _overlap(low, high):
        stones = list(_in_a_row(stones, low, high, whole=unit_m is None))
        notices.append(Notice("W119", "items lie over each other: they are laid in a row."))
    return OutlineFile(stones, unit_m, unit_m is not None, notices=notices, seen_by="none")


def _of_nesting(shape: Mapping[str, Any]) -> Iterator[list[Any]]:
    kind, data = str(shape.get("type", "")).lower().replace("_", ""), shape.get("data", shape)
    if kind == "simplepolygon":
        yield [data]
    elif kind in {"polygon", "multipolygon"}:
        for part in map(_lower, data if kind == "multipolygon" else [data]):
            yield [part["outer"], *(part.get("inner") or ())]
    elif kind == "rectangle":
        data = _lower(data)
        x, y = float(data.get("x_min", 0.0)), float(data.get("y_min", 0.0))
        yield [model.rectangle((x, y), (x + float(data["width"]), y + float(data["height"])))]
    else:
        raise ValueError(f"a shape of the type {short(repr(shape.get('type')))}")


def _overlap(low: Points, high: Points) -> bool:
    """Tell whether two boxes share more than half of the smaller one."""
    areas = (high - low).prod(axis=1)
    for i in range(1, len(areas)):
        sides = np.minimum(high[:i], high[i]) - np.maximum(low[:i], low[i])
        shared = sides.clip(0.0).prod(axis=1)
        if (shared > 0.5 * np.minimum(areas[:i], areas[i])).any():
            return True
    return False


def _in_a_row(
    stones: list[OutlinedStone], low: Points, high: Points, *, whole: bool
) -> Iterator[OutlinedStone]:
    """Move each behind the last one; by `whole` px, which changes no pixel of it."""
    gap, x = _GAP * float((high - low).max()), 0.0
    for stone, start, end in zip(stones, low, high, strict=True):
        shift = np.array([x, 0.0]) - start
        yield stone.moved(partial(np.add, np.ceil(shift) if whole else shift))
        x += float(end[0] - start[0]) + gap + whole


_CLASSES_OF_VIA = ("class", "label", "type", "category", "name")
YOLO = re.compile(rb"\s*[0-9]+(?:[ \t]+-?[0-9.]+(?:[eE][-+]?[0-9]+)?){4,}[ \t]*\r?(?:\n|\Z)")
"""A line of a class and coordinates."""


def _text(value: Any) -> str:
    """Return a class that is a text, or a list or table of what applies."""
    if isinstance(value, Mapping):
        value = [key for key, on in value.items() if on]
    if isinstance(value, list):
        value = value[0] if value else ""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return "" if value is None else str(value)


def _turned(corners: Any, degrees: float, about: tuple[float, float]) -> Any:
    """Turn corners clockwise, as y runs down."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return (corners - about) @ np.array([[cosine, sine], [-sine, cosine]]) + about


# Label Studio


def is_label_studio(content: Any) -> bool:
    """Tell a list of tasks."""
    tasks = content if isinstance(content, list) else [content]
    known = (isinstance(task, Mapping) and _results(task) is not None for task in tasks)
    return bool(tasks) and all(known)


def _results(task: Mapping[str, Any]) -> list[list[Any]] | None:
    """Return what each annotator of a task drew, in the long or the short form."""
    for key in ("annotations", "completions"):
        if isinstance(task.get(key), list) and "data" in task:
            made = [a for a in task[key] if isinstance(a, Mapping) and not a.get("was_cancelled")]
            drawn = (one.get("result") for one in made)
            lists = (found if isinstance(found, list) else [] for found in drawn)
            return [[one for one in found if isinstance(one, Mapping)] for found in lists]
    alone = [
        {"value": one, **one}
        for value in task.values()
        if isinstance(value, list)
        for one in value
        if isinstance(one, Mapping) and "original_width" in one
    ]
    return [alone] if alone else None


def read_label_studio(content: Any, settings: ReadSettings) -> OutlineFile:
    """Read polygons, rectangles and ellipses, which are in per cent of their picture."""
    pictures = []
    with entry("the list of tasks"):
        for task in content if isinstance(content, list) else [content]:
            where = task.get("data") or task
            name = next((v for k, v in where.items() if k != "id" and isinstance(v, str)), "")
            made = _results(task) or [[]]
            own = str(task.get("id", ""))
            pictures.append(Pictured(name, None, made[-1], own, len(made) - 1))
    picture = chosen(pictures, settings.image)
    found, sizes = Gathered(settings.max_px), set()
    found.aside["earlier annotations of the same picture"] = picture.earlier
    # Where shape and class are marked one after the other, both hold the outline.
    drawn = {str(one.get("id") or i): one for i, one in enumerate(picture.shapes)}
    for number, shape in enumerate(drawn.values()):
        where = f"result {number}"
        with entry(where):
            value = shape.get("value") or {}
            # Not points, words and masks of pixels.
            sides = ({"points"}, {"radiusX", "radiusY"}, {"x", "y", "width", "height"})
            if "format" in value or not any(names <= set(value) for names in sides):
                found.aside[f"results of the type {short(shape.get('type', 'unknown'))}"] += 1
                continue
            size = model.side_px(shape["original_width"]), model.side_px(shape["original_height"])
            sizes.add(size)
            label = _text(value.get(next((k for k in value if k.endswith("labels")), "")))
            corners = _of_label_studio(value, size[0] / 100.0, size[1] / 100.0)
            found.add(where, [[corners]], model.number_in(label), "", class_of(label))
    brushes = "brush" in str(found.aside)
    cure = "Brush masks are read from its export as COCO or PNG." if brushes else ""
    return found.file(cure, size_px=next(iter(sizes)) if len(sizes) == 1 else None)


def _of_label_studio(value: Mapping[str, Any], across: float, down: float) -> Any:
    """Return corners in px, of which a per cent has so many."""
    if "points" in value:
        points = np.array([list(map(float, point)) for point in value["points"]])
        return points * (across, down)
    x, y = float(value["x"]) * across, float(value["y"]) * down
    turn = float(value.get("rotation") or 0.0)
    if "radiusX" in value:
        radii = float(value["radiusX"]) * across, float(value["radiusY"]) * down
        return model.ellipse((x, y), radii, math.radians(turn))
    width, height = float(value["width"]) * across, float(value["height"]) * down
    return _turned(model.rectangle((x, y), (x + width, y + height)), turn, (x, y))


# VGG Image Annotator


def is_via(content: Any) -> bool:
    """Tell a project of VIA 2, or its annotations alone."""
    images = content.get("_via_img_metadata", content) if isinstance(content, Mapping) else None
    if not isinstance(images, Mapping) or not images:
        return False
    return all(isinstance(one, Mapping) and "regions" in one for one in images.values())


def read_via(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons, rectangles, circles and ellipses of VIA."""
    pictures = []
    with entry("the list of images"):
        for key, image in content.get("_via_img_metadata", content).items():
            regions = image["regions"]
            shapes = list(regions.values()) if isinstance(regions, Mapping) else list(regions)
            pictures.append(Pictured(str(image.get("filename", key)), None, shapes, str(key)))
    found = Gathered(settings.max_px)
    for number, region in enumerate(chosen(pictures, settings.image).shapes):
        where = f"region {number} (from 0)"
        with entry(where):
            shape = region["shape_attributes"]
            corners = _of_via(shape)
            if corners is None:
                found.aside[f"{shape.get('name')}s"] += 1
                continue
            said = region.get("region_attributes") or {}
            key = next((k for k in _CLASSES_OF_VIA if k in said), next(iter(said), ""))
            found.labelled(where, _text(said.get(key)), [[corners]])
    return found.file()


def _of_via(shape: Mapping[str, Any]) -> Any:
    kind = shape["name"]
    if kind == "polygon":
        return list(zip(shape["all_points_x"], shape["all_points_y"], strict=True))
    if kind == "rect":
        x, y, width, height = (float(shape[name]) for name in ("x", "y", "width", "height"))
        return model.rectangle((x, y), (x + width, y + height))
    if kind in {"circle", "ellipse"}:
        across, along = ("r", "r") if kind == "circle" else ("rx", "ry")
        radii = float(shape[across]), float(shape[along])
        return model.ellipse((shape["cx"], shape["cy"]), radii, float(shape.get("theta") or 0.0))
    return None


# CVAT


def read_cvat(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read polygons, boxes, ellipses and masks of CVAT for images."""
    root = model.xml_root(data, "XML", "Export the annotations of one image.")
    pictures = []
    with entry("the list of images"):
        for image in root.iter("image"):
            size, own = model.size_px(image.get("width"), image.get("height")), image.get("id", "")
            pictures.append(Pictured(image.get("name", ""), size, list(image), own))
    picture, found = chosen(pictures, settings.image), Gathered(settings.max_px)
    for number, shape in enumerate(picture.shapes):
        where, label = f"shape {number} (from 0)", shape.get("label", "")
        with entry(where):
            if shape.tag == "mask":
                found.labelled(where, label, _mask_of_cvat(shape, found.room))
            elif shape.tag in {"polygon", "box", "ellipse"}:
                found.labelled(where, label, [[_of_cvat(shape)]])
            else:
                found.aside[f"{short(shape.tag)}s"] += 1
    return found.file(size_px=picture.size_px)


def _of_cvat(shape: ET.Element) -> Any:
    turn = float(shape.get("rotation", 0.0))
    if shape.tag == "polygon":
        return [tuple(map(float, p.split(","))) for p in shape.attrib["points"].split(";")]
    names = ("xtl", "ytl", "xbr", "ybr") if shape.tag == "box" else ("cx", "cy", "rx", "ry")
    one, two, three, four = (float(shape.attrib[name]) for name in names)
    if shape.tag == "ellipse":
        return model.ellipse((one, two), (three, four), math.radians(turn))
    middle = (one + three) / 2.0, (two + four) / 2.0
    return _turned(model.rectangle((one, two), (three, four)), turn, middle)


def _mask_of_cvat(shape: ET.Element, room: Room) -> PlacedMask | None:
    """Return a mask of run lengths along the rows of its box, background first."""
    sides = ("left", "top", "width", "height")
    left, top, width, height = (model.place_px(shape.attrib[name]) for name in sides)
    check_size(model.side_px(width), model.side_px(height), room.max_px)
    room.take(width * height)
    runs = np.array([int(run) for run in shape.attrib["rle"].split(",")], np.int64)
    if runs.min() < 0 or runs.max() > width * height or int(runs.sum()) != width * height:
        raise ValueError(f"its run lengths do not fill {width} x {height} px")
    flat = np.repeat(np.arange(len(runs)) % 2 == 1, runs)
    return trimmed(PlacedMask(flat.reshape(height, width), top, left))


# YOLO


def read_yolo(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read segments of YOLO: a class and the corners, as shares of the picture, in a line."""
    found = Gathered(settings.max_px)
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), start=1):
        where = f"line {number}"
        with entry(where):
            kind, *values = line.split() or [""]
            if len(values) in {4, 5}:
                found.aside["boxes"] += 1
            elif values:
                if len(values) % 2:
                    raise ValueError("an odd number of coordinates; save without save_conf")
                corners = np.array(values, float).reshape(-1, 2)
                found.add(where, [[corners]], label=kind)
    return found.file("Boxes have no outlines: train or label segments." if found.aside else "")
