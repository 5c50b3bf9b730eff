"""What stands beside a label image or outlines of a photograph, and the photograph itself."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import shapely
from fuzz.forms import labelme
from PIL import Image
from shapely import affinity

from drystone.errors import InputError, UsageError
from drystone.io.photo_beside import (
    PhotoSidecar,
    check_place,
    photo_beside,
    photo_of,
    place_photo,
    read_sidecar,
    write_sidecar,
)
from drystone.io.read_stones import ReadSettings, read_stones
from drystone.io.walls import read_wall
from tests.io.pictures import areas, said, two_stones, written


def test_it_comes_back_beside_its_label_image_only_and_damage_is_said(tmp_path):
    path = write_sidecar(PhotoSidecar(640, 480, 512.5, "photo.jpg", {"markers": [1]}), tmp_path)
    for encoding in ("utf-8", "utf-8-sig"):
        path.write_text(path.read_text("utf-8"), encoding=encoding)
        assert read_sidecar(tmp_path / "stones.png") == PhotoSidecar(640, 480, 512.5, "photo.jpg")
    assert read_sidecar(tmp_path / "other.png") is None
    assert read_sidecar(Path()) is None
    sides = '"width_px": 1, "height_px": 1'
    for text in ("[" * 100_000, '{"schema": "drystone-photo/1"}',
                 *(f'{{"schema": "drystone-photo/1", "px_per_m": {scale}, {sides}}}'
                   for scale in ("-1", '"x"'))):  # fmt: skip
        path.write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match="E112"):
            read_sidecar(tmp_path / "stones.png")
    path.write_text('{"schema": "drystone-plan/1"}', encoding="utf-8")
    assert read_sidecar(tmp_path / "stones.png") is None


MARKER = {"id": 0, "corners_m": [[0, 1], [1, 1], [1, 0], [0, 0]]}
FRAME = {"id": 0, "matrix": np.eye(4).tolist()}


def test_what_a_plan_keeps_of_the_photograph_comes_back_unless_it_is_damaged(tmp_path):
    markers = {"markers": [MARKER], "P_from_marker": FRAME}
    details = {"source": {"name": "pile.jpg"}, **markers}
    write_sidecar(PhotoSidecar(640, 480, details=details), tmp_path)
    photograph = read_sidecar(tmp_path / "stones.png").photograph
    assert dict(photograph) == {"name": "pile.jpg", **markers}
    for found, frame in (
        ([{**MARKER, "corners_m": [[0, 1]]}], FRAME), ([{**MARKER, "corners_m": "x"}], FRAME),
        ([{"corners_m": MARKER["corners_m"]}], FRAME), ("markers", FRAME), (7, FRAME),
        ([MARKER], [1]), ([MARKER], {**FRAME, "matrix": [[float("nan")] * 4] * 4}),
        ([{**MARKER, "id": "one"}], FRAME),
    ):  # fmt: skip
        details = {"markers": found, "P_from_marker": frame}
        write_sidecar(PhotoSidecar(640, 480, details=details), tmp_path)
        with pytest.raises(InputError, match="E112"):
            read_sidecar(tmp_path / "stones.png")


def segmented(folder, picture=b"a picture"):
    """What `drystone segment` leaves, as far as it matters here."""
    folder.mkdir()
    (folder / "photo.jpg").write_bytes(picture)
    (folder / "stones.png").write_bytes(b"labels")
    write_sidecar(PhotoSidecar(640, 480, photo="photo.jpg"), folder)
    return folder


def planned(stones, folder):
    """Place the photograph and write down what the plan must say of it."""
    folder.mkdir(exist_ok=True)
    beside, record = place_photo(None if stones is None else photo_of(stones), folder)
    written(folder, {"source": dict(record)}, "plan.json")
    return beside


def test_the_photograph_goes_beside_the_plan(tmp_path):
    found, plan = segmented(tmp_path / "found"), tmp_path / "plan"
    for stones in (found, found / "stones.png"):
        assert photo_of(stones) == found / "photo.jpg"
    assert planned(found, plan) == photo_beside(plan) == plan / "photo.jpg"
    other = segmented(tmp_path / "other", b"another")
    assert planned(other, plan) == plan / "photo.jpg"
    assert (plan / "photo.jpg").read_bytes() == b"another"
    assert planned(None, plan) is None  # the next plan has none
    assert photo_beside(plan) is None
    planned(found, plan)
    (plan / "photo.jpg").write_bytes(b"painted over")
    planned(None, plan)
    assert (plan / "photo.jpg").read_bytes() == b"painted over"


def test_a_photograph_that_no_plan_put_there_stays(tmp_path):
    mine = tmp_path / "photo.jpg"
    mine.write_bytes(b"mine")
    for text in ("{", "[]", '{"source": 1}', '{"source": {"photo": "x"}}'):  # a damaged plan
        (tmp_path / "plan.json").write_text(text, encoding="utf-8")
        place_photo(None, tmp_path)
    (tmp_path / "plan.json").unlink()
    for _ in range(2):  # the second time beside a plan
        assert planned(None, tmp_path) is None
        assert mine.read_bytes() == b"mine"
    found = segmented(tmp_path / "found")
    for placed in (check_place, place_photo):
        with pytest.raises(UsageError, match=r"E129 .*photo\.jpg: no plan put this.*-o"):
            placed(photo_of(found), tmp_path)
    assert mine.read_bytes() == b"mine"


def test_the_photograph_of_the_label_image_stays_beside_it(tmp_path):
    found = segmented(tmp_path / "found")
    for _ in range(2):
        assert planned(found, found) == found / "photo.jpg"
        assert (found / "photo.jpg").read_bytes() == b"a picture"
    # It is of that label image even when the plan beside it was given a copy of the same bytes.
    (found / "stones.json").unlink()
    moved = segmented(tmp_path / "moved")
    (found / "photo.jpg").unlink()
    planned(moved, found)
    write_sidecar(PhotoSidecar(640, 480, photo="photo.jpg"), found)
    planned(None, found)
    assert (found / "photo.jpg").read_bytes() == b"a picture"


def test_the_name_of_a_photograph_leads_nowhere_else(tmp_path):
    folder = tmp_path / "found"
    folder.mkdir()
    (tmp_path / "photo.jpg").write_bytes(b"not yours")
    for name in ("../photo.jpg", "x" * 300 + ".jpg", "\0.jpg", "", "/", "\ud800.jpg"):
        write_sidecar(PhotoSidecar(640, 480, photo="?"), folder)
        path = folder / "stones.json"
        path.write_text(path.read_text("utf-8").replace('"?"', json.dumps(name)), encoding="utf-8")
        assert photo_of(folder / "stones.png") is None


def test_scale_of_a_photograph_and_that_its_pile_is_in_doubt_are_said_again(tmp_path):
    Image.fromarray(two_stones(7, 300, np.uint16)).save(tmp_path / "stones.png")
    for name in ("photo.jpg", "preview.png"):
        Image.new("RGB", (60, 40)).save(tmp_path / name)
    write_sidecar(PhotoSidecar(60, 40, 250.0, "photo.jpg"), tmp_path)
    for path in (tmp_path, tmp_path / "stones.png"):
        stones = read_stones(path, settings=ReadSettings(px_per_m=99.0))
        assert areas(stones) == {7: 375, 300: 600}
        assert stones.source.px_per_m == 250.0
        assert (stones.source.path, stones.source.files) == ("stones.png", ())
        assert stones.source.reading == ()
    for doubtful in ([], ["little was found", "the light is uneven"]):
        write_sidecar(PhotoSidecar(60, 40, details={"doubtful": doubtful}), tmp_path)
        told = [str(one) for one in read_stones(tmp_path).notices if one.code == "W183"]
        assert len(told) == bool(doubtful)
    assert "little was found; the light is uneven" in told[0]
    assert "outlines.html" in told[0]
    write_sidecar(PhotoSidecar(600, 400, 250.0, "photo.jpg"), tmp_path)
    with pytest.raises(InputError, match=r"E117 .*60 x 40 px.*600 x 400.*drystone segment"):
        read_stones(tmp_path)


WIDE, HIGH = 300, 200
WALL = {
    4: shapely.box(20, 100, 120.5, 160.25),
    7: shapely.box(121, 100, 220, 160.25),
    9: shapely.Polygon([(60, 40), (180, 40.5), (170, 99), (70, 99.5)]),
}


def page(tmp_path, shapes=WALL, **own):
    content = labelme((str(i), list(one.exterior.coords)[:-1]) for i, one in shapes.items())
    content |= {"imagePath": "photo.jpg", "imageWidth": WIDE, "imageHeight": HIGH, "drystone": own}
    return written(tmp_path, content, "outlines.json")


def test_scale_frame_and_numbers_survive_and_marked_stones_are_left_out_and_said(tmp_path):
    path = page(tmp_path, px_per_m=250, not_used=[7], proposed=[9])
    stones = read_stones(path)
    assert [stone.id for stone in stones] == [4]
    assert (stones.source.px_per_m, stones.source.width_px) == (250.0, WIDE)
    assert "nobody accepted, left out: 9." in said(stones)
    assert "not to be used, left out: 7." in said(stones)
    assert photo_of(path) is None
    Image.new("RGB", (WIDE, HIGH)).save(tmp_path / "photo.jpg")
    assert photo_of(path) == tmp_path / "photo.jpg"


def test_outlines_stay_what_was_drawn(tmp_path):
    """Each stone is the polygon of its file, where it was; pixels are what it covers."""
    loop = shapely.Polygon([(230, 30), (280, 31), (281, 90), (229.5, 88), (231.5, 33), (229, 29)])
    beyond = shapely.Polygon([(5, 5), (50, 4.5), (60, 60), (-20.25, 55)])
    stones = read_stones(page(tmp_path, {**WALL, 12: loop, 13: beyond}, px_per_m=250))
    for i, drawn in {**WALL, 12: loop, 13: beyond}.items():
        stone = stones.by_id(i)
        outline = (stone.outline + np.array(stone.centroid)) * (1, -1) + (0, HIGH)
        seen = shapely.make_valid(drawn) & shapely.box(0, 0, WIDE, HIGH)
        share = shapely.Polygon(outline) & seen
        assert share.area > (0.998 if i == 12 else 1 - 1e-9) * seen.area
        assert shapely.Polygon(outline).area == pytest.approx(share.area, rel=1e-9)
        assert math.dist(stone.centroid, (seen.centroid.x, HIGH - seen.centroid.y)) < 0.05
        assert stone.area_px == pytest.approx(seen.area, rel=0.01)


def test_lines_along_the_edges_of_pixels_are_pixels(tmp_path):
    """The steps of a slope are those of a grid, and not of a stone."""
    edges = [(x + dx, 20 + (x - 20) // 2) for x in range(20, 80) for dx in (0, 1)]
    centres = [(x, 30 + max(0, x - 80) // 2) for x in range(110, 180)]
    for i, steps in enumerate((edges, centres), 1):
        (x0, _), (x1, _) = steps[0], steps[-1]
        stair = shapely.Polygon([*steps, (x1, 120), (x0, 120)])
        stone = read_stones(page(tmp_path, {i: stair})).by_id(i)
        assert stone.drawn is None
        assert len(stone.outline) < len(steps)


def test_the_frame_of_the_photograph_survives_and_what_nobody_can_use_is_refused(tmp_path):
    details = {"source": {"name": "pile.jpg"}, "markers": [MARKER], "P_from_marker": FRAME}
    photograph = dict(read_stones(page(tmp_path, **details)).source.photograph)
    assert photograph == {"name": "pile.jpg", "markers": [MARKER], "P_from_marker": FRAME}
    for own in (
        {"px_per_m": -2}, {"px_per_m": math.nan}, {"px_per_m": "a"}, {"ground": [[1, 2]]},
        {"ground": [[5, 1], [5, 9]]}, {"markers": [7], "P_from_marker": FRAME},
        {"ground": [[0, 1], [1e300, 9]]}, {"not_used": [[3]]},
    ):  # fmt: skip
        with pytest.raises(InputError, match=r"E114 .*the table drystone cannot be used"):
            read_stones(page(tmp_path, **own))


def left(wall):
    return min(np.min(outline[:, 0]) for outline in wall.outlines.values())


def test_a_wall_is_turned_until_its_ground_is_level_and_cut_off_there(tmp_path):
    level = read_wall(page(tmp_path, px_per_m=250))
    ends, buried = shapely.LineString([(0, 155.25), (300, 155.25)]), shapely.box(30, 170, 60, 190)
    for angle, flip in ((0, 1), (3.5, 1), (-2, -1)):
        shapes = {i: affinity.rotate(one, angle, (0, 0)) for i, one in {**WALL, 99: buried}.items()}
        ground = list(affinity.rotate(ends, angle, (0, 0)).coords)[::flip]
        wall = read_wall(page(tmp_path, shapes, px_per_m=250, ground=ground))
        assert wall.px_per_m == 250.0
        assert wall.outlines.keys() == WALL.keys()
        assert f"turned by {angle:.2f} degrees and cut off at it, and 99 left out" in said(wall)
        for i, outline in wall.outlines.items():
            # Five px are buried; nothing was ever a pixel on the way.
            lower = shapely.Polygon(level.outlines[i] - (0.0, 5.0))
            expected = lower & shapely.box(-9, 0, WIDE, HIGH)
            moved = affinity.translate(shapely.Polygon(outline), left(level) - left(wall))
            assert moved.symmetric_difference(expected).area < 1e-6 * expected.area
    with pytest.raises(InputError, match=r"E104 .*Draw the ground under the wall"):
        read_wall(page(tmp_path, ground=[[0, 2], [300, 2]]))
