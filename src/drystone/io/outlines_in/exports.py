"""Exports of labelling tools: Label Studio, VIA, CVAT, YOLO."""

import math
import re
from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from drystone.io.file_errors import entry, short
from drystone.io.outlines_in.classes import class_of
from drystone.io.outlines_in.fill import Room, trimmed
from drystone.io.outlines_in.gathered import Gathered, Pictured, chosen
from drystone.io.outlines_in.model import (
    OutlineFile,
    ellipse,
    number_in,
    place_px,
    rectangle,
    side_px,
    size_px,
    xml_root,
)
from drystone.io.patches import PlacedMask
from drystone.io.pictures import check_size
from drystone.io.read_settings import ReadSettings

_CLASSES = ("class", "label", "type", "category", "name")
_YOLO = re.compile(rb"\s*[0-9]+(?:[ \t]+-?[0-9.]+(?:[eE][-+]?[0-9]+)?){4,}[ \t]*\r?(?:\n|\Z)")


def _text(value: Any) -> str:
    """Return a class that is a text, or a list or table of what applies."""
    if isinstance(value, Mapping):
        value = [key for key, on in value.items() if on]
    if isinstance(value, list):
        value = value[0] if value else ""
    return "" if value is None else str(value)


def _turned(corners: Any, degrees: float, about: tuple[float, float]) -> Any:
    """Turn corners clockwise, as y runs down."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return (corners - about) @ np.array([[cosine, sine], [-sine, cosine]]) + about


# Label Studio


def is_label_studio(content: Any) -> bool:
    """Tell a list of tasks."""
    tasks = content if isinstance(content, list) else [content]
    return bool(tasks) and all(
        isinstance(task, Mapping) and (_results(task) is not None) for task in tasks
    )


def _results(task: Mapping[str, Any]) -> list[list[Any]] | None:
    """Return what each annotator of a task drew, in the long or the short form."""
    for key in ("annotations", "completions"):
        if isinstance(task.get(key), list) and "data" in task:
            made = [a for a in task[key] if isinstance(a, Mapping) and not a.get("was_cancelled")]
            drawn = (one.get("result") for one in made)
            return [
                [one for one in found if isinstance(one, Mapping)]
                if isinstance(found, list)
                else []
                for found in drawn
            ]
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
    found, sizes = Gathered(settings), set()
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
            size = side_px(shape["original_width"]), side_px(shape["original_height"])
            sizes.add(size)
            label = _text(value.get(next((k for k in value if k.endswith("labels")), "")))
            corners = _of_label_studio(value, size[0] / 100.0, size[1] / 100.0)
            found.add(where, [[corners]], number_in(label), "", class_of(label))
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
        return ellipse((x, y), radii, math.radians(turn))
    width, height = float(value["width"]) * across, float(value["height"]) * down
    return _turned(rectangle((x, y), (x + width, y + height)), turn, (x, y))


# VGG Image Annotator


def is_via(content: Any) -> bool:
    """Tell a project of VIA 2, or its annotations alone."""
    images = content.get("_via_img_metadata", content) if isinstance(content, Mapping) else None
    return (
        isinstance(images, Mapping)
        and bool(images)
        and all(isinstance(one, Mapping) and "regions" in one for one in images.values())
    )


def read_via(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read polygons, rectangles, circles and ellipses of VIA."""
    pictures = []
    with entry("the list of images"):
        for key, image in content.get("_via_img_metadata", content).items():
            regions = image["regions"]
            shapes = list(regions.values()) if isinstance(regions, Mapping) else list(regions)
            pictures.append(Pictured(str(image.get("filename", key)), None, shapes, str(key)))
    found = Gathered(settings)
    for number, region in enumerate(chosen(pictures, settings.image).shapes):
        where = f"region {number} (from 0)"
        with entry(where):
            shape = region["shape_attributes"]
            corners = _of_via(shape)
            if corners is None:
                found.aside[f"{shape.get('name')}s"] += 1
                continue
            said = region.get("region_attributes") or {}
            key = next((k for k in _CLASSES if k in said), next(iter(said), ""))
            found.labelled(where, _text(said.get(key)), [[corners]])
    return found.file()


def _of_via(shape: Mapping[str, Any]) -> Any:
    kind = shape["name"]
    if kind == "polygon":
        return list(zip(shape["all_points_x"], shape["all_points_y"], strict=True))
    if kind == "rect":
        x, y, width, height = (float(shape[name]) for name in ("x", "y", "width", "height"))
        return rectangle((x, y), (x + width, y + height))
    if kind in {"circle", "ellipse"}:
        across, along = ("r", "r") if kind == "circle" else ("rx", "ry")
        radii = float(shape[across]), float(shape[along])
        return ellipse((shape["cx"], shape["cy"]), radii, float(shape.get("theta") or 0.0))
    return None


# CVAT


def is_cvat(data: bytes) -> bool:
    """Tell CVAT's own XML by its root element."""
    return b"<annotations" in data[:4096]


def read_cvat(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read polygons, boxes, ellipses and masks of CVAT for images."""
    root = xml_root(data, "XML", "Export the annotations of one image.")
    pictures = []
    with entry("the list of images"):
        for image in root.iter("image"):
            size = size_px(image.get("width"), image.get("height"))
            own = image.get("id", "")
            pictures.append(Pictured(image.get("name", ""), size, list(image), own))
    picture, found = chosen(pictures, settings.image), Gathered(settings)
    for number, shape in enumerate(picture.shapes):
        where = f"shape {number} (from 0)"
        with entry(where):
            if shape.tag in {"polygon", "box", "ellipse", "mask"}:
                is_mask = shape.tag == "mask"
                drawn = _mask_of_cvat(shape, found.room) if is_mask else [[_of_cvat(shape)]]
                found.labelled(where, shape.get("label", ""), drawn)
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
        return ellipse((one, two), (three, four), math.radians(turn))
    middle = (one + three) / 2.0, (two + four) / 2.0
    return _turned(rectangle((one, two), (three, four)), turn, middle)


def _mask_of_cvat(shape: ET.Element, room: Room) -> PlacedMask | None:
    """Return a mask of run lengths along the rows of its box, background first."""
    left, top, width, height = (
        place_px(shape.attrib[name]) for name in ("left", "top", "width", "height")
    )
    check_size(side_px(width), side_px(height), room.max_px)
    room.take(width * height)
    runs = np.array([int(run) for run in shape.attrib["rle"].split(",")], np.int64)
    if runs.min() < 0 or runs.max() > width * height or int(runs.sum()) != width * height:
        raise ValueError(f"its run lengths do not fill {width} x {height} px")
    flat = np.repeat(np.arange(len(runs)) % 2 == 1, runs)
    return trimmed(PlacedMask(flat.reshape(height, width), top, left))


# YOLO


def is_yolo(data: bytes) -> bool:
    """Tell lines of a class and coordinates."""
    return _YOLO.match(data) is not None


def read_yolo(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read segments of YOLO: a class and the corners, as shares of the picture, in a line."""
    found = Gathered(settings)
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), start=1):
        where = f"line {number}"
        with entry(where):
            kind, *values = line.split() or [""]
            if len(values) in {4, 5}:
                found.aside["boxes"] += 1
            elif values:
                if len(values) % 2:
                    raise ValueError("an odd number of coordinates")
                corners = np.array(values, float).reshape(-1, 2)
                found.add(where, [[corners]], label=kind)
    return found.file("Boxes have no outlines: train or label segments." if found.aside else "")
