"""Every damaged file of outlines gets a coded error that names the entry; extras are named too."""

import base64
import json
import sys

import numpy as np
import pytest

from drystone.errors import InputError, UsageError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import masks
from tests.io.test_annotations import coco, geojson, labelme, runs
from tests.io.test_formats import pillow

SQUARE = [[1, 1], [30, 1], [30, 30], [1, 30]]


def read(tmp_path, content, name="stones.json", **settings):
    text = content if isinstance(content, str) else json.dumps(content)
    (tmp_path / name).write_text(text)
    return read_stones(tmp_path / name, settings=ReadSettings(**settings))


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("{", r"cannot be read, it may be cut short"),
        ({"type": ["object", "null"]}, r"its keys are 'type'"),
        ({"a": 1, "b": 2}, r"its keys are 'a', 'b'.*labelme.*COCO.*SAM.*GeoJSON"),
        ([{"bbox": [1, 2]}], r"none of the known forms"),
        ({"schema": "drystone-photo/1", "px_per_m": 3}, r"beside the label image.*Give stones.png"),
        ({"steps": [], "source": {}, "wall": {}}, r"is a plan.*Give the stones"),
        ({"blocks": []}, r"block model of a wall"),
    ],
)
def test_json_of_another_kind(tmp_path, content, text):
    with pytest.raises(InputError, match=rf"E113 stones.json: .*{text}"):
        read(tmp_path, content)


def shape(**changes):
    return labelme(shapes=[{"label": "1", "points": SQUARE} | changes])


DOT = base64.b64encode(pillow(np.full((1, 1), 255, np.uint8), "PNG")).decode()
"""A mask of one pixel."""


def annotation(segmentation):
    return coco({5: segmentation})


def feature(geometry):
    return geojson(features=[{"type": "Feature", "properties": {}, "geometry": geometry}])


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (shape(points=[*SQUARE, ["a", 2]]), r"shape 0.*could not convert"),
        (shape(points=[*SQUARE, [float("nan"), 2]]), r"shape 0.*not finite"),
        (shape(shape_type="circle", points=[[1, 2]]), r"shape 0"),
        (shape(shape_type="mask", points=SQUARE[:2], mask="####"), r"shape 0"),
        (shape(shape_type="mask", points=SQUARE[:2], mask="aGVsbG8="), r"shape 0.*not a picture"),
        (shape(shape_type="mask", points=[[1e30, 0], [1e30, 9]], mask=DOT), r"shape 0.*beyond 1e9"),
        (labelme(shapes=[{"label": "1"}]), r"shape 0.*has no 'points'"),
        (annotation([[1, 1, 5]]), r"annotation 5.*odd number"),
        (annotation({"size": [3, 3], "counts": [0, 9]}), r"the image.*sizes differ: 3 x 3, 320 x"),
        (coco({}, annotations=[3]), r"annotations are not objects"),
        (coco({}, categories=["stone"]), r"list of categories"),
        (coco({}, annotations=[{"image_id": [7]}]), r"list of images"),
        (labelme(imageWidth=0), r"size of the image.*is 0 px"),
        ([{"segmentation": [[True, False], [True]]}], r"mask 1"),
        ([{"segmentation": runs(masks()[3])}, {"segmentation": {"size": [3, 3], "counts": [9]}}],
         r"the image.*sizes differ"),
        (feature({"type": "Polygon", "coordinates": []}), r"feature 0.*no ring"),
        (geojson(features=None), r"list of features|feature"),
    ],
)  # fmt: skip
def test_damaged_entries_are_named(tmp_path, content, text):
    with pytest.raises(InputError, match=rf"E114 stones.json: .*{text}"):
        read(tmp_path, content)


def test_sam_of_several_images(tmp_path):
    content = [{"image_id": i, "segmentation": [[1, 1, 30, 1, 30, 30]]} for i in (1, 2)]
    with pytest.raises(InputError, match=r"E115 .*2 images.*there are 1, 2"):
        read(tmp_path, content)
    assert len(read(tmp_path, content, image="2")) == 1
    with pytest.raises(InputError, match=r"E115 .*no image or several are called '2'.*there are 1"):
        read(tmp_path, content[:1], image="2")


def test_files_that_name_no_images_have_none_to_choose_from(tmp_path):
    for content in (labelme(), [{"segmentation": [[1, 1, 30, 1, 30, 30]]}], geojson()):
        with pytest.raises(UsageError, match=r"E118 stones.json: .*'tray'.*Leave --image"):
            read(tmp_path, content, image="tray")


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"crs": {"properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}}, "degrees"),
        ({"unit": "parsec"}, "'parsec' is not known"),
        ({"unit": None}, "None is not known"),
    ],
)
def test_geojson_in_no_length(tmp_path, changes, text):
    with pytest.raises(InputError, match=rf"E116 .*{text}"):
        read(tmp_path, geojson(**changes))


def test_no_stones(tmp_path):
    for content in (labelme(shapes=[]), coco({}), [], geojson(features=[])):
        with pytest.raises(InputError, match=r"E104 stones.json: there are no stones"):
            read(tmp_path, content)


def test_stones_outside_the_image_are_none(tmp_path):
    far = shape(points=[[400, 400], [430, 400], [430, 430]])
    with pytest.raises(InputError, match=r"E104.*without a pixel, left out: stone 1 \(1\)"):
        read(tmp_path, far)


def test_names_can_be_written_and_printed(tmp_path):
    (stone,) = read(tmp_path, shape(label="Stein \ud83e"))
    assert stone.name.encode() == b"Stein ?"


@pytest.mark.parametrize(
    ("name", "text", "package", "extra"),
    [("a.dxf", "0\nSECTION\n", "ezdxf", "cad"), ("a.ply", "ply\n", "trimesh", "mesh")],
)
def test_extras_that_are_not_installed(tmp_path, monkeypatch, name, text, package, extra):
    monkeypatch.setitem(sys.modules, package, None)
    said = rf"E305 .*{package} is not installed.*pip install drystone\[{extra}\]"
    with pytest.raises(UsageError, match=said):
        read(tmp_path, text, name)
