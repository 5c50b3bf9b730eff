"""What is drawn beside stones is left out by one rule in all forms, is named, and can be kept."""

import numpy as np
import pytest
from PIL import Image, ImageDraw

from drystone.errors import InputError, UsageError
from drystone.io.outlines_in.classes import is_other
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.labelled import CLASSES, FORMS, HEIGHT, WIDTH, box, stones, written
from tests.io.pictures import said, save_mask


def read(folder, form, shapes, **settings):
    path = written(folder, form, shapes)
    if form == "yolo":
        settings |= {"image": str(folder / "a.png")}
    return read_stones(path, settings=ReadSettings(px_per_m=1000.0, **settings))


def areas(found):
    return sorted(stone.area_px for stone in found)


def of_stones(rings):
    return [("stone", ring) for ring in rings]


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    return areas(read(tmp_path_factory.mktemp("truth"), "coco", of_stones(stones())))


@pytest.mark.parametrize("form", CLASSES)
def test_classes_that_are_not_stones(tmp_path, form):
    other = "ArUco marker"
    others = [(other, box(340, 20, 350, 230)), (other, box(2, 2, 12, 12))]
    shapes = of_stones(stones()) + others
    found = read(tmp_path, form, shapes)
    assert len(found) == 12
    text = said(found)
    assert f"{other} (2)" in text
    assert f"left out: {other}." in text
    assert "stone (12)" in text
    assert areas(read(tmp_path, form, shapes, label=(other.upper(),)))[0] == pytest.approx(100)
    both = read(tmp_path, form, shapes, label=("stone", other))
    assert len(both) == 14
    with pytest.raises(UsageError, match=rf"E118.*'tree'.*stone, {other}"):
        read(tmp_path, form, shapes, label=("tree",))


@pytest.mark.parametrize("form", ["coco", "qupath"])
@pytest.mark.parametrize("names", [("granite", "sandstone"), ("wall", "wall")])
def test_kinds_of_stone_of_any_name_are_all_read_and_listed(tmp_path, form, names):
    shapes = [(names[i % 2], ring) for i, ring in enumerate(stones())]
    found = read(tmp_path, form, shapes)
    assert len(found) == 12
    for name in names:
        assert f"{name} ({12 if names == ('wall', 'wall') else 6})" in said(found)
    assert "all classes are read" in said(found)


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("stone", False), ("Wall stone", False), ("stone wall", True), ("scaleBar", True),
        ("ARUCO_MARKERS", True), ("shadows", True), ("limestone", False), ("background", True),
        ("Region*", True), ("large", False), ("granite", False), ("3", False), ("", False),
        ("rock-shadow", True), ("leaves", True), ("bedrock", False),
    ],
)  # fmt: skip
def test_names_of_classes(name, other):
    assert is_other(name) == other


FRAME = box(2.0, 3.0, 357.0, 258.0)


@pytest.mark.parametrize(("form", "last"), [(form, i % 2 > 0) for i, form in enumerate(FORMS)])
def test_a_frame_around_the_stones(tmp_path, form, last, truth):
    shapes = of_stones(stones())
    shapes.insert(12 if last else 0, ("stone", FRAME))
    found = read(tmp_path, form, shapes)
    assert len(found) == 12
    assert areas(found) == pytest.approx(truth, rel=0.02 if form == "dxf" else 0.001)
    number = 13 if last else 1
    assert f"a frame around {2 - last}, " in said(found)
    (notice,) = [n for n in found.notices if "a frame" in n.message]
    assert "--keep" in notice.cure
    kept = read(tmp_path, form, shapes, keep=(number,))
    assert [stone.id for stone in kept] == [number]  # all others are its parts


@pytest.mark.parametrize("form", ["coco", "svg", "dxf"])
def test_pages_in_pages_and_two_sheets(tmp_path, form):
    pages = [box(0, 0, 360, 260), box(3, 3, 357, 257), box(3, 3, 357, 257)]
    sheets = [box(1, 1, 179, 259), box(181, 1, 359, 259)]
    for drawn in ([*pages, *stones()], [*stones(), *sheets]):
        assert len(read(tmp_path, form, of_stones(drawn))) == 12


@pytest.mark.parametrize(
    ("form", "shift"), [("coco", 0.0), ("svg", 0.4), ("dxf", 0.0), ("dxf", 0.4)]
)
def test_repeats(tmp_path, form, shift, truth):
    rings = stones()
    again = [(np.asarray(ring) + shift).tolist() for ring in rings]
    found = read(tmp_path, form, of_stones([*rings, *again]))
    assert len(found) == 12
    assert areas(found) == pytest.approx(truth, rel=0.05)
    assert said(found).count(" again)") == 12


@pytest.mark.parametrize("form", ["coco", "cvat", "svg"])
def test_parts(tmp_path, form):
    rings = stones()
    middles = [np.mean(ring, axis=0) for ring in rings[:5]]
    spots = [box(x - 3, y - 3, x + 3, y + 3) for x, y in middles]
    found = read(tmp_path, form, of_stones([*rings, *spots]))
    assert len(found) == 12
    assert said(found).count("a part of") == 5
    assert len(read(tmp_path, form, of_stones([*rings, *spots]), keep=(13,))) == 13


@pytest.mark.parametrize("form", ["labelme", "svg", "dxf"])
def test_real_stones_stay(tmp_path, form):
    touching = [box(10, 10, 60, 60), box(60, 10, 110, 60), box(35, 60, 90, 100)]
    overlapping = [box(130, 10, 180, 60), box(165, 15, 215, 55)]  # by 37 % of the smaller one
    large = box(10, 110, 350, 255)
    found = read(tmp_path, form, of_stones([*touching, *overlapping, large]))
    assert len(found) == 6
    assert "not stones" not in said(found)
    assert len(read(tmp_path, form, of_stones([box(1, 1, 359, 259)]))) == 1


@pytest.mark.parametrize("form", ["coco", "labelme", "qupath", "via", "label_studio", "cvat"])
def test_slivers_are_named_and_left_out(tmp_path, form):
    shapes = of_stones(stones())
    shapes.insert(3, ("stone", [[20, 20], [30, 30]]))
    found = read(tmp_path, form, shapes)
    assert len(found) == 12
    assert "less than 3 points left out: " in said(found)
    assert f" {4 if form == 'coco' else 3} " in said(found).partition("left out")[2]


@pytest.mark.parametrize("form", ["coco", "labelme", "via", "qupath", "yolo"])
def test_shares_of_the_picture(tmp_path, form, truth):
    rings = [(np.asarray(ring) / [WIDTH, HEIGHT]).tolist() for ring in stones()]
    if form in ("coco", "labelme"):
        found = read(tmp_path, form, of_stones(rings))
        assert areas(found) == pytest.approx(truth, rel=0.01)
        assert "shares of the picture: taken times 360 x 260 px" in said(found)
        return
    path = written(tmp_path, form, of_stones(stones() if form == "yolo" else rings))
    with pytest.raises(InputError, match=r"E116.*shares of a picture.*--image PHOTO"):
        read_stones(path)


@pytest.mark.parametrize("over", [0, 1, 3])
def test_y_runs_up_if_most_of_the_file_says_so(tmp_path, over):
    rings = [[[x, -y] for x, y in ring] for ring in stones()]
    for ring in rings[:over]:
        max(ring, key=lambda point: point[1])[1] = 0.4
    found = read(tmp_path, "qupath", of_stones(rings))
    assert len(found) == 12
    assert "y runs up" in said(found)
    down = stones()
    for ring in down[:over]:
        min(ring, key=lambda point: point[1])[1] = -0.4
    assert "y runs up" not in said(read(tmp_path, "qupath", of_stones(down)))


def _one(ring):
    image = Image.new("L", (WIDTH, HEIGHT))
    ImageDraw.Draw(image).polygon([tuple(point) for point in ring], fill=1)
    return np.asarray(image)


def folder_of(path, masks):
    for i, mask in enumerate(masks):
        save_mask(path / f"{i}.png", mask)
    return path


def test_a_folder_of_all_that_a_program_masks(tmp_path):
    masks = [_one(ring) > 0 for ring in stones()]
    ground = ~np.any(masks, axis=0)
    spot = np.zeros_like(ground)
    spot[40:50, 40:50] = True
    near = np.zeros_like(ground)
    near[170:, :185] = True  # two stones, and the ground around them
    found = read_stones(folder_of(tmp_path, [ground, *masks, spot, masks[4], near]))
    assert len(found) == 12
    text = said(found)
    for one in ("1 0.png (the ground", "14 13.png (a part of 2)", "15 14.png (6 again)",
                "16 15.png (a group of 10, 11)"):  # fmt: skip
        assert one in text
    assert len(read_stones(tmp_path, settings=ReadSettings(keep=(15,)))) == 13
    other = read_stones(tmp_path, settings=ReadSettings(skip=(10, 11)))
    assert 16 in {stone.id for stone in other}  # the group became a stone


def test_a_folder_of_stones_that_had_a_picture_each(tmp_path):
    ring = np.asarray(stones()[0]) - [45, 45]
    scales = (0.9, 0.6, 1.1, 0.4, 1.0)
    found = read_stones(folder_of(tmp_path, [_one(ring * s + [180, 130]) for s in scales]))
    assert len(found) == 5
    assert "not stones" not in said(found)


def test_a_folder_of_inverted_masks_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"E105.*0.png"):
        read_stones(folder_of(tmp_path, [_one(ring) == 0 for ring in stones()]))


def test_arrays_of_masks(tmp_path):
    masks = {f"stone_{i}": _one(ring) > 0 for i, ring in enumerate(stones(), start=1)}
    ground = ~np.any(list(masks.values()), axis=0)
    np.savez(tmp_path / "a.npz", **masks, stone_13=ground)
    found = read_stones(tmp_path / "a.npz")
    assert [stone.id for stone in found] == list(range(1, 13))
    assert "13 stone_13 (the ground" in said(found)


def test_classes_are_for_outlines_only():
    with pytest.raises(UsageError, match=r"E118.*no classes.*--label"):
        read_stones(_one(stones()[0]), settings=ReadSettings(label=("stone",)))


def test_what_is_kept_must_be_there(tmp_path):
    found = read(tmp_path, "coco", of_stones(stones()), keep=(99,))
    assert "no stone 99 to keep" in said(found)
