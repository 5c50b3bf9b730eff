"""Outlines with classes in the forms of labelling tools: of one picture, px, y down."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Shapes = Iterable[tuple[str, Sequence[Sequence[float]]]]
"""Class and corners of each."""
Size = tuple[int, int]
SIZE = (360, 260)
"""Width and height of the picture, px, where nothing else is said."""


def coco(shapes: Shapes, size: Size = SIZE) -> dict[str, Any]:
    """Return annotations whose classes are categories."""
    shapes = list(shapes)
    names = _names(shapes)
    found = [
        {"id": i, "image_id": 1, "category_id": names.index(label),
         "segmentation": [np.ravel(ring).tolist()]}
        for i, (label, ring) in enumerate(shapes, start=1)
    ]  # fmt: skip
    return {
        "images": [{"id": 1, "file_name": "a.jpg", "width": size[0], "height": size[1]}],
        "categories": [{"id": i, "name": name} for i, name in enumerate(names)],
        "annotations": found,
    }


def coco_of(segmentations: Mapping[int, Any], size: Size, **more: Any) -> dict[str, Any]:
    """Return annotations of one class by their ids, in any form of COCO; `more` is of each."""
    return {
        "images": [{"id": 7, "file_name": "a/photo.jpg", "width": size[0], "height": size[1]}],
        "categories": [{"id": 1, "name": "stone"}],
        "annotations": [
            {"id": i, "image_id": 7, "category_id": 1, "iscrowd": 0, "segmentation": s, **more}
            for i, s in segmentations.items()
        ],
    }


def runs_of(mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Return the pixels of a mask as run lengths, column by column."""
    flat = mask.ravel(order="F").astype(int)
    ends = np.flatnonzero(np.diff(flat, prepend=0)).tolist()
    return {"size": list(mask.shape), "counts": np.diff([0, *ends, flat.size]).tolist()}


def labelme(shapes: Shapes, size: Size = SIZE) -> dict[str, Any]:
    """Return polygons under their labels."""
    drawn = [{"label": label, "points": ring, "shape_type": "polygon"} for label, ring in shapes]
    return {"shapes": drawn, "imageWidth": size[0], "imageHeight": size[1]}


def qupath_list(shapes: Shapes, kind: Callable[[str], Any] = str) -> list[dict[str, Any]]:
    """Return the features that QuPath exports, as it does by default."""
    return [
        {
            "type": "Feature",
            "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
            "properties": {"objectType": "annotation", "classification": kind(label)},
        }
        for label, ring in shapes
    ]


def qupath(shapes: Shapes) -> dict[str, Any]:
    """Return the same as a collection."""
    found = qupath_list(shapes, lambda label: {"name": label, "color": [1, 2, 3]})
    return {"type": "FeatureCollection", "features": found}


def label_studio(shapes: Shapes, size: Size = SIZE) -> list[dict[str, Any]]:
    """Return a task with its annotation, in per cent of the picture."""
    whole = {"original_width": size[0], "original_height": size[1]}
    result = [
        {"id": f"r{i}", "type": "polygonlabels",
         "value": {"points": _shares(ring, size, 100).tolist(), "polygonlabels": [label]}} | whole
        for i, (label, ring) in enumerate(shapes)
    ]  # fmt: skip
    return [{"id": 1, "data": {"image": "/d/a.jpg"}, "annotations": [{"id": 1, "result": result}]}]


def label_studio_short(shapes: Shapes, size: Size = SIZE) -> list[dict[str, Any]]:
    """Return the same in the short form."""
    (task,) = label_studio(shapes, size)
    results = task["annotations"][0]["result"]
    drawn = [one["value"] | {k: v for k, v in one.items() if "orig" in k} for one in results]
    return [{"id": 1, "image": "/d/a.jpg", "label": drawn}]


def via_alone(
    shapes: Shapes, said: Callable[[str], Any] = lambda label: {"kind": {label: True}}
) -> dict[str, Any]:
    """Return the annotations of VIA, classes as attributes of any kind."""
    regions = []
    for label, ring in shapes:
        across, down = zip(*ring, strict=True)
        shape = {"name": "polygon", "all_points_x": across, "all_points_y": down}
        regions.append({"shape_attributes": shape, "region_attributes": said(label)})
    return {"a.jpg9": {"filename": "a.jpg", "size": 9, "regions": regions}}


def via(shapes: Shapes) -> dict[str, Any]:
    """Return a project of VIA."""
    images = via_alone(shapes, lambda label: {"type": label})
    return {"_via_settings": {}, "_via_img_metadata": images}


def cvat(shapes: Shapes, size: Size = SIZE, more: str = "") -> str:
    """Return CVAT for images, with further elements in the image."""
    drawn = "".join(
        f'<polygon label="{label}" points="{";".join(f"{x},{y}" for x, y in ring)}"/>'
        for label, ring in shapes
    )
    image = f'<image id="0" name="a.jpg" width="{size[0]}" height="{size[1]}">{drawn}{more}</image>'
    return f'<?xml version="1.0"?>\n<annotations><version>1.1</version>{image}</annotations>'


def yolo(shapes: Shapes, size: Size = SIZE) -> str:
    """Return segments, in shares of the picture."""
    shapes = list(shapes)
    names = _names(shapes)
    rows = ([names.index(label), *np.ravel(_shares(ring, size)).round(6)] for label, ring in shapes)
    return "".join(f"{' '.join(map(str, row))}\n" for row in rows)


def _names(shapes: Shapes) -> list[str]:
    return list(dict.fromkeys(label for label, _ in shapes))


def _shares(ring: Sequence[Sequence[float]], size: Size, whole: float = 1.0) -> Any:
    return np.asarray(ring) * whole / size
