"""What is drawn beside stones is left out by one rule in all forms, is named, and can be kept."""

import numpy as np
import pytest
import shapely
from PIL import Image, ImageDraw

from drystone.errors import InputError, UsageError
from drystone.io.outlines_in.classes import is_other
from drystone.io.outlines_in.nested import meeting
from drystone.io.outlines_in.silhouettes import _crossings
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.labelled import CLASSES, FORMS, HEIGHT, WIDTH, box, stones, written
from tests.io.pictures import said, save_mask


def read(folder, form, shapes, **settings):
    """What is read of labels and rings; rings alone are stones."""
    shapes = [one if isinstance(one, tuple) else ("stone", one) for one in shapes]
    path = written(folder, form, shapes)
    if form == "yolo":
        settings |= {"image": str(folder / "a.png")}
    return read_stones(path, settings=ReadSettings(px_per_m=1000.0, **settings))


def areas(found):
    return sorted(stone.area_px for stone in found)


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    return areas(read(tmp_path_factory.mktemp("truth"), "coco", stones()))


@pytest.mark.parametrize("form", CLASSES)
def test_classes_that_are_not_stones(tmp_path, form):
    other = "ArUco marker"
    shapes = [*stones(), (other, box(340, 20, 350, 230)), (other, box(2, 2, 12, 12))]
    found = read(tmp_path, form, shapes)
    assert len(found) == 12
    for text in (f"{other} (2)", f"left out: {other}.", "stone (12)"):
        assert text in said(found)
    assert areas(read(tmp_path, form, shapes, label=(other.upper(),)))[0] == pytest.approx(100)
    assert len(read(tmp_path, form, shapes, label=("stone", other))) == 14
    kinds = read(tmp_path, form, [*stones(), ("granite", box(2, 2, 12, 12))])
    assert "stone (12), granite (1); all classes are read" in said(kinds)
    with pytest.raises(UsageError, match=rf"E118.*'tree'.*stone, {other}"):
        read(tmp_path, form, shapes, label=("tree",))


def test_names_of_classes():
    stones = ["stone", "Wall stone", "limestone", "large", "granite", "3", "", "bedrock"]
    others = ["stone wall", "scaleBar", "ARUCO_MARKERS", "shadows", "background", "Region*",
              "rock-shadow", "leaves"]  # fmt: skip
    assert [name for name in stones + others if is_other(name)] == others


@pytest.mark.parametrize(("form", "last"), [(form, i % 2 > 0) for i, form in enumerate(FORMS)])
def test_a_frame_around_the_stones(tmp_path, form, last, truth):
    shapes = stones()
    shapes.insert(12 if last else 0, box(2.0, 3.0, 357.0, 258.0))
    found = read(tmp_path, form, shapes)
    assert areas(found) == pytest.approx(truth, rel=0.02 if form == "dxf" else 0.001)
    number = 13 if last else 1
    assert f"a frame around {2 - last}, " in said(found)
    (notice,) = [n for n in found.notices if "a frame" in n.message]
    assert "--keep" in notice.cure
    kept = read(tmp_path, form, shapes, keep=(number,))
    assert [stone.id for stone in kept] == [number]  # all others are its parts


@pytest.mark.parametrize("form", ["coco", "svg", "cvat", "dxf"])
def test_pages_in_pages_two_sheets_and_parts(tmp_path, form):
    pages = [box(0, 0, 360, 260), box(3, 3, 357, 257), box(3, 3, 357, 257)]
    sheets = [box(1, 1, 179, 259), box(181, 1, 359, 259)]
    rings = stones()
    for drawn in ([*pages, *rings], [*rings, *sheets]):
        assert len(read(tmp_path, form, drawn)) == 12
    if form == "dxf":  # there parts are holes
        return
    middles = [np.mean(ring, axis=0) for ring in rings[:5]]
    spots = [box(x - 3, y - 3, x + 3, y + 3) for x, y in middles]
    found = read(tmp_path, form, [*rings, *spots])
    assert len(found) == 12
    assert said(found).count("a part of") == 5
    assert len(read(tmp_path, form, [*rings, *spots], keep=(13,))) == 13


@pytest.mark.parametrize("form", ["labelme", "dxf"])
def test_what_is_no_stone_costs_no_stone_its_number(tmp_path, form):
    *rings, more = stones()[:4]
    named = [(f"stone {i}", ring) for i, ring in zip((12, 3, 7), rings, strict=True)]
    nothing = ("dot", box(9.6, 9.6, 9.7, 9.7))
    again = named[1], (named[0][0], (np.asarray(named[0][1]) + 0.4).tolist())
    shapes = [("all", box(2, 2, 357, 258)), *named, nothing, *again]
    found = read(tmp_path, form, shapes)
    for part in ("13 all (a frame around 3, 7, 12)", "15 stone 3 (3 again)", "12 (12 again)"):
        assert part in said(found)
    assert "in order" not in said(found)
    # Numbers mean the same whatever is skipped or kept.
    for settings, ids in (
        ({}, [3, 7, 12]),
        ({"skip": (7, 13)}, [3, 12]),
        ({"keep": (13,)}, [13]),
        ({"keep": (15,)}, [3, 7, 12, 15]),
    ):
        assert [stone.id for stone in read(tmp_path, form, shapes, **settings)] == ids
    found = read(tmp_path, form, [*shapes, ("new", more)])
    assert [stone.id for stone in found] == [2, 3, 4, 8]
    assert "1 of 4 stones without a number: all are numbered in order (12 is now 2," in said(found)


@pytest.mark.parametrize("form", ["labelme", "svg", "dxf"])
def test_real_stones_stay(tmp_path, form):
    touching = [box(10, 10, 60, 60), box(60, 10, 110, 60), box(35, 60, 90, 100)]
    overlapping = [box(130, 10, 180, 60), box(165, 15, 215, 55)]  # by 37 % of the smaller one
    found = read(tmp_path, form, [*touching, *overlapping, box(10, 110, 350, 255)])
    assert len(found) == 6
    assert "not stones" not in said(found)
    assert "stones overlap" in said(found)
    skipped = read(tmp_path, form, [*touching, *overlapping, box(300, 10, 400, 99)], skip=(5, 6))
    assert not {"overlap", "outside"} & set(said(skipped).split())
    assert len(read(tmp_path, form, [box(1, 1, 359, 259)])) == 1


@pytest.mark.parametrize("form", ["coco", "labelme", "qupath", "via", "label_studio", "cvat"])
def test_slivers_are_named_and_left_out(tmp_path, form):
    shapes = stones()
    shapes.insert(3, [[20, 20], [30, 30]])
    found = read(tmp_path, form, shapes)
    assert len(found) == 12
    assert "less than 3 points left out: " in said(found)
    assert f" {4 if form == 'coco' else 3} " in said(found).partition("left out")[2]


@pytest.mark.parametrize("form", ["coco", "labelme", "via", "qupath", "yolo"])
def test_shares_of_the_picture(tmp_path, form, truth):
    rings = [(np.asarray(ring) / [WIDTH, HEIGHT]).tolist() for ring in stones()]
    if form in ("coco", "labelme"):
        found = read(tmp_path, form, rings)
        assert areas(found) == pytest.approx(truth, rel=0.01)
        assert "shares of the picture: taken times 360 x 260 px" in said(found)
        return
    shapes = [("stone", ring) for ring in (stones() if form == "yolo" else rings)]
    with pytest.raises(InputError, match=r"E116.*shares of a picture.*--image PHOTO"):
        read_stones(written(tmp_path, form, shapes))


@pytest.mark.parametrize("over", [0, 1, 3])
def test_y_runs_up_if_most_of_the_file_says_so(tmp_path, over):
    up, down = [[[x, -y] for x, y in ring] for ring in stones()], stones()
    for one, other in zip(up[:over], down[:over], strict=True):
        max(one, key=lambda point: point[1])[1] = 0.4
        min(other, key=lambda point: point[1])[1] = -0.4
    found = read(tmp_path, "qupath", up)
    assert len(found) == 12
    assert "y runs up" in said(found)
    assert "y runs up" not in said(read(tmp_path, "qupath", down))


def one(ring):
    """The mask of a ring."""
    image = Image.new("1", (WIDTH, HEIGHT))
    ImageDraw.Draw(image).polygon([tuple(point) for point in ring], fill=1)
    return np.asarray(image)


def folder_of(path, masks):
    for i, mask in enumerate(masks):
        save_mask(path / f"{i}.png", mask)
    return path


def test_a_folder_or_arrays_of_all_that_a_program_masks(tmp_path):
    masks = [one(ring) for ring in stones()]
    ground = ~np.any(masks, axis=0)
    spot = np.zeros_like(ground)
    spot[40:50, 40:50] = True
    near = np.zeros_like(ground)
    near[170:, :185] = True  # two stones, and the ground around them
    found = read_stones(folder_of(tmp_path, [ground, *masks, spot, masks[4], near]))
    assert len(found) == 12
    text = said(found)
    for part in ("1 0.png (the ground", "14 13.png (a part of 2)", "15 14.png (6 again)",
                 "16 15.png (a group of 10, 11)"):  # fmt: skip
        assert part in text
    assert len(read_stones(tmp_path, settings=ReadSettings(keep=(15,)))) == 13
    other = read_stones(tmp_path, settings=ReadSettings(skip=(10, 11)))
    assert 16 in {stone.id for stone in other}  # the group became a stone
    # A piece has no number of what is left out.
    (tmp_path / "two").mkdir()
    two = folder_of(tmp_path / "two", [masks[0] | masks[1], masks[2], ~np.any(masks[:3], axis=0)])
    for skip, ids in (((), [1, 2, 4]), ((4,), [1, 2])):
        split = read_stones(two, settings=ReadSettings(pieces="split", skip=skip))
        assert [stone.id for stone in split] == ids
    named = {f"stone_{i}": mask for i, mask in enumerate([*masks, ground], start=1)}
    np.savez(tmp_path / "a.npz", **named)
    found = read_stones(tmp_path / "a.npz")
    assert [stone.id for stone in found] == list(range(1, 13))
    assert "13 stone_13 (the ground" in said(found)


def test_a_folder_of_stones_that_had_a_picture_each_and_one_of_inverted_masks(tmp_path):
    ring = np.asarray(stones()[0]) - [45, 45]
    scales = (0.9, 0.6, 1.1, 0.4, 1.0)
    found = read_stones(folder_of(tmp_path, [one(ring * s + [180, 130]) for s in scales]))
    assert len(found) == 5
    assert "not stones" not in said(found)
    with pytest.raises(InputError, match=r"E105.*0.png"):
        read_stones(folder_of(tmp_path, [~one(ring) for ring in stones()]))


def test_classes_are_for_outlines_only_and_what_is_kept_must_be_there(tmp_path):
    with pytest.raises(UsageError, match=r"E118.*no classes.*--label"):
        read_stones(one(stones()[0]), settings=ReadSettings(label=("stone",)))
    assert "no stone 99 to keep" in said(read(tmp_path, "coco", stones(), keep=(99,)))


def test_hundreds_of_shapes_and_edges_meet_where_they_do():
    """More than are asked for at once."""
    left = np.arange(600)
    pairs = np.hstack(list(meeting(shapely.box(left, 0, left + 1.5, 1))))
    assert {(i, j) for i, j in pairs.T.tolist() if i < j} == {(k, k + 1) for k in range(599)}
    t = np.arange(3000) * (2 * np.pi / 3000) + 0.1
    eight = np.column_stack([np.sin(2 * t), np.sin(t)])
    assert _crossings(np.stack([eight, np.roll(eight, -1, axis=0)], axis=1), 2000) == 1
