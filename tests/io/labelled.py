"""Writers of the forms in which people keep outlines with classes: one picture, px, y down."""

import ezdxf
import numpy as np
from PIL import Image

from tests.io import pictures

WIDTH, HEIGHT = 360, 260
SIZE = {"original_width": WIDTH, "original_height": HEIGHT}


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


def _names(shapes):
    return list(dict.fromkeys(label for label, _ in shapes))


def _share(ring, whole=1.0):
    return np.asarray(ring) * whole / [WIDTH, HEIGHT]


def coco(shapes):
    names = _names(shapes)
    found = [
        {"id": i, "image_id": 1, "category_id": names.index(label),
         "segmentation": [np.ravel(ring).tolist()]}
        for i, (label, ring) in enumerate(shapes, start=1)
    ]  # fmt: skip
    return {
        "images": [{"id": 1, "file_name": "a.jpg", "width": WIDTH, "height": HEIGHT}],
        "categories": [{"id": i, "name": name} for i, name in enumerate(names)],
        "annotations": found,
    }


def labelme(shapes):
    drawn = [{"label": label, "points": ring, "shape_type": "polygon"} for label, ring in shapes]
    return {"shapes": drawn, "imageWidth": WIDTH, "imageHeight": HEIGHT}


def qupath_list(shapes, kind=str):
    return [
        {
            "type": "Feature",
            "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
            "properties": {"objectType": "annotation", "classification": kind(label)},
        }
        for label, ring in shapes
    ]


def qupath(shapes):
    found = qupath_list(shapes, lambda label: {"name": label, "color": [1, 2, 3]})
    return {"type": "FeatureCollection", "features": found}


def label_studio(shapes):
    drawn = [
        {"points": _share(ring, 100).tolist(), "polygonlabels": [label]} for label, ring in shapes
    ]
    result = [
        {"id": f"r{i}", "type": "polygonlabels", "value": value} | SIZE
        for i, value in enumerate(drawn)
    ]
    return [{"id": 1, "data": {"image": "/d/a.jpg"}, "annotations": [{"id": 1, "result": result}]}]


def label_studio_short(shapes):
    (task,) = label_studio(shapes)
    drawn = [one["value"] | SIZE for one in task["annotations"][0]["result"]]
    return [{"id": 1, "image": "/d/a.jpg", "label": drawn}]


def via_alone(shapes, said=lambda label: {"kind": {label: True}}):
    regions = []
    for label, ring in shapes:
        across, down = zip(*ring, strict=True)
        shape = {"name": "polygon", "all_points_x": across, "all_points_y": down}
        regions.append({"shape_attributes": shape, "region_attributes": said(label)})
    return {"a.jpg9": {"filename": "a.jpg", "size": 9, "regions": regions}}


def via(shapes):
    images = via_alone(shapes, lambda label: {"type": label})
    return {"_via_settings": {}, "_via_img_metadata": images}


def cvat(shapes):
    drawn = "".join(
        f'<polygon label="{label}" points="{";".join(f"{x},{y}" for x, y in ring)}"/>'
        for label, ring in shapes
    )
    image = f'<image id="0" name="a.jpg" width="{WIDTH}" height="{HEIGHT}">{drawn}</image>'
    return f'<?xml version="1.0"?>\n<annotations><version>1.1</version>{image}</annotations>'


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


def yolo(shapes):
    names = _names(shapes)
    rows = ([names.index(label), *np.ravel(_share(ring)).round(6)] for label, ring in shapes)
    return "".join(f"{' '.join(map(str, row))}\n" for row in rows)


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
