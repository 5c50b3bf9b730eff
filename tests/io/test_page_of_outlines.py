"""What the page of outlines saves: scale, ground, and marks beside the outlines of labelme."""

import json
import math

import numpy as np
import pytest
import shapely
from PIL import Image
from shapely import affinity

from drystone.errors import InputError
from drystone.io.photo_beside import photo_of
from drystone.io.read_stones import read_stones
from drystone.io.walls import read_wall
from tests.io.test_photo_sidecar import FRAME, MARKER

WIDTH, HEIGHT = 300, 200
WALL = {
    4: shapely.box(20, 100, 120.5, 160.25),
    7: shapely.box(121, 100, 220, 160.25),
    9: shapely.Polygon([(60, 40), (180, 40.5), (170, 99), (70, 99.5)]),
}


def saved(tmp_path, shapes=WALL, **own):
    shapes = [
        {"label": str(i), "points": list(shape.exterior.coords)[:-1], "shape_type": "polygon"}
        for i, shape in shapes.items()
    ]
    size = {"imagePath": "photo.jpg", "imageWidth": WIDTH, "imageHeight": HEIGHT}
    path = tmp_path / "outlines.json"
    path.write_text(json.dumps({"shapes": shapes, **size, "drystone": own}))
    return path


def test_scale_frame_and_numbers_survive_and_marked_stones_are_left_out_and_said(tmp_path):
    path = saved(tmp_path, px_per_m=250, not_used=[7], proposed=[9])
    stones = read_stones(path)
    assert [stone.id for stone in stones] == [4]
    assert (stones.source.px_per_m, stones.source.width_px) == (250.0, WIDTH)
    said = " ".join(map(str, stones.notices))
    assert "nobody accepted, left out: 9." in said
    assert "not to be used, left out: 7." in said
    assert photo_of(path) is None
    Image.new("RGB", (WIDTH, HEIGHT)).save(tmp_path / "photo.jpg")
    assert photo_of(path) == tmp_path / "photo.jpg"


def test_outlines_stay_what_was_drawn(tmp_path):
    """Each stone is the polygon of its file, where it was; pixels are what it covers."""
    loop = shapely.Polygon([(230, 30), (280, 31), (281, 90), (229.5, 88), (231.5, 33), (229, 29)])
    beyond = shapely.Polygon([(5, 5), (50, 4.5), (60, 60), (-20.25, 55)])
    stones = read_stones(saved(tmp_path, {**WALL, 12: loop, 13: beyond}, px_per_m=250))
    for i, drawn in {**WALL, 12: loop, 13: beyond}.items():
        stone = stones.by_id(i)
        outline = (stone.outline + np.array(stone.centroid)) * (1, -1) + (0, HEIGHT)
        seen = shapely.make_valid(drawn) & shapely.box(0, 0, WIDTH, HEIGHT)
        share = shapely.Polygon(outline) & seen
        assert share.area > (0.998 if i == 12 else 1 - 1e-9) * seen.area
        assert shapely.Polygon(outline).area == pytest.approx(share.area, rel=1e-9)
        assert math.dist(stone.centroid, (seen.centroid.x, HEIGHT - seen.centroid.y)) < 0.05
        assert stone.area_px == pytest.approx(seen.area, rel=0.01)


def test_lines_along_the_edges_of_pixels_are_pixels(tmp_path):
    """The steps of a slope are those of a grid, and not of a stone."""
    edges = [(x + dx, 20 + (x - 20) // 2) for x in range(20, 80) for dx in (0, 1)]
    centres = [(x, 30 + max(0, x - 80) // 2) for x in range(110, 180)]
    for i, steps in enumerate((edges, centres), 1):
        (x0, _), (x1, _) = steps[0], steps[-1]
        stair = shapely.Polygon([*steps, (x1, 120), (x0, 120)])
        stone = read_stones(saved(tmp_path, {i: stair})).by_id(i)
        assert stone.drawn is None
        assert len(stone.outline) < len(steps)


def test_the_frame_of_the_photograph_survives(tmp_path):
    details = {"source": {"name": "pile.jpg"}, "markers": [MARKER], "P_from_marker": FRAME}
    photograph = dict(read_stones(saved(tmp_path, **details)).source.photograph)
    assert photograph == {"name": "pile.jpg", "markers": [MARKER], "P_from_marker": FRAME}


@pytest.mark.parametrize(
    "own",
    [
        {"px_per_m": -2}, {"px_per_m": math.nan}, {"px_per_m": "a"}, {"ground": [[1, 2]]},
        {"ground": [[5, 1], [5, 9]]}, {"markers": [7], "P_from_marker": FRAME},
        {"ground": [[0, 1], [1e300, 9]]}, {"not_used": [[3]]},
    ],
)  # fmt: skip
def test_what_nobody_can_use_is_refused(tmp_path, own):
    with pytest.raises(InputError, match=r"E114 .*the table drystone cannot be used"):
        read_stones(saved(tmp_path, **own))


def test_a_wall_is_turned_until_its_ground_is_level_and_cut_off_there(tmp_path):
    level = read_wall(saved(tmp_path, px_per_m=250))
    ends = shapely.LineString([(0, 155.25), (300, 155.25)])
    for angle, flip in ((0, 1), (3.5, 1), (-2, -1)):
        turned = [affinity.rotate(one, angle, (0, 0)) for one in (*WALL.values(), ends)]
        ground = list(turned.pop().coords)[::flip]
        buried = {99: affinity.rotate(shapely.box(30, 170, 60, 190), angle, (0, 0))}
        shapes = dict(zip(WALL, turned, strict=True)) | buried
        wall = read_wall(saved(tmp_path, shapes, px_per_m=250, ground=ground))
        assert wall.px_per_m == 250.0
        assert wall.outlines.keys() == WALL.keys()
        assert f"turned by {angle:.2f} degrees and cut off at it, and 99 left out" in " ".join(
            map(str, wall.notices)
        )
        for i, outline in wall.outlines.items():
            # Five px are buried; nothing was ever a pixel on the way.
            lower = shapely.Polygon(level.outlines[i] - (0.0, 5.0))
            expected = lower & shapely.box(-9, 0, WIDTH, HEIGHT)
            moved = affinity.translate(shapely.Polygon(outline), -_left(wall) + _left(level))
            assert moved.symmetric_difference(expected).area < 1e-6 * expected.area
    with pytest.raises(InputError, match=r"E104 .*Draw the ground under the wall"):
        read_wall(saved(tmp_path, ground=[[0, 2], [300, 2]]))


def _left(wall):
    return min(np.min(outline[:, 0]) for outline in wall.outlines.values())
