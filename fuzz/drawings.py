"""Valid annotations, drawings and meshes of the same stones."""

import base64
import io
import json
from collections.abc import Sequence
from typing import Any

import ezdxf
import numpy as np
from ezdxf import units

from fuzz import forms
from fuzz.pictures import HEIGHT, STONES, WIDTH, label_image, pngs

Point = tuple[float, float]
SIZE = WIDTH, HEIGHT


def _json(*contents: Any) -> Sequence[bytes]:
    return [json.dumps(content).encode() for content in contents]


def labelme() -> Sequence[bytes]:
    """Return shapes of all kinds, a mask among them."""
    drawn = forms.labelme(((f"stone {i}", outline) for i, outline in STONES.items()), SIZE)
    mask = {
        "label": "3", "points": [[0, 0], [WIDTH - 1, HEIGHT - 1]], "shape_type": "mask",
        "mask": base64.b64encode(pngs()[5]).decode(),
    }  # fmt: skip
    circle = {"label": "a", "points": [[9, 9], [9, 14]], "shape_type": "circle", "group_id": 1}
    box = {"label": "a", "points": [[20, 20], [30, 30]], "shape_type": "rectangle", "group_id": 1}
    drawn |= {"version": "5.8.1", "imagePath": "photo.jpg", "imageData": None}
    page = {"px_per_m": 200.0, "ground": [[0, HEIGHT], [WIDTH, HEIGHT - 2.5]], "not_used": [2]}
    return _json(
        {**drawn, "drystone": page},
        {**drawn, "shapes": [mask, circle, box, drawn["shapes"][0]]},
    )


def _packed(runs: dict[str, Any]) -> dict[str, Any]:
    """Return run lengths as COCO packs them into text: differences in groups of five bits."""
    counts, text = runs["counts"], ""
    for i, count in enumerate(counts):
        left, more = count - (counts[i - 2] if i > 2 else 0), True
        while more:
            bits, left = left & 31, left >> 5
            more = left != (-1 if bits & 16 else 0)
            text += chr(48 + (bits | 32 * more))
    return {"size": runs["size"], "counts": text}


def coco() -> Sequence[bytes]:
    """Return annotations with polygons and with run lengths of both kinds."""
    flat = {stone: [np.ravel(outline).tolist()] for stone, outline in STONES.items()}
    runs = {stone: forms.runs_of(label_image() == stone) for stone in STONES}
    packed = {stone: _packed(found) for stone, found in runs.items()}
    files = [forms.coco_of(shapes, SIZE) for shapes in (flat, runs, packed)]
    return _json(*files, forms.coco_of(packed, SIZE, predicted_iou=0.9))


def sam() -> Sequence[bytes]:
    """Return lists of masks as run lengths of both kinds, rows of truth values, and polygons."""
    runs = [forms.runs_of(label_image() == stone) for stone in STONES]
    shapes = [*map(_packed, runs), [np.ravel(STONES[9]).tolist()]]
    rows = [(label_image()[::3, ::3] == stone).astype(int).tolist() for stone in STONES]
    return _json(
        [{"segmentation": shape, "area": 9, "bbox": [0, 0, 9, 9]} for shape in shapes],
        [{"segmentation": shape, "image_id": 7, "score": 0.5} for shape in runs],
        [{"segmentation": shape} for shape in rows],
    )


def geojson() -> Sequence[bytes]:
    """Return features in px of an image, and in metres."""
    rings = {stone: [*outline, outline[0]] for stone, outline in STONES.items()}
    features = [
        {
            "type": "Feature", "id": stone, "properties": {"name": f"s{stone}"},
            "geometry": {"type": "Polygon", "coordinates": [ring]},
        }
        for stone, ring in rings.items()
    ]  # fmt: skip
    several = {"type": "MultiPolygon", "coordinates": [[ring] for ring in rings.values()]}
    more = [{"type": "Feature", "properties": None, "geometry": several}]
    whole = {"type": "FeatureCollection", "features": features}
    metres = {"unit": "mm", "crs": {"type": "name", "properties": {"name": "local"}}}
    collection = {"type": "GeometryCollection", "geometries": [several]}
    return _json(whole, {**whole, **metres}, {**whole, "features": more}, collection)


def exports() -> Sequence[bytes]:
    """Return what Label Studio, VIA and QuPath export, and an instance of a nesting program."""
    shapes = [("stone", outline) for outline in STONES.values()]
    tasks, images = forms.label_studio(shapes, SIZE), forms.via_alone(shapes)
    results, regions = tasks[0]["annotations"][0]["result"], images["a.jpg9"]["regions"]
    turned = {"x": 5, "y": 5, "width": 20, "height": 9, "rotation": 30, "rectanglelabels": ["bar"]}
    results.append({**results[0], "id": "r", "type": "rectanglelabels", "value": turned})
    circle = {"name": "circle", "cx": 9, "cy": 9, "r": 5}
    regions.append({"shape_attributes": circle, "region_attributes": {}})
    items: list[dict[str, Any]] = [
        {"id": stone, "demand": 1, "shape": {"type": "simple_polygon", "data": outline}}
        for stone, outline in STONES.items()
    ]
    hole = {"outer": STONES[7], "inner": []}
    items.append({"id": 0, "demand": 2, "shape": {"type": "polygon", "data": hole}})
    features = forms.qupath_list(shapes, lambda label: {"name": label})
    return _json(tasks, images, {"name": "a", "items": items}, features)


def cvat() -> Sequence[bytes]:
    """Return an image with shapes of all kinds."""
    shapes = [("stone", outline) for outline in STONES.values()]
    more = '<box label="bar" xtl="1" ytl="1" xbr="9" ybr="5" rotation="10"/>'
    more += '<ellipse label="a" cx="30" cy="9" rx="8" ry="4"/>'
    more += '<mask label="a" rle="2, 4, 2, 4" left="50" top="9" width="4" height="3"/>'
    return [forms.cvat(shapes, SIZE, more).encode()]


def yolo() -> Sequence[bytes]:
    """Return segments, which are refused for want of a picture, and such as are px."""
    shapes = [("stone", outline) for outline in STONES.values()]
    return [forms.yolo(shapes, size).encode() for size in ((1, 1), SIZE)]


def dxf() -> Sequence[bytes]:
    """Return drawings with polylines alone, and with curves and blocks, as text and in bytes."""
    ezdxf.options.write_fixed_meta_data_for_testing = True  # the same bytes every time
    found = [_least_dxf()]
    for binary in (False, True):
        document = ezdxf.new("R2010", units=units.CM)
        space = document.modelspace()
        for stone, outline in STONES.items():
            corners = [(x, HEIGHT - y) for x, y in outline]
            space.add_polyline2d(corners, close=True, dxfattribs={"layer": f"s{stone}"})
        space.add_circle((60, 9), 8)
        block = document.blocks.new("STONE")
        block.add_polyline2d([(0, 0), (4, 0), (4, 3), (0, 3)], close=True)
        space.add_blockref("STONE", (10, 50), dxfattribs={"rotation": 90, "xscale": 2})
        space.add_lwpolyline([(70, 0), (90, 0, 1), (80, 9)], "xyb", close=True)
        space.add_ellipse((40, 50), major_axis=(9, 0), ratio=0.4)
        through = space.add_spline([(60, 60, 0), (70, 60, 0), (70, 70, 0), (60, 72, 0)])
        through.dxf.flags = 1
        fitted = space.add_polyline2d([(0, 0), (9, 0), (9, 9), (4, 5)], close=True)
        fitted.vertices[3].dxf.flags |= 16
        space.add_spline().set_closed([(60, 40, 0), (70, 40, 0), (70, 50, 0), (60, 50, 0)])
        buffer = io.BytesIO() if binary else io.StringIO()
        document.write(buffer, fmt="bin" if binary else "asc")
        data = buffer.getvalue()
        found.append(data if isinstance(data, bytes) else data.encode())
    return found


def _least_dxf() -> bytes:
    """Return a drawing of outlines and nothing else, which is read much faster."""
    groups: list[tuple[int, object]] = [
        (0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009"), (9, "$INSUNITS"), (70, 4),
        (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES"),
    ]  # fmt: skip
    for stone, outline in STONES.items():
        groups += [(0, "POLYLINE"), (8, f"s{stone}"), (66, 1), (70, 1)]
        for x, y in outline:
            groups += [(0, "VERTEX"), (8, "0"), (10, x), (20, HEIGHT - y)]
        groups.append((0, "SEQEND"))
    groups += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code:3d}\n{value}\n" for code, value in groups).encode()


def svg() -> Sequence[bytes]:
    """Return drawings in px and in mm, with definitions, styles, transforms and curves."""
    data = {
        stone: "M" + "L".join(f"{x} {y}" for x, y in outline) + "Z"
        for stone, outline in STONES.items()
    }
    head = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    paths = "".join(f'<path id="stone_{stone}" d="{d}"/>' for stone, d in data.items())
    shapes = (
        '<rect x="1" y="2" width="9" height="8" rx="2"/><circle cx="20" cy="9" r="6"/>'
        '<ellipse cx="35" cy="9" rx="8" ry="5"/><polygon points="2,20 20,20 9,30"/>'
        '<path d="M24 16c4 0 9 2 9 6s-3 6-6 6-9-3-6-9zm14 4a4 4 0 1 1 .1 0z" fill-rule="evenodd"/>'
    )
    used = (
        f"<style>.a{{display:none}} g > path, #b {{fill-rule:evenodd}}</style><defs>{paths}</defs>"
        '<g transform="translate(1 2) rotate(3) scale(.9)" style="fill:red">'
        '<use href="#stone_7"/><use xlink:href="#stone_9" x="1"/><path class="a" d="M0 0h9v9"/></g>'
        '<svg x="5%" y="1" width="9mm" height="9" viewBox="0 0 9 9"><rect width="50%" height="5"/>'
        '</svg><g id="stones"><use href="#stone_12" transform="matrix(1 0 .1 1 0 0)"/></g>'
    )
    clipped = (
        f'<clipPath id="c" transform="scale(1.5)"><path d="M0 0H40V9L30 60z" clip-rule="evenodd"/>'
        f'<use href="#r" x="3"/></clipPath><g clip-path="url(#c)">{shapes}</g><defs><rect id="r" '
        'width="9" height="9"/></defs><clipPath id="b" clipPathUnits="objectBoundingBox"><circle '
        f'r=".7"/></clipPath><circle r="20" clip-path="url(#b)"/>'
    )
    mm = f'width="{WIDTH}mm" height="{HEIGHT}mm" viewBox="0 0 {WIDTH} {HEIGHT}"'
    return [
        f'<?xml version="1.0"?>\n{head} {size}>\n{body}\n</svg>\n'.encode()
        for body, size in (
            (paths, mm),
            (shapes, 'width="48" height="32"'),
            (used, mm),
            (clipped, 'width="48" height="32"'),
        )
    ]


def _prism(outline: Sequence[Point]) -> tuple[list[tuple[float, float, float]], list[list[int]]]:
    """Return corners and triangles of a convex outline that is 5 thick, y up."""
    size = len(outline)
    corners = [(x, HEIGHT - y, z) for z in (0.0, 5.0) for x, y in outline]
    lids = [[at, at + i, at + i + 1] for at in (0, size) for i in range(1, size - 1)]
    sides = [[i, (i + 1) % size, size + i] for i in range(size)]
    return corners, [
        *lids,
        *sides,
        *([(i + 1) % size, size + (i + 1) % size, size + i] for i in range(size)),
    ]


def obj() -> Sequence[bytes]:
    """Return a mesh with named objects and one without."""
    texts, first = ["# drystone mm\n", ""], 1
    for stone, outline in STONES.items():
        corners, faces = _prism(outline)
        body = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        body += "".join(f"f {' '.join(str(first + i) for i in face)}\n" for face in faces)
        texts = [texts[0] + f"o stone_{stone}\n" + body, texts[1] + body]
        first += len(corners)
    return [text.encode() for text in texts]


def _whole() -> tuple[np.ndarray, np.ndarray]:
    corners, faces = [], []
    for outline in STONES.values():
        more, their = _prism(outline)
        faces += [[len(corners) + i for i in face] for face in their]
        corners += more
    return np.array(corners, "<f4"), np.array(faces, "<i4")


def ply() -> Sequence[bytes]:
    """Return a mesh as text, and in both orders of bytes."""
    corners, faces = _whole()
    found = []
    for form, order in (("ascii", "<"), ("binary_little_endian", "<"), ("binary_big_endian", ">")):
        head = (
            f"ply\nformat {form} 1.0\nelement vertex {len(corners)}\nproperty float x\n"
            f"property float y\nproperty float z\nelement face {len(faces)}\n"
            "property list uchar int vertex_indices\nend_header\n"
        ).encode()
        if form == "ascii":
            lines = [" ".join(map(str, corner)) for corner in corners.tolist()]
            lines += [" ".join(map(str, [3, *face])) for face in faces.tolist()]
            found.append(head + ("\n".join(lines) + "\n").encode())
            continue
        rows = np.zeros(len(faces), [("n", "u1"), ("face", f"{order}i4", 3)])
        rows["n"], rows["face"] = 3, faces
        found.append(head + corners.astype(f"{order}f4").tobytes() + rows.tobytes())
    return found


def stl() -> Sequence[bytes]:
    """Return a mesh as text and in bytes."""
    corners, faces = _whole()
    triangles = corners[faces]
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in triangle)
        + "endloop\nendfacet\n"
        for triangle in triangles.tolist()
    )
    return [f"solid a\n{facets}endsolid a\n".encode(), binary_stl(triangles, b"drystone, mm")]


def binary_stl(triangles: np.ndarray, title: bytes = b"") -> bytes:
    """Return triangles, (n, 3, 3), in bytes."""
    rows = np.zeros(
        len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("a", "<u2")]
    )
    rows["corners"] = triangles
    return title.ljust(80, b"\0") + len(triangles).to_bytes(4, "little") + rows.tobytes()
