"""Annotations in JSON: labelme, COCO, the automatic masks of Segment Anything (SAM), GeoJSON."""

import base64
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io.file_errors import entry, listed, short
from drystone.io.outlines_in.fill import Room, check_reach, trimmed
from drystone.io.outlines_in.model import (
    METRES,
    Area,
    OutlinedStone,
    OutlineFile,
    left_aside,
    number_in,
    ring,
    side_px,
)
from drystone.io.outlines_in.nested import without_nested
from drystone.io.patches import PlacedMask
from drystone.io.pictures import check_size, opened
from drystone.io.read_settings import ReadSettings

_CORNERS_OF_CIRCLE = 256
_OF_MODEL = ("predicted_iou", "stability_score")
_MOST_PX = 2**31
_AT_ONCE = 64
GEOJSON_KINDS = frozenset(
    {
        "FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon", "Point",
        "MultiPoint", "LineString", "MultiLineString",
    }
)  # fmt: skip
_DEGREES = ("CRS84", "4326", "WGS84")


def read_labelme(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons, rectangles, circles and masks.

    Shapes of one label and ``group_id`` are one stone.  A label that is a number, also after
    the word stone, is its id.
    """
    parts: dict[object, tuple[str, list[Area], list[PlacedMask]]] = {}
    aside = Counter[str]()
    room = Room(int(settings.max_image_mpx * 1e6))
    for number, shape in enumerate(content["shapes"]):
        with entry(f"shape {number} (from 0)"):
            kind, label = shape.get("shape_type") or "polygon", str(shape.get("label") or "")
            read = _mask(shape, room) if kind == "mask" else _area(kind, shape["points"])
            if read is None:
                aside[f"{kind}s"] += 1
                continue
            group = shape.get("group_id")
            key = ("alone", number) if group is None else (label, str(group))
            _, areas, masks = parts.setdefault(key, (label, [], []))
            if isinstance(read, Area):
                areas.append(read)
            else:
                masks.append(read)
    stones = [
        OutlinedStone(number_in(name), name, tuple(areas), tuple(masks))
        for name, areas, masks in parts.values()
    ]
    with entry("the size of the image"):
        sides = content.get("imageWidth"), content.get("imageHeight")
        size = None if None in sides else (side_px(sides[0]), side_px(sides[1]))
    return OutlineFile(stones, size_px=size, notices=left_aside(aside))


def _area(kind: str, points: Any) -> Area | None:
    # X-AnyLabeling writes all four corners of a rectangle, also of one that is turned.
    if kind == "rectangle" and len(points) != 4:
        (x0, y0), (x1, y1) = points
        points = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    elif kind == "circle":
        (x, y), (on_x, on_y) = points
        angles = np.arange(_CORNERS_OF_CIRCLE) * (2.0 * math.pi / _CORNERS_OF_CIRCLE)
        circle = math.hypot(on_x - x, on_y - y) * np.column_stack([np.cos(angles), np.sin(angles)])
        points = circle + np.array([x, y])
    elif kind not in {"polygon", "rectangle", "oriented_rectangle", "rotation"}:
        return None
    return Area((ring(points),))


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
        raise ValueError(f"its mask is no picture: {error.what}") from error
    return PlacedMask(mask, round(float(y0)), round(float(x0)))


class _Stones:
    """Stones that are read one by one, and the size of the image that they are in."""

    def __init__(self, settings: ReadSettings) -> None:
        self.settings = settings
        self.room = Room(int(settings.max_image_mpx * 1e6))
        self.stones: list[OutlinedStone] = []
        self.sizes: set[tuple[int, int]] = set()

    def add(self, segmentation: Any, number: int | None, name: str = "") -> None:
        """Add a stone of polygons, rows of truth values, or run lengths, which take of the room."""
        areas, mask = [], None
        if _is_runs(segmentation):
            mask = mask_of(segmentation, self.room)
            self.sizes.add(_size_of(segmentation))
        else:
            for flat in segmentation:
                if len(flat) % 2:
                    raise ValueError("a polygon has an odd number of coordinates")
                areas.append(Area((ring(list(zip(flat[0::2], flat[1::2], strict=True))),)))
        masks = () if mask is None else (mask,)
        self.stones.append(OutlinedStone(number, name, tuple(areas), masks))

    def add_rows(self, segmentation: Any, number: int) -> None:
        """Add a stone of rows of truth values."""
        rows = np.asarray(segmentation)
        if rows.ndim != 2 or rows.dtype.kind not in "biu":
            raise ValueError("its rows are not of one length, or of no truth values")
        self.sizes.add((rows.shape[1], rows.shape[0]))
        mask = trimmed(PlacedMask(rows.astype(bool), 0, 0))
        self.stones.append(OutlinedStone(number, masks=() if mask is None else (mask,)))

    def without_nested(self) -> list[Notice]:
        """Leave out what is ground, a group or a part of a stone, as a model finds them."""
        check_reach(self.stones, self.room.max_px)
        self.stones, notices = without_nested(self.stones, self.settings.skip)
        return notices

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
        categories = {c.get("id"): str(c.get("name", "")) for c in content.get("categories") or ()}
    shown = categories if len(categories) > 1 else {}
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
            name = shown.get(found.get("category_id"), "")
            stones.add(segmentation, number_in(found.get("id")), name)
    size = stones.size_in(image)
    notices = left_aside(aside)
    if masks_of_crowds:
        text = f"{masks_of_crowds} masks are marked as crowds, as CVAT marks all: a stone each."
        notices.append(Notice("W119", text, "Skip the ids of those that are several stones."))
    if any(name in found for found in chosen for name in _OF_MODEL):
        notices += stones.without_nested()
    return OutlineFile(stones.stones, size_px=size, notices=notices, names_images=True)


def read_sam(content: list[Mapping[str, Any]], settings: ReadSettings) -> OutlineFile:
    """Read a list of masks, numbered from 1 in the order of the file.

    Masks may lie in each other: what is ground, a group or a part of a stone is left out as
    :func:`~drystone.io.outlines_in.nested.without_nested` says.
    """
    images = {str(found["image_id"]) for found in content if "image_id" in found}
    several = len({str(found.get("image_id")) for found in content}) > 1
    if images and (several or settings.image):
        if settings.image not in images:
            no_such = f"no image is called {settings.image!r}"
            what = no_such if settings.image else f"masks of {len(images)} images are in it"
            raise _image_needed(what, sorted(images))
        content = [found for found in content if str(found.get("image_id")) == settings.image]
    stones = _Stones(settings)
    for number, found in enumerate(content, start=1):
        with entry(f"mask {number}"):
            segmentation = found["segmentation"]
            add = stones.add_rows if _is_nested_list(segmentation) else stones.add
            add(segmentation, number)
    notices = stones.without_nested()
    size = stones.size_in(None)
    return OutlineFile(stones.stones, size_px=size, notices=notices, names_images=bool(images))


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
            raise TypeError("annotations are no objects")
        known = {image.get("id"): image for image in images}
        names = {i: str(image.get("file_name", i)) for i, image in known.items()}
        used = list(dict.fromkeys(found.get("image_id") for found in annotations))
    if name:
        used = [i for i in known if name in (names[i], PurePath(names[i]).name, str(i))]
        if len(used) != 1:
            raise _image_needed(f"no image or several are called {name!r}", names.values())
    if len(used) > 1:
        what = f"stones of {len(used)} images are in it"
        raise _image_needed(what, [names.get(i, str(i)) for i in used])
    only = used[0] if used else None
    image = known.get(only) or (next(iter(known.values())) if len(known) == 1 else None)
    return [found for found in annotations if found.get("image_id") == only], image


def _image_needed(what: str, names: Iterable[str]) -> InputError:
    """Make the error for several images in one file (E115)."""
    there = listed(map(short, names))
    cure = f"Say which one with --image NAME (ReadSettings.image); there are {there}."
    return InputError("E115", f"{what}.", cure=cure)


def _is_runs(value: object) -> bool:
    return isinstance(value, Mapping) and "counts" in value


def _size_of(value: Mapping[str, Any]) -> tuple[int, int]:
    """Return width and height of run lengths."""
    height, width = (int(side) for side in value["size"])
    if min(height, width) < 1 or height * width > _MOST_PX:
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
    if runs.size and (int(runs.min()) < 0 or int(runs.max()) > _MOST_PX):
        raise ValueError("a count is below 0 or too large")
    return runs.astype(np.int64)


def read_geojson(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons and multi-polygons, a stone a feature.

    A foreign member ``unit`` of the file ("m", "mm" …), or the setting, makes it a drawing with y
    up; without one, or with "px", coordinates are px of an image with y down, as image tools
    write them, unless its ``frame`` is that of a wall of drystone, or all y are negative.  The id
    of a stone is the ``id`` of its feature or of its properties, its name their ``name``.
    """
    if any(name in str(content.get("crs", "")) for name in _DEGREES):
        what = "its coordinates are degrees of latitude and longitude."
        raise _no_unit(what, 'Project it to metres, and give the file a member "unit": "m".')
    if content.get("crs") and not settings.unit and "unit" not in content:
        raise _no_unit(
            "its coordinates are those of a map, and it does not say their unit.",
            "Say it with --unit m (or ft; ReadSettings.unit), or px if they are px of an image "
            "after all.",
        )
    unit = content.get("unit", "px")
    if unit not in (*METRES, "px"):
        what = f"its unit {short(repr(unit))} is not known."
        raise _no_unit(what, f"Use one of px, {', '.join(METRES)}.")
    stones: list[OutlinedStone] = []
    aside = Counter[str]()
    for number, feature in enumerate(_features(content)):
        with entry(f"feature {number} (from 0)"):
            stones += _stones_of_feature(feature, aside)
    unit_m = METRES.get(unit if "unit" in content else settings.unit or "px")
    upwards = unit_m is not None or str(content.get("frame")).startswith("wall")
    notices = left_aside(aside)
    rings = [one for stone in stones for area in stone.areas for one in area.rings]
    # All is below a picture's upper edge with y up, where y down has no pixel.
    if not upwards and rings and all(one[:, 1].max() <= 0.0 for one in rings):
        upwards = True
        text = "all y are negative: y runs up, as GIS programs have it over a picture."
        notices.append(Notice("W119", text))
    return OutlineFile(stones, unit_m, upwards, notices=notices)


def _no_unit(what: str, cure: str) -> InputError:
    return InputError("E116", what, cure=cure)


def _features(content: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    with entry("the list of features"):
        if content["type"] == "FeatureCollection":
            yield from content["features"]
        elif content["type"] == "Feature":
            yield content
        else:
            yield {"geometry": content}


def _stones_of_feature(feature: Mapping[str, Any], aside: Counter[str]) -> Iterator[OutlinedStone]:
    geometry = feature["geometry"]
    if geometry is None:
        aside["features without a geometry"] += 1
        return
    said = {**(feature.get("properties") or {})}
    own = number_in(feature.get("id"))
    if own is None:
        own = number_in(said.get("id", said.get("stone")))
    name = str(said.get("name") or (feature["id"] if isinstance(feature.get("id"), str) else ""))
    kind = geometry["type"]
    if kind == "GeometryCollection":
        for part in geometry["geometries"]:
            yield from _stones_of_feature({**feature, "geometry": part}, aside)
    elif said.get("kind", "stone") != "stone":
        aside[f"features of the kind {said['kind']!r}"] += 1
    elif kind in {"Polygon", "MultiPolygon"}:
        polygons = [geometry["coordinates"]] if kind == "Polygon" else geometry["coordinates"]
        areas = tuple(Area(tuple(ring(points) for points in rings)) for rings in polygons)
        if not areas or not all(area.rings for area in areas):
            raise ValueError("a polygon has no ring")
        yield OutlinedStone(own, name, areas)
    else:
        aside[f"{kind}s"] += 1
