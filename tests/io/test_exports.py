"""Further forms of labelling tools and nesting programs, and the codes of damaged files."""

import base64
import sys

import numpy as np
import pytest
from fuzz.pictures import held, pillow
from PIL import Image

from drystone.errors import InputError, UsageError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import masks
from tests.io.labelled import HEIGHT, WIDTH, box, stones, written
from tests.io.pictures import written as file_of
from tests.io.test_annotations import coco, geojson, labelme, runs


def read(tmp_path, content, name="stones.json", **settings):
    return read_stones(file_of(tmp_path, content, name), settings=ReadSettings(**settings))


SIZE = {"original_width": WIDTH, "original_height": HEIGHT}
PER_CENT = {"x": 25.0, "y": 25.0}  # 90, 65


def task(*results, image="/data/a%20b.jpg", **more):
    made = {"data": {"image": image}, "annotations": [{"result": list(results)}]}
    return made | more


def result(value, kind="rectanglelabels", **more):
    return {"type": kind, "value": value | {kind: ["stone"]}} | SIZE | more


def test_boxes_and_ellipses_of_label_studio(tmp_path):
    flat = {"width": 20.0, "height": 10.0}
    ellipse = {"radiusX": 10.0, "radiusY": 5.0, "rotation": 30}
    for more, area, centre in (
        (flat | {"rotation": 0}, 72 * 26, (126, 78)),
        (flat | {"rotation": 90}, 72 * 26, (77, 101)),
        (ellipse, np.pi * 36 * 13, (90, 65)),
    ):
        kind = "ellipselabels" if more is ellipse else "rectanglelabels"
        (stone,) = read(tmp_path, [task(result(PER_CENT | more, kind))])
        assert stone.area_px == pytest.approx(area, rel=0.01)
        x, y = stone.centroid
        assert (x, HEIGHT - y) == pytest.approx(centre, abs=0.5)


def test_results_of_label_studio_that_are_no_outlines(tmp_path):
    plain = {"width": 20.0, "height": 10.0} | PER_CENT
    results = [
        {"type": "rectangle", "id": "r", "value": plain} | SIZE,
        result(plain, "rectanglelabels", id="r"),
        {"type": "choices", "value": {"choices": ["wet"]}},
        {"type": "relation", "from_id": "r", "to_id": "q"},
        result({"format": "rle", "rle": [1, 2]}, "brushlabels"),
    ]
    found = read(tmp_path, [task(*results)])
    assert len(found) == 1
    for kind in ("brushlabels", "choices"):
        assert f"type {kind}" in found.notices[0].message
    assert "COCO or PNG" in found.notices[0].cure


def test_tasks_and_annotators_of_label_studio(tmp_path):
    one, other = (result(PER_CENT | {"width": w, "height": 10.0}) for w in (10.0, 20.0))
    both = [task(one), task(other, image="/data/c.jpg")]
    with pytest.raises(InputError, match=r"E115.*2 images.*c.jpg"):
        read(tmp_path, both)
    (stone,) = read(tmp_path, both, image="c.jpg")
    assert stone.area_px == 72 * 26
    twice = task(one)
    twice["annotations"] += [{"result": [other]}, {"result": [one], "was_cancelled": True}]
    found = read(tmp_path, twice)
    assert [stone.area_px for stone in found] == [72 * 26]
    assert "1 earlier annotations" in found.notices[0].message


def test_shapes_of_via(tmp_path):
    shapes = [
        {"name": "rect", "x": 10, "y": 10, "width": 40, "height": 30},
        {"name": "circle", "cx": 100, "cy": 40, "r": 20},
        {"name": "ellipse", "cx": 200, "cy": 40, "rx": 30, "ry": 10, "theta": 0.5},
        {"name": "point", "cx": 1, "cy": 2},
    ]
    drawn = {str(i): {"shape_attributes": s, "region_attributes": {}} for i, s in enumerate(shapes)}
    images = {"a9": {"filename": "a.jpg", "regions": drawn}, "b9": {"filename": "b", "regions": []}}
    found = read(tmp_path, images)
    truth = [1200, np.pi * 400, np.pi * 300]
    assert [stone.area_px for stone in found] == pytest.approx(truth, rel=0.02)
    assert "1 points" in found.notices[0].message
    assert "how large its picture is: taken as 227 x 60 px" in found.notices[1].message


def test_shapes_of_cvat(tmp_path):
    runs = [2 * 12 + 3, *[9, 3] * 4, 9, 2 * 12]
    shapes = (
        '<box label="stone" xtl="10" ytl="10" xbr="50" ybr="30" rotation="90"/>'
        '<ellipse label="stone" cx="100" cy="40" rx="20" ry="10"/>'
        f'<mask label="stone" rle="{", ".join(map(str, runs))}" left="200" top="100" width="12"'
        ' height="9"/><polyline label="stone" points="1,1;2,2"/>'
    )
    image = '<image id="0" name="d/a.jpg" width="360" height="260">{}</image>'
    root = f"<annotations>{image}{{}}</annotations>"
    found = read(tmp_path, root.format(shapes, ""), "annotations.xml")
    assert [s.area_px for s in found] == pytest.approx([800, np.pi * 200, 45], rel=0.02)
    assert found.by_id(1).mask.shape == (40, 20)
    assert (found.by_id(3).left_px, HEIGHT - found.by_id(3).bottom_px) == (203, 107)
    assert "1 polylines" in found.notices[0].message
    with pytest.raises(InputError, match="E106"):
        read(tmp_path, root[:-9], "annotations.xml")
    two = root.format(shapes, f'<image id="1" name="b.jpg">{shapes}</image>')
    with pytest.raises(InputError, match=r"E115"):
        read(tmp_path, two, "annotations.xml")
    assert len(read(tmp_path, two, "annotations.xml", image="a.jpg")) == 3


@pytest.mark.parametrize("turned", [False, True])
def test_segments_of_yolo_have_the_proportions_of_their_picture(tmp_path, turned):
    path = written(tmp_path, "yolo", [("stone", ring) for ring in stones()])
    photo, sides = tmp_path / "photo.jpg", (HEIGHT, WIDTH) if turned else (WIDTH, HEIGHT)
    Image.new("L", sides).save(photo, exif=held(6 if turned else 1))
    path.write_text("0 .5 .5 .1 .1\n" + path.read_text())
    found = read_stones(path, settings=ReadSettings(image=str(photo)))
    assert (found.source.width_px, found.source.height_px) == (WIDTH, HEIGHT)
    assert "1 boxes" in found.notices[0].message


def item(number, kind, data, demand=1):
    shape = {"type": kind, "data": data}
    return {"id": number, "demand": demand, "allowed_orientations": [0], "shape": shape}


def test_items_of_a_nesting_instance(tmp_path):
    content = {"name": "pile", "strip_height": 200}
    rings = [[*ring, ring[0]] for ring in (box(0, 0, 50, 40), *stones())]
    laid = [item(i, "simple_polygon", ring) for i, ring in enumerate(rings)]
    found = read(tmp_path, content | {"items": laid[1:]})
    assert [stone.id for stone in found] == list(range(1, 13))
    assert "taken as px" in found.notices[0].message
    hole = {"outer": box(0, 0, 60, 60), "inner": [box(20, 20, 40, 40)]}
    others = [
        item(0, "simple_polygon", rings[0], 3),
        item(1, "polygon", hole),
        item(2, "rectangle", {"x_min": 0, "y_min": 0, "width": 9, "height": 30}),
    ]
    found = read(tmp_path, content | {"items": others}, holes="keep")
    assert [stone.area_px for stone in found] == [2000, 2000, 2000, 3200, 270]
    assert any("in a row" in notice.message for notice in found.notices)
    assert not any("overlap" in notice.message for notice in found.notices)
    found = read(tmp_path, content | {"items": others}, unit="cm", px_per_m=100.0)
    assert found.source.px_per_m == 100.0
    assert "taken as px" not in str(found.notices)


def test_json_of_another_kind_or_in_no_length(tmp_path):
    for content, text in (
        ("{", r"cannot be read, it may be cut short"),
        ({"type": ["object", "null"]}, r"its keys are 'type'"),
        ({"a": 1, "b": 2}, r"its keys are 'a', 'b'.*labelme.*COCO.*SAM.*GeoJSON"),
        ([{"bbox": [1, 2]}], r"none of the known forms"),
        ({"schema": "drystone-photo/1", "px_per_m": 3}, r"beside the label image.*Give stones.png"),
        ({"steps": [], "source": {}, "wall": {}}, r"is a plan.*Give the stones"),
        ({"blocks": []}, r"block model of a wall"),
    ):
        with pytest.raises(InputError, match=rf"E113 stones.json: .*{text}"):
            read(tmp_path, content)
    crs = {"properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    for changes, text in (({"crs": crs}, "degrees"), ({"unit": "parsec"}, "'parsec' is not known"),
                          ({"unit": None}, "None is not known")):  # fmt: skip
        with pytest.raises(InputError, match=rf"E116 .*{text}"):
            read(tmp_path, geojson(**changes))


def shape(**changes):
    return labelme(shapes=[{"label": "1", "points": box(1, 1, 30, 30)} | changes])


def mask(picture, points=((1, 1), (30, 1))):
    return shape(shape_type="mask", points=points, mask=picture)


DOT = base64.b64encode(pillow(np.full((1, 1), 255, np.uint8), "PNG")).decode()
"""A mask of one pixel."""

NO_RING = {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": []}}
RECT = {"name": "rect", "x": 1}
CVAT = "<annotations><image>{}</image></annotations>"
RUNS = '<mask left="0" top="0" width="3" height="3" rle="1,2"/>'


def test_damaged_entries_are_named(tmp_path):
    for content, text in (
        (shape(points=[*box(1, 1, 30, 30), ["a", 2]]), r"shape 0.*could not convert"),
        (shape(points=[*box(1, 1, 30, 30), [float("nan"), 2]]), r"shape 0.*not finite"),
        (shape(shape_type="circle", points=[[1, 2]]), r"shape 0"),
        (mask("####"), r"shape 0"),
        (mask("aGVsbG8="), r"shape 0.*not a picture"),
        (mask(DOT, [[1e30, 0], [1e30, 9]]), r"shape 0.*beyond 1e9"),
        (labelme(shapes=[{"label": "1"}]), r"shape 0.*has no 'points'"),
        (coco({5: [[1, 1, 5]]}), r"annotation 5.*odd number"),
        (coco({5: {"size": [3, 3], "counts": [0, 9]}}), r"the image.*sizes differ: 3 x 3, 320 x"),
        (coco({}, annotations=[3]), r"annotations are not objects"),
        (coco({}, categories=["stone"]), r"list of categories"),
        (coco({}, annotations=[{"image_id": [7]}]), r"list of images"),
        (labelme(imageWidth=0), r"size of the image.*is 0 px"),
        ([{"segmentation": [[True, False], [True]]}], r"mask 1"),
        ([{"segmentation": runs(masks()[3])}, {"segmentation": {"size": [3, 3], "counts": [9]}}],
         r"the image.*sizes differ"),
        (geojson(features=[NO_RING]), r"feature 0.*no ring"),
        (geojson(features=None), r"list of features|feature"),
        ({"items": [item(0, "spline", [])]}, "item 0.*'spline'"),
        ({"a": {"regions": [{"shape_attributes": RECT}]}}, "region 0.*'y'"),
        ([task(result(PER_CENT | {"width": "a", "height": 1}))], "result 0"),
        ([task({"value": {"points": [[1, 2]]}})], "result 0.*original_width"),
        ("0 .1 .1 .2 .2 .3\n0 .1 .1 .2 .1 .2 .2 .4\n", "line 2.*odd number.*save_conf"),
        (CVAT.format("<box/>"), "shape 0.*'xtl'"),
        (CVAT.format(RUNS), "shape 0.*do not fill"),
    ):  # fmt: skip
        name = "a.json"
        if isinstance(content, str):
            name = "a.xml" if content.startswith("<") else "a.txt"
        with pytest.raises(InputError, match=rf"E114 {name}: .*{text}"):
            read(tmp_path, content, name)


def test_sam_of_several_images_and_files_that_name_none(tmp_path):
    content = [{"image_id": i, "segmentation": [[1, 1, 30, 1, 30, 30]]} for i in (1, 2)]
    with pytest.raises(InputError, match=r"E115 .*2 images.*there are 1, 2"):
        read(tmp_path, content)
    assert len(read(tmp_path, content, image="2")) == 1
    with pytest.raises(InputError, match=r"E115 .*no image or several are called '2'.*there are 1"):
        read(tmp_path, content[:1], image="2")
    for none in (labelme(), [{"segmentation": [[1, 1, 30, 1, 30, 30]]}], geojson()):
        with pytest.raises(UsageError, match=r"E118 stones.json: .*'tray'.*Leave --image"):
            read(tmp_path, none, image="tray")


def test_no_stones_or_none_inside_the_image_and_a_name_that_is_not_unicode(tmp_path):
    for content in (labelme(shapes=[]), coco({}), [], geojson(features=[])):
        with pytest.raises(InputError, match=r"E104 stones.json: there are no stones"):
            read(tmp_path, content)
    with pytest.raises(InputError, match=r"E104.*without a pixel, left out: stone 1 \(1\)"):
        read(tmp_path, shape(points=[[400, 400], [430, 400], [430, 430]]))
    (stone,) = read(tmp_path, shape(label="Stein \ud83e"))
    assert stone.name.encode() == b"Stein ?"


def test_extras_that_are_not_installed(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    said = r"E305 .*ezdxf is not installed.*pip install \"drystone\[cad\]\""
    with pytest.raises(UsageError, match=said):
        read(tmp_path, "0\nSECTION\n", "a.dxf")
