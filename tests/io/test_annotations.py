"""labelme, COCO, SAM and GeoJSON: pixels, run lengths and numbers of the known stones."""

import base64
from dataclasses import replace

import numpy as np
import pytest
from fuzz.forms import coco_of, runs_of
from fuzz.pictures import pillow
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from pycocotools import mask as coco_mask

from drystone.errors import InputError, UsageError
from drystone.io.outlines_in.annotations import mask_of, unpacked
from drystone.io.outlines_in.model import Room
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io import labelled
from tests.io.known_stones import HEIGHT, PIECES, STONES, WIDTH, close, compare, masks
from tests.io.labelled import box
from tests.io.pictures import codes, said, written

LARGEST = ReadSettings(pieces="keep-largest")


def read(tmp_path, content, settings=PIECES, name="stones.json"):
    return read_stones(written(tmp_path, content, name), settings=settings)


def labelme(**changes):
    shapes = [
        {"label": str(stone), "points": polygon[0],
         "group_id": stone if len(polygons) > 1 else None}
        for stone, polygons in STONES.items()
        for polygon in polygons
    ]  # fmt: skip
    return {"shapes": shapes, "imageHeight": HEIGHT, "imageWidth": WIDTH} | changes


def runs(mask, *, packed=True):
    """Run lengths by pycocotools, or by a plain count of changes."""
    if not packed:
        return runs_of(mask)
    found = coco_mask.encode(np.asfortranarray(mask.astype(np.uint8)))
    return {"size": found["size"], "counts": found["counts"].decode()}


def coco(segmentations, **changes):
    return coco_of(segmentations, (WIDTH, HEIGHT)) | changes


def flat_polygons():
    """COCO's own form, which has no holes."""
    return {i: [np.ravel(p[0]).tolist() for p in polygons] for i, polygons in STONES.items()}


@pytest.mark.parametrize("form", ["labelme", "coco"])
def test_labels_are_kept_as_ids_and_groups_joined(tmp_path, form):
    content = labelme() if form == "labelme" else coco(flat_polygons())
    stones = read(tmp_path, content, LARGEST)
    assert compare(stones, LARGEST) == 1.0
    assert (stones.source.width_px, stones.source.height_px) == (WIDTH, HEIGHT)
    assert form == "coco" or stones.by_id(300).name == "300"
    assert stones.source.px_per_m is None
    assert "W119" not in codes(stones)  # stones that touch share no pixel


def test_labelme_rectangles_circles_and_masks(tmp_path):
    grain = np.random.default_rng(3).random((20, 30)) < 0.9
    corners = [[10, 130], [40, 110], [60, 140], [30, 160]]
    shapes = [
        {"label": "a", "shape_type": "rectangle", "points": [[60, 50], [10, 20]]},
        {"label": "b", "shape_type": "circle", "points": [[120, 60], [120, 90]]},
        {"label": "c", "shape_type": "mask", "points": [[200, 40], [229, 59]],
         "mask": base64.b64encode(pillow(grain, "PNG")).decode()},
        # As X-AnyLabeling writes them.
        {"label": "e", "shape_type": "rectangle", "direction": 5.7, "points": corners},
        {"label": "f", "shape_type": "rotation", "direction": 5.7,
         "points": [[x + 100, y] for x, y in corners]},
        {"label": "d", "shape_type": "line", "points": [[0, 0], [9, 9]]},
        {"label": "d", "shape_type": "point", "points": [[0, 0]]},
    ]  # fmt: skip
    stones = read(tmp_path, labelme(shapes=shapes))
    assert [(stone.id, stone.name) for stone in stones] == [*enumerate("abcef", start=1)]
    assert stones.by_id(1).area_px == 50 * 30
    assert stones.by_id(2).area_px == pytest.approx(np.pi * 30**2, rel=0.003)
    assert stones.by_id(2).centroid == pytest.approx((120, HEIGHT - 60))
    assert stones.by_id(3).area_px == pytest.approx(int(grain.sum()), abs=2)  # less lone pixels
    for i, x in ((4, 35), (5, 135)):
        assert stones.by_id(i).area_px == pytest.approx(30**2 + 20**2, rel=0.01)
        assert stones.by_id(i).centroid == pytest.approx((x, HEIGHT - 135), abs=0.1)
    assert (stones.by_id(3).left_px, stones.by_id(3).bottom_px) == (200, HEIGHT - 60)
    assert "1 lines, 1 points" in stones.notices[0].message


def test_coco_of_several_images_needs_a_name(tmp_path):
    content = coco({stone: runs(mask) for stone, mask in masks().items()})
    content["images"].append({"id": 9, "file_name": "other.jpg", "width": 50, "height": 60})
    content["annotations"].append(
        {"id": 1, "image_id": 9, "segmentation": [[5, 5, 45, 5, 45, 55, 5, 55]]}
    )
    for name, text in (("", r"2 images.*--image.*a/photo.jpg, other.jpg"), ("third", "'third'")):
        with pytest.raises(InputError, match=rf"E115.*{text}"):
            read(tmp_path, content, ReadSettings(image=name))
    for name in ("photo.jpg", "a/photo.jpg", "7"):
        assert compare(read(tmp_path, content, replace(PIECES, image=name))) == 1.0
    other = read(tmp_path, content, ReadSettings(image="other.jpg"))
    assert [(stone.id, stone.area_px) for stone in other] == [(1, 2000)]
    assert dict(other.source.reading) == {"image": "other.jpg"}


def test_coco_says_what_has_no_outline(tmp_path):
    content = coco(flat_polygons())
    content["annotations"] += [
        {"id": 900, "image_id": 7, "iscrowd": 1, "segmentation": runs(masks()[3])},
        {"id": 901, "image_id": 7, "bbox": [1, 1, 5, 5], "segmentation": []},
    ]
    stones = read(tmp_path, content)
    assert {900, 901}.isdisjoint(stone.id for stone in stones)
    assert "1 annotations without an outline, 1 crowd regions" in said(stones)
    found = read(tmp_path, [{"segmentation": runs(masks()[3])}, {"segmentation": []}])
    assert [stone.id for stone in found] == [1]
    assert "1 annotations without an outline" in said(found)


@pytest.mark.parametrize("mixed", [False, True])
def test_coco_masks_of_cvat_are_stones_though_marked_as_crowds(tmp_path, mixed):
    found = {stone: runs(mask, packed=False) for stone, mask in masks().items()}
    content = coco(found)
    for annotation in content["annotations"]:
        annotation["iscrowd"] = 1
    if mixed:  # with a polygon, it is the attributes that tell
        content["annotations"][0] |= {"iscrowd": 0, "segmentation": flat_polygons()[3]}
        for annotation in content["annotations"]:
            annotation["attributes"] = {"occluded": False}
    stones = read(tmp_path, content)
    assert {stone.id for stone in stones} == set(STONES)
    assert stones.by_id(5).area_px == masks()[5].sum()
    assert "marked as crowds" in stones.notices[0].message


@pytest.mark.parametrize("form", ["packed", "counts", "rows", "released"])
def test_sam_masks_that_do_not_nest(tmp_path, form):
    ids = {stone: number for number, stone in enumerate(STONES, start=1)}
    content = [
        {"segmentation": mask.tolist() if form == "rows" else runs(mask, packed=form != "counts"),
         "predicted_iou": 0.97, "id": stone}
        for stone, mask in masks().items()
    ]  # fmt: skip
    if form == "released":
        ids = None
        content = {"image": {"width": WIDTH, "height": HEIGHT}, "annotations": content}
    assert compare(read(tmp_path, content), ids=ids) == 1.0


def test_outlines_that_overlap_or_reach_over_the_image(tmp_path):
    corners = {1: box(10, 10, 60, 60), 2: box(50, 10, 90, 60), 3: box(-5, 70, 20, 120)}
    shapes = [{"label": str(i), "points": points} for i, points in corners.items()]
    stones = read(tmp_path, labelme(shapes=shapes))
    assert [stone.area_px for stone in stones] == [2500, 2000, 20 * 50]
    assert stones.by_id(3).left_px == 0
    assert "1 and 2 (500 px)" in said(stones)
    assert "cut off: stone 3 (3): 250 px" in said(stones)


def geojson(at=np.array, **changes):
    """The known stones; `at` says where their corners are."""
    features = []
    for stone, polygons in STONES.items():
        placed = [[at([*ring, ring[0]]).tolist() for ring in rings] for rings in polygons]
        several = len(placed) > 1
        kind = "MultiPolygon" if several else "Polygon"
        geometry = {"type": kind, "coordinates": placed if several else placed[0]}
        said = {"properties": {"name": f"block {stone}"}, "geometry": geometry}
        features.append({"type": "Feature", "id": stone} | said)
    return {"type": "FeatureCollection", "features": features} | changes


def test_geojson_in_px_of_an_image_or_of_a_map(tmp_path):
    for name in ("stones.geojson", "stones.json"):
        stones = read(tmp_path, geojson(), name=name)
        assert compare(stones) == 1.0
        assert stones.by_id(8).name == "block 8"
        assert stones.by_id(8).area_px == masks()[8].sum()
        assert stones.source.px_per_m is None
        assert stones.source.height_px == 168  # the lowest stone ends at y = 168
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}
    with pytest.raises(InputError, match=r"E116.*a map.*--unit m"):
        read(tmp_path, geojson(crs=crs))
    degrees = geojson(lambda ring: np.array(ring) * 1e-5 + (8.5, 47.1), crs="EPSG:4258")
    for unit in ("", "m"):
        with pytest.raises(InputError, match=r"E116.*degrees of lat.*Project it to metres"):
            read(tmp_path, degrees, replace(PIECES, unit=unit))
    grains = geojson(lambda ring: np.array(ring) * 1e-5, crs="EPSG:44326", unit="m")
    assert read(tmp_path, grains, replace(PIECES, px_per_m=1e5)).source.px_per_m == 1e5
    assert read(tmp_path, geojson(crs=crs), replace(PIECES, unit="m")).source.px_per_m
    assert compare(read(tmp_path, geojson(crs=crs), replace(PIECES, unit="px"))) == 1.0


def test_geojson_in_metres_has_y_up_and_a_scale_and_some_kinds_are_no_stones(tmp_path):
    content = geojson(lambda ring: (np.array(ring) * (1, -1) + (0, HEIGHT)) / 400, unit="m")
    for geometry in ({"type": "Point", "coordinates": [1, 2]}, None):
        content["features"].append({"type": "Feature", "properties": None, "geometry": geometry})
    stones = read(tmp_path, content, replace(PIECES, px_per_m=400.0))
    assert stones.source.px_per_m == 400.0
    assert dict(stones.source.reading)["px_per_m"] == 400.0
    close(stones)
    # What is read as px, or with too few of them in a metre, has stones of a few px at most.
    metres = geojson(lambda ring: np.array(ring) / 100)
    for small, more, cure in (
        (metres, {}, "Say --unit m if"),
        (metres, {"unit": "m", "px_per_m": 1.0}, "Give a larger --px-per-m"),
        (metres, {"unit": "m", "px_per_m": 0.001}, "Give a larger --px-per-m"),
        (content, {"skip": tuple(STONES)}, "all were skipped. Check the picture"),
        (geojson(), {"min_area_px": 10**9}, r"(?<!Python\). )Check the picture"),
    ):
        with pytest.raises(InputError, match=f"E104 .*{cure}"):
            read(tmp_path, small, replace(PIECES, **more))
    assert "1 Points, 1 features without a geometry" in stones.notices[0].message
    bare = geojson()["features"][0]["geometry"]
    assert read(tmp_path, bare).by_id(1).area_px == masks()[3].sum()


@given(arrays(bool, st.tuples(st.integers(1, 40), st.integers(1, 40))), st.booleans())
def test_any_mask_comes_back(mask, packed):
    found = mask_of(runs(mask, packed=packed), Room(10**8))
    whole = np.zeros_like(mask)
    if found is not None:
        height, width = found.mask.shape
        whole[found.row : found.row + height, found.col : found.col + width] = found.mask
        assert found.mask.any(axis=0)[[0, -1]].all()  # cut to its box
        assert found.mask.any(axis=1)[[0, -1]].all()
    np.testing.assert_array_equal(whole, mask)


def test_long_runs_come_back_and_damaged_counts_and_sizes_are_refused():
    packed = runs(np.ones((3000, 2000), bool))
    assert unpacked(packed["counts"]).tolist() == [0, 6_000_000]
    assert mask_of(packed, Room(10**8)).mask.sum() == 6_000_000
    for changes, text in (
        ({"counts": [1, 2]}, "add up to 3"),
        ({"counts": [-1, 7]}, "below 0"),
        ({"counts": [1.5, 4.5]}, "whole numbers"),
        ({"counts": "\x01"}, "does not belong"),
        ({"counts": "PPPPPPPPP0"}, "does not belong"),  # more bits than a count can have
        ({"counts": "P"}, "cut short"),
        ({"counts": [[6]]}, "whole numbers"),
        ({"counts": [6], "size": [3, -2]}, "a picture of -2 x 3 px"),
    ):
        with pytest.raises(ValueError, match=text):
            mask_of({"size": [2, 3], **changes}, Room(10**8))


SQUARES = [box(x, 10, x + 20, 30) for x in (10, 40, 70)]
AGAIN = "all are numbered in order"


def test_numbers_are_kept_or_it_is_said_that_they_are_not(tmp_path):
    for form, numbers, ids, text in (
        ("coco", [0, 1, 2], [1, 2, 3], f"0 cannot be the number of a stone: {AGAIN} "
         "(0 is now 1, 1 is now 2, 2 is now 3)."),
        ("coco", [5, 2**32, None], [1, 2, 3], "4294967296 cannot be the number of a stone, 1 of 3 "
         f"stones without a number: {AGAIN} (5 is now 1, 4294967296 is now 2)."),
        ("labelme", ["5", "5", "Stone A"], [1, 2, 3], "the numbers of the file are not different "
         f"(5), 1 of 3 stones without a number: {AGAIN}."),
        ("coco", [1, 2, 3], [1, 2, 3], None),
        ("coco", [7, 2**32 - 1, 3], [3, 7, 2**32 - 1], None),
        ("coco", [None, None, None], [1, 2, 3], None),
        ("labelme", ["a", "b", "c"], [1, 2, 3], None),
        ("labelme", ["0", "0", "0"], [1, 2, 3], None),  # labels of a class
        ("labelme", ["stone 9", "8", "07"], [7, 8, 9], None),
        ("labelme", [9.0, 8, "07"], [7, 8, 9], None),
        ("coco", [9.0, 8.0, 7.0], [7, 8, 9], None),
    ):  # fmt: skip
        pairs = list(zip(numbers, SQUARES, strict=True))
        if form == "coco":
            found = [
                {"id": i, "image_id": 7, "segmentation": [np.ravel(s).tolist()]} for i, s in pairs
            ]
            content = coco({}, annotations=found)
        else:
            content = labelme(shapes=[{"label": i, "points": s} for i, s in pairs])
        stones = read(tmp_path, content, ReadSettings())
        assert [stone.id for stone in stones] == ids
        told = [notice.message for notice in stones.notices if notice.code == "W119"]
        assert told == ([] if text is None else [text])


@pytest.mark.parametrize("form", ["coco", "svg", "npz"])
def test_outlines_say_themselves_what_is_stone(tmp_path, form):
    if form == "npz":
        np.savez(path := tmp_path / "masks.npz", a=np.eye(20) > 0, b=np.tri(20) > 0)
    else:
        path = labelled.written(tmp_path, form, [("stone", ring) for ring in labelled.stones()])
    for option, value in (("background", 255), ("mask", True), ("no-mask", False)):
        key = option.removeprefix("no-")
        cure = rf"Leave --{option} \({key} in Python\) out"
        with pytest.raises(UsageError, match=rf"E118 {path.name}: this file says itself.*{cure}"):
            read_stones(path, settings=replace(LARGEST, **{key: value}))
    # What is left of the options is for both.
    also = replace(LARGEST, holes="keep", min_area_px=1, skip=(99,))
    assert len(read_stones(path, settings=also)) >= 1
