"""Numbers of a file that are not kept are said, and so are options that a file has no use for."""

import json
from dataclasses import replace

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.test_annotations import coco, geojson, labelme, written

SQUARES = [[[x, 10], [x + 20, 10], [x + 20, 30], [x, 30]] for x in (10, 40, 70)]


def of_coco(ids):
    flat = [[v for point in square for v in point] for square in SQUARES]
    content = coco({})
    content["annotations"] = [
        {"id": i, "image_id": 7, "category_id": 1, "iscrowd": 0, "segmentation": [s]}
        for i, s in zip(ids, flat, strict=False)
    ]
    return content


def of_labelme(labels):
    shapes = [{"label": i, "points": s} for i, s in zip(labels, SQUARES, strict=False)]
    return labelme(shapes=shapes)


def read(tmp_path, content):
    stones = read_stones(written(tmp_path, content))
    return [stone.id for stone in stones], [n.message for n in stones.notices if n.code == "W119"]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (of_coco([0, 1, 2]), "0 cannot be the number of a stone: all are numbered in order "
         "(0 is now 1, 1 is now 2, 2 is now 3)."),
        (of_coco([0]), "0 cannot be the number of a stone: all are numbered in order (0 is now "
         "1)."),
        (of_coco([5, 2**32, None]), "4294967296 cannot be the number of a stone, 1 of 3 stones "
         "without a number: all are numbered in order (5 is now 1, 4294967296 is now 2)."),
        (of_coco([-3, 10**15, 10**15 + 1]), "-3, 1000000000000000, 1000000000000001 cannot be the "
         "number of a stone: all are numbered in order (-3 is now 1, 1000000000000000 is now 2, "
         "1000000000000001 is now 3)."),
        (of_labelme(["5", "7", "Stone A"]), "1 of 3 stones without a number: all are numbered in "
         "order (5 is now 1, 7 is now 2)."),
        (of_labelme(["1", "stone 2", "Stone A"]), "1 of 3 stones without a number: all are "
         "numbered in order."),
        (of_labelme(["5", "5", "Stone A"]), "the numbers of the file are not different (5), "
         "1 of 3 stones without a number: all are numbered in order."),
    ],
)  # fmt: skip
def test_numbers_that_are_not_kept_are_said(tmp_path, content, said):
    ids, messages = read(tmp_path, content)
    assert ids == list(range(1, len(ids) + 1))
    assert messages == [said]


@pytest.mark.parametrize(
    ("content", "ids"),
    [
        (of_coco([1, 2, 3]), [1, 2, 3]),
        (of_coco([7, 2**32 - 1, 3]), [3, 7, 2**32 - 1]),
        (of_coco([None, None, None]), [1, 2, 3]),
        (of_labelme(["a", "b", "c"]), [1, 2, 3]),
        (of_labelme(["0", "0", "0"]), [1, 2, 3]),  # labels of a class
        (of_labelme(["stone 9", "8", "07"]), [7, 8, 9]),
    ],
)
def test_numbers_that_are_kept_or_were_never_there_are_not_spoken_of(tmp_path, content, ids):
    assert read(tmp_path, content) == (ids, [])


SVG = '<svg xmlns="http://www.w3.org/2000/svg"><rect id="1" width="30" height="30"/></svg>'
FILES = {
    "labelme.json": json.dumps(of_labelme(["1", "2"])),
    "coco.json": json.dumps(of_coco([1, 2])),
    "sam.json": json.dumps([{"segmentation": [[1, 1, 30, 1, 30, 30]]}]),
    "stones.geojson": json.dumps(geojson()),
    "stones.svg": SVG,
}


@pytest.mark.parametrize("name", [*FILES, "masks.npz"])
def test_outlines_say_themselves_what_is_stone(tmp_path, name):
    path = tmp_path / name
    if name in FILES:
        path.write_text(FILES[name])
    else:
        np.savez(path, a=np.eye(20) > 0, b=np.tri(20) > 0)
    plain = ReadSettings(pieces="keep-largest")
    for option, given in (("background", 255), ("mask", True), ("no-mask", False)):
        key = option.removeprefix("no-")
        cure = rf"Leave --{option} \({key} in Python\) out"
        with pytest.raises(UsageError, match=rf"E118 {name}: this file says itself.*{cure}"):
            read_stones(path, settings=replace(plain, **{key: given}))
    # What is left of the options is for both.
    also = replace(plain, holes="keep", min_area_px=1, skip=(99,))
    assert len(read_stones(path, settings=also)) >= 1
