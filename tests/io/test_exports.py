"""Further forms of labelling tools, and instances of nesting programs."""

import numpy as np
import pytest
from PIL import Image

from drystone.errors import InputError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.labelled import HEIGHT, SIZE, WIDTH, box, stones, written
from tests.io.test_outline_errors import read

PER_CENT = {"x": 25.0, "y": 25.0}  # 90, 65


def task(*results, image="/data/a%20b.jpg", **more):
    made = {"data": {"image": image}, "annotations": [{"result": list(results)}]}
    return made | more


def result(value, kind="rectanglelabels", **more):
    return {"type": kind, "value": value | {kind: ["stone"]}} | SIZE | more


@pytest.mark.parametrize(
    ("value", "area", "centre"),
    [
        (PER_CENT | {"width": 20.0, "height": 10.0, "rotation": 0}, 72 * 26, (126, 78)),
        (PER_CENT | {"width": 20.0, "height": 10.0, "rotation": 90}, 72 * 26, (77, 101)),
        (PER_CENT | {"radiusX": 10.0, "radiusY": 5.0, "rotation": 30}, np.pi * 36 * 13, (90, 65)),
    ],
)
def test_boxes_and_ellipses_of_label_studio(tmp_path, value, area, centre):
    kind = "ellipselabels" if "radiusX" in value else "rectanglelabels"
    (stone,) = read(tmp_path, [task(result(value, kind))])
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
    drawn = [{"shape_attributes": s, "region_attributes": {}} for s in shapes]
    regions = {str(i): region for i, region in enumerate(drawn)}
    images = {
        "a9": {"filename": "a.jpg", "regions": regions},
        "b9": {"filename": "b", "regions": []},
    }
    found = read(tmp_path, images)
    truth = [1200, np.pi * 400, np.pi * 300]
    assert [stone.area_px for stone in found] == pytest.approx(truth, rel=0.02)
    assert "1 points" in found.notices[0].message


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
    photo = tmp_path / "photo.jpg"
    size = (HEIGHT, WIDTH) if turned else (WIDTH, HEIGHT)
    exif = Image.Exif()
    exif[0x0112] = 6 if turned else 1
    Image.new("L", size).save(photo, exif=exif)
    found = read_stones(path, settings=ReadSettings(image=str(photo)))
    assert (found.source.width_px, found.source.height_px) == (WIDTH, HEIGHT)
    path.write_text("0 .5 .5 .1 .1\n" + path.read_text())
    notice = read_stones(path, settings=ReadSettings(image=str(photo))).notices[0]
    assert "1 boxes" in notice.message


def item(number, shape, demand=1):
    return {"id": number, "demand": demand, "allowed_orientations": [0], "shape": shape}


def polygon(ring):
    return {"type": "simple_polygon", "data": [*ring, ring[0]]}


def test_items_of_a_nesting_instance(tmp_path):
    content = {"name": "pile", "strip_height": 200}
    laid = [item(i, polygon(ring)) for i, ring in enumerate(stones(), start=1)]
    found = read(tmp_path, content | {"items": laid})
    assert [stone.id for stone in found] == list(range(1, 13))
    assert "taken as px" in found.notices[0].message
    hole = {"outer": box(0, 0, 60, 60), "inner": [box(20, 20, 40, 40)]}
    others = [
        item(0, polygon(box(0, 0, 50, 40)), 3),
        item(1, {"type": "polygon", "data": hole}),
        item(2, {"type": "rectangle", "data": {"x_min": 0, "y_min": 0, "width": 9, "height": 30}}),
    ]
    found = read(tmp_path, content | {"items": others}, holes="keep")
    assert [stone.area_px for stone in found] == [2000, 2000, 2000, 3200, 270]
    assert any("in a row" in notice.message for notice in found.notices)
    assert not any("overlap" in notice.message for notice in found.notices)
    found = read(tmp_path, content | {"items": others}, unit="cm", px_per_m=100.0)
    assert found.source.px_per_m == 100.0
    assert "taken as px" not in str(found.notices)


MASK = '<mask left="0" top="0" width="3" height="3" rle="1,2"/>'
SIDELESS = {"name": "rect", "x": 1}


@pytest.mark.parametrize(
    ("name", "content", "text"),
    [
        ("a.json", {"items": [item(0, {"type": "spline", "data": []})]}, "item 0.*'spline'"),
        ("a.json", {"a": {"regions": [{"shape_attributes": SIDELESS}]}}, "region 0.*'y'"),
        ("a.json", [task(result(PER_CENT | {"width": "a", "height": 1}))], "result 0"),
        ("a.json", [task({"value": {"points": [[1, 2]]}})], "result 0.*original_width"),
        ("a.txt", "0 .1 .1 .2 .2 .3\n0 .1 .1 .2 .1 .2 .2 .4\n", "line 2.*odd number"),
        ("a.xml", "<annotations><image><box/></image></annotations>", "shape 0.*'xtl'"),
        ("a.xml", f"<annotations><image>{MASK}</image></annotations>", "shape 0.*do not fill"),
    ],
)
def test_damaged_entries_are_named(tmp_path, name, content, text):
    with pytest.raises(InputError, match=rf"E114 {name}: .*{text}"):
        read(tmp_path, content, name)
