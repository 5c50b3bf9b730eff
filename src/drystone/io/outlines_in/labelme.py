"""labelme: a JSON file an image, with polygons and other shapes in px."""

import base64
import math
from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np

from drystone.errors import InputError
from drystone.io.file_errors import entry
from drystone.io.outlines_in.fill import Room
from drystone.io.outlines_in.model import (
    Area,
    OutlinedStone,
    OutlineFile,
    left_aside,
    number_in,
    ring,
    side_px,
)
from drystone.io.patches import PlacedMask
from drystone.io.pictures import check_size, opened
from drystone.io.read_settings import ReadSettings

_CORNERS_OF_CIRCLE = 256


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
    return OutlineFile(stones, size_px=_size(content), notices=left_aside(aside))


def _size(content: Mapping[str, Any]) -> tuple[int, int] | None:
    with entry("the size of the image"):
        width, height = content.get("imageWidth"), content.get("imageHeight")
        if width is None or height is None:
            return None
        return side_px(width), side_px(height)


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
        with opened(data, "", check) as image:
            mask = np.asarray(image.convert("L")) > 0
    except InputError as error:
        if error.code == "E110":
            raise
        raise ValueError(f"its mask is no picture: {error.what}") from error
    return PlacedMask(mask, round(float(y0)), round(float(x0)))
