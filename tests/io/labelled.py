"""Stones in the forms in which people keep outlines with classes: one picture, px, y down."""

import ezdxf
import numpy as np
from fuzz.forms import (
    SIZE,
    coco,
    cvat,
    label_studio,
    label_studio_short,
    labelme,
    qupath,
    qupath_list,
    via,
    via_alone,
    yolo,
)
from PIL import Image

from tests.io import pictures

WIDTH, HEIGHT = SIZE


def stones(seed=7, across=4, down=3):
    """Rings of stones that lie apart."""
    rng = np.random.default_rng(seed)
    found = []
    for row in range(down):
        for col in range(across):
            angles = (np.arange(9) + rng.uniform(0, 0.6, 9)) * 2 * np.pi / 9
            radii = rng.uniform(24, 32, 9)
            ring = np.column_stack([np.cos(angles), np.sin(angles)]) * radii[:, None]
            found.append((ring + np.array([45 + 90 * col, 45 + 85 * row])).round(2).tolist())
    return found


def box(x0, y0, x1, y1):
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


def svg(shapes):
    drawn = "".join(
        f'<g id="{label} {i}"><path d="M{" L".join(f"{x},{y}" for x, y in ring)} Z"/></g>'
        for i, (label, ring) in enumerate(shapes)
    )
    size = f'width="{WIDTH}" height="{HEIGHT}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{drawn}</svg>'


def dxf(shapes):
    document = ezdxf.new(units=ezdxf.units.MM)
    for label, ring in shapes:
        points = [(x, HEIGHT - y) for x, y in ring]
        document.modelspace().add_lwpolyline(points, close=True, dxfattribs={"layer": label})
    return document


_FILES = {
    coco: "coco.json", labelme: "labelme.json", qupath: "q.geojson", qupath_list: "list.geojson",
    label_studio: "studio.json", label_studio_short: "min.json", via: "via.json",
    via_alone: "via-json.json", cvat: "annotations.xml", svg: "a.svg", dxf: "a.dxf", yolo: "a.txt",
}  # fmt: skip
FORMS = {write.__name__: write for write in _FILES}
CLASSES = [form for form in FORMS if form != "yolo"]
"""Forms with the names of classes."""


def written(folder, form, shapes):
    """Write labels and rings; beside them lies the picture, as YOLO says no size of it."""
    Image.new("L", (WIDTH, HEIGHT)).save(folder / "a.png")
    name, content = _FILES[FORMS[form]], FORMS[form](shapes)
    if form != "dxf":
        return pictures.written(folder, content, name)
    content.saveas(folder / name)
    return folder / name
