"""Writers of the forms in which people keep outlines with classes: one picture, px, y down."""

import json

import ezdxf
import numpy as np
from PIL import Image

WIDTH, HEIGHT = 360, 260


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


def _json(path, content):
    path.write_text(json.dumps(content))
    return path


def coco(folder, shapes):
    names = list(dict.fromkeys(label for label, _ in shapes))
    return _json(
        folder / "coco.json",
        {
            "images": [{"id": 1, "file_name": "a.jpg", "width": WIDTH, "height": HEIGHT}],
            "categories": [{"id": i, "name": name} for i, name in enumerate(names)],
            "annotations": [
                {
                    "id": i,
                    "image_id": 1,
                    "category_id": names.index(label),
                    "segmentation": [np.ravel(ring).tolist()],
                }
                for i, (label, ring) in enumerate(shapes, start=1)
            ],
        },
    )


def labelme(folder, shapes):
    return _json(
        folder / "labelme.json",
        {
            "shapes": [
                {"label": label, "points": ring, "shape_type": "polygon"} for label, ring in shapes
            ],
            "imageWidth": WIDTH,
            "imageHeight": HEIGHT,
        },
    )


def _feature(label, ring, named=True):
    kind = {"name": label, "color": [1, 2, 3]} if named else label
    return {
        "type": "Feature",
        "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
        "properties": {"objectType": "annotation", "classification": kind},
    }


def qupath(folder, shapes):
    found = [_feature(label, ring) for label, ring in shapes]
    return _json(folder / "q.geojson", {"type": "FeatureCollection", "features": found})


def qupath_list(folder, shapes):
    found = [_feature(label, ring, named=False) for label, ring in shapes]
    return _json(folder / "list.geojson", found)


def _per_cent(ring):
    return (np.asarray(ring) * 100.0 / [WIDTH, HEIGHT]).tolist()


def label_studio(folder, shapes):
    result = [
        {
            "id": f"r{i}",
            "type": "polygonlabels",
            "original_width": WIDTH,
            "original_height": HEIGHT,
            "value": {"points": _per_cent(ring), "polygonlabels": [label]},
        }
        for i, (label, ring) in enumerate(shapes)
    ]
    task = {"id": 1, "data": {"image": "/d/a.jpg"}, "annotations": [{"id": 1, "result": result}]}
    return _json(folder / "studio.json", [task])


def label_studio_short(folder, shapes):
    drawn = [
        {
            "points": _per_cent(ring),
            "polygonlabels": [label],
            "original_width": WIDTH,
            "original_height": HEIGHT,
        }
        for label, ring in shapes
    ]
    return _json(folder / "min.json", [{"id": 1, "image": "/d/a.jpg", "label": drawn}])


def via(folder, shapes):
    regions = [
        {
            "shape_attributes": {
                "name": "polygon",
                "all_points_x": [x for x, _ in ring],
                "all_points_y": [y for _, y in ring],
            },
            "region_attributes": {"type": label},
        }
        for label, ring in shapes
    ]
    images = {"a.jpg9": {"filename": "a.jpg", "size": 9, "regions": regions}}
    return _json(folder / "via.json", {"_via_settings": {}, "_via_img_metadata": images})


def via_alone(folder, shapes):
    content = json.loads(via(folder, shapes).read_text())["_via_img_metadata"]
    for region in content["a.jpg9"]["regions"]:
        region["region_attributes"] = {"kind": {region["region_attributes"]["type"]: True}}
    return _json(folder / "via-json.json", content)


def cvat(folder, shapes):
    drawn = "".join(
        f'<polygon label="{label}" points="{";".join(f"{x},{y}" for x, y in ring)}"/>'
        for label, ring in shapes
    )
    image = f'<image id="0" name="a.jpg" width="{WIDTH}" height="{HEIGHT}">{drawn}</image>'
    path = folder / "annotations.xml"
    path.write_text(
        f'<?xml version="1.0"?>\n<annotations><version>1.1</version>{image}</annotations>'
    )
    return path


def yolo(folder, shapes):
    names = list(dict.fromkeys(label for label, _ in shapes))
    lines = [
        " ".join(
            map(str, [names.index(label), *np.ravel(np.asarray(ring) / [WIDTH, HEIGHT]).round(6)])
        )
        for label, ring in shapes
    ]
    Image.new("L", (WIDTH, HEIGHT)).save(folder / "a.png")
    path = folder / "a.txt"
    path.write_text("\n".join(lines) + "\n")
    return path


def svg(folder, shapes):
    drawn = "".join(
        f'<g id="{label} {i}"><path d="M{" L".join(f"{x},{y}" for x, y in ring)} Z"/></g>'
        for i, (label, ring) in enumerate(shapes)
    )
    path = folder / "a.svg"
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}">{drawn}</svg>'
    )
    return path


def dxf(folder, shapes):
    document = ezdxf.new(units=ezdxf.units.MM)
    for label, ring in shapes:
        points = [(x, HEIGHT - y) for x, y in ring]
        document.modelspace().add_lwpolyline(points, close=True, dxfattribs={"layer": label})
    document.saveas(folder / "a.dxf")
    return folder / "a.dxf"


CLASSES = {
    one.__name__: one
    for one in (
        coco, labelme, qupath, qupath_list, label_studio, label_studio_short, via, via_alone, cvat,
        svg, dxf,
    )
}  # fmt: skip
"""Forms with the names of classes."""

FORMS = CLASSES | {"yolo": yolo}
