"""Walls: images beside their plans, and all that stones are read from; blocks from outlines."""

import math
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import tifffile
from ezdxf import units
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

import drystone as ds
from drystone.contacts.given import model_from_json
from drystone.contacts.outlines import model_of_traced
from drystone.errors import DrystoneError, InputError, PlanError
from drystone.io.photo_beside import PhotoSidecar, write_sidecar
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import read_stones
from drystone.io.wall_image import (
    read_wall_image,
    write_labels,
    write_stones,
    write_wall_image,
)
from drystone.io.walls import _seen, outlines_painted, read_wall, shows
from drystone.poses import PoseBook
from drystone.statics.limit import lateral_resistance
from tests.io import labelled
from tests.io.pictures import said
from tests.strategies import stones
from tests.verify.examples import L_STONE, SLAB, WEDGE, example
from tests.verify.tampering import moved, reshaped, swapped

PLANNED = [3, 5, SLAB, L_STONE, 300, WEDGE]


def test_an_image_shows_what_is_in_the_plan():
    plan = example().plan
    for seen, raster, exact in (
        (PLANNED, True, True),
        (PLANNED[:-1], False, True),  # a wedge that fills no pixel
        (PLANNED[1:], False, False),
        ([*PLANNED[:-1], 8], False, False),
        ([*PLANNED, 8], False, False),
    ):
        labels = np.array([[0, *seen]], np.uint32)
        assert shows(labels, plan) is raster
        assert shows(labels, replace(plan, settings={"geometry": "exact"})) is exact


def written(made, plan, folder):
    """A plan on pixels with the image of a wall that may be another."""
    ds.write_plan(plan, folder / "plan.json")
    write_wall_image(made.wall.labels, folder)
    return folder


def test_a_plan_on_pixels_has_its_stones_where_they_are_seen(tmp_path):
    for scale, px_per_m in ((1.0, None), (1.0, 137.0), (0.5, None), (0.5, 200.0)):
        made = example(scale, px_per_m)
        px = 1.0 / (scale * (px_per_m or 1.0))
        for plan in (made.plan, moved(made.plan, L_STONE, 0.5 * px, -0.5 * px)):
            assert read_wall(written(made, plan, tmp_path)).plan == plan
        off = moved(made.plan, L_STONE, 2.5 * px, 0)
        with pytest.raises(InputError, match=f"shows {L_STONE} in another place") as caught:
            read_wall(written(made, off, tmp_path))
        assert caught.value.code == "E133"


def test_a_plan_of_stones_whose_holes_stay_open_is_read(tmp_path):
    picture = np.zeros((14, 50), np.uint8)
    picture[2:12, 2:22], picture[2:12, 26:46] = 1, 2
    picture[5:8, 4:9] = 0  # it moves the centroid by a pixel
    found = read_stones(picture, settings=ReadSettings(holes="keep"))
    result = ds.plan_wall(found, 50, 12, scale=1.0, budget=1)
    assert len(result.plan.stone_steps) == 2
    path = ds.write_plan_folder(result, tmp_path / "wall")
    wall = read_wall(path)
    assert (wall.labels == result.wall.labels).all()
    assert wall.blocks is not None
    blocks = path.parent / "blocks.json"
    blocks.write_text(blocks.read_text().replace('"id": 1,', '"id": 9,'))
    with pytest.raises(InputError, match=r"E133 .*other stones"):
        read_wall(path)


def test_other_places_and_none_are_refused_nor_is_an_image_decoded_that_is_far_too_large(tmp_path):
    made = example()
    for plan in (
        swapped(made.plan, 3, 300),
        moved(made.plan, 3, 0, 10),
        reshaped(made.plan, lambda wedge: wedge - (3, 0)),
        reshaped(made.plan, lambda wedge: wedge * (1, 0)),
    ):
        with pytest.raises(InputError, match="E133"):
            read_wall(written(made, plan, tmp_path))
    with pytest.raises(InputError, match=r"E104 .*plan.json: the plan has no stones"):
        read_wall(written(made, replace(made.plan, steps=()), tmp_path))
    folder = written(made, made.plan, tmp_path)
    write_labels(np.ones((1001, 1000), np.uint8), next(folder.glob("wall.*")))
    with pytest.raises(InputError, match=r"E110 wall.png: .* the limit is 1 million"):
        read_wall(folder)


@given(
    stones(stone_id=6, max_px=30),
    st.floats(-180.0, 179.9),
    st.sampled_from([1.0, 0.7, 0.3, 0.1, 0.04]),
)
def test_no_pose_of_the_planner_is_in_another_place(stone, angle_deg, scale):
    posed = PoseBook(scale).pose(stone, angle_deg)
    labels = np.pad(posed.mask.astype(np.uint32) * 6, ((2, 3), (4, 1)))
    centroid, allowed = _seen(labels)[6]
    assert math.dist(centroid, (posed.anchor[0] + 4, posed.anchor[1] + 3)) <= allowed


HEIGHT, WIDTH, FOOT = 90, 130, 80
"""Of the image, px, and where the wall stands in it."""

BLOCKS = {
    3: [(20.0, 80.0), (70.0, 80.0), (70.0, 55.0), (20.0, 55.0)],
    5: [(70.0, 80.0), (120.0, 80.0), (120.0, 55.0), (70.0, 55.0)],
    8: [(30.0, 55.0), (100.0, 55.0), (95.0, 30.0), (42.0, 30.0)],
}
"""Corners by id, px, y down."""


def upright(scale=1.0):
    """The same corners, y up from the foot."""
    return {i: [(x * scale, (FOOT - y) * scale) for x, y in line] for i, line in BLOCKS.items()}


def drawn(form, folder, blocks=BLOCKS):
    """Blocks as a form has them; "y up" is that of a map."""
    sign = -1.0 if form == "y up" else 1.0
    shapes = [(str(i), [(x, sign * y) for x, y in line]) for i, line in blocks.items()]
    return labelled.written(folder, "qupath" if form == "y up" else form, shapes)


@pytest.mark.parametrize("form", [*labelled.CLASSES, "y up"])
def test_outlines_are_blocks_that_stand_on_their_lowest_point(form, tmp_path):
    path = drawn(form, tmp_path)
    wall = read_wall(path)
    blocks = [{"id": i, "polygon": line} for i, line in upright().items()]
    truth = lateral_resistance(model_from_json({"blocks": blocks, "mu": 0.6})).value
    found = lateral_resistance(model_of_traced(wall.outlines, 0.6)).value
    assert found == pytest.approx(truth, abs=1e-6)
    assert wall.drawn is (form == "dxf")
    px_a_mm = (wall.px_per_m or 1000.0) / 1000.0
    left = 20.0 if form in ("dxf", "y up") else 0.0  # of an image x is kept
    for (_, line), found in zip(sorted(upright().items()), wall.outlines.values(), strict=True):
        want = (np.array(line) - (left, 0.0)) * px_a_mm
        assert set(map(tuple, np.round(found, 3))) == set(map(tuple, np.round(want, 3)))
    if form == "labelme":
        assert list(wall.outlines) == [3, 5, 8]
    # Edges lie on pixel edges, so every rule for them gives the same pixels.
    settings = ReadSettings(px_per_m=1000.0)
    labels, stones = read_wall(path, settings).labels, read_stones(path, settings=settings)
    assert np.unique(labels[labels > 0]).tolist() == sorted(s.id for s in stones)
    assert [(labels == s.id).sum() for s in stones] == [s.area_px for s in stones]
    assert labels[-1].any()


def with_line(left, right, low, high, folder):
    """The blocks, and a ninth that is a box."""
    line = [(left, low), (right, low), (right, high), (left, high)]
    return drawn("labelme", folder, {**BLOCKS, 9: line})


def test_what_reaches_beyond_its_image_is_whole_and_may_not_fill_the_memory(tmp_path):
    wall = read_wall(with_line(-12.0, 20.0, 50.0, 40.0, tmp_path))
    assert wall.outlines[9][:, 0].min() == 0.0
    assert "cut off" not in said(wall)
    with pytest.raises(DrystoneError, match="E110"):
        read_wall(with_line(-4.5e6, 20.0, 50.0, 40.0, tmp_path))


def test_a_wall_in_units_that_dwarf_its_stones_is_that_in_px(tmp_path):
    """Corners of a stone in astronomical units are nearer to each other than 1e-9."""
    found = []
    for unit, mm in ((units.MM, 1.0), (18, 149_597_870_700_000)):
        document = ezdxf.new(units=unit)
        for line in BLOCKS.values():
            document.modelspace().add_lwpolyline(np.array(line) / mm, close=True)
        document.saveas(tmp_path / "wall.dxf")
        found.append(read_wall(tmp_path / "wall.dxf").outlines)
    for one, other in zip(*(wall.values() for wall in found), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-6)


def test_a_line_that_fills_pixels_is_known_by_them(tmp_path):
    for thickness in (1e-10, 1e-13):
        path = with_line(1.0, 30.0, 10.5, 10.5 + thickness, tmp_path)
        assert read_stones(path).by_id(9).drawn is None
        wall = read_wall(path)
        assert wall.outlines is None
        assert (wall.labels == 9).sum() == 29


def image():
    wall = {i: np.array([*line, line[0]]) for i, line in upright().items()}
    return np.pad(outlines_painted(wall), ((30, HEIGHT - FOOT), (0, WIDTH - 120)))


def test_pixels_of_every_form_are_a_label_image(tmp_path):
    labels = image()
    folder, npz, segmented = tmp_path / "masks", tmp_path / "wall.npz", tmp_path / "segmented"
    for place in (folder, segmented):
        place.mkdir()
    for i in (3, 5, 8):
        Image.fromarray(labels == i).save(folder / f"{i}.png")
    np.savez(npz, labels)
    write_labels(labels, segmented / "stones.png")
    write_sidecar(PhotoSidecar(130, 90, 250.0), segmented)
    for path, ids in ((folder, [1, 2, 3]), (npz, [3, 5, 8]), (segmented, [3, 5, 8])):
        wall = read_wall(path)
        assert np.unique(wall.labels).tolist() == [0, *ids]
        assert ((wall.labels > 0) == (labels > 0)).all()
        assert wall.px_per_m == (250.0 if path == segmented else None)
    assert read_wall(segmented / "stones.png").px_per_m == 250.0
    with pytest.raises(DrystoneError, match="stands beside the label image") as caught:
        read_wall(segmented / "stones.json")
    assert "Give stones.png" in caught.value.cure


def test_cropped_masks_are_refused_as_nothing_says_where_they_lie(tmp_path):
    for rows in (21, 22, 23):
        Image.fromarray(np.indices((rows, 30))[0] > 1).save(tmp_path / f"{rows}.png")
    with pytest.raises(DrystoneError, match=r"E304 .*masks were cropped"):
        read_wall(tmp_path)


@pytest.mark.parametrize("ending", [".png", ".tif", ".npy", ".json"])
def test_what_is_converted_is_read_again(ending, tmp_path):
    stones = read_stones(drawn("dxf", tmp_path), settings=ReadSettings(px_per_m=1000.0))
    path = tmp_path / f"wall-labels{ending}"
    assert write_stones(stones, path, 1000.0) == ()
    again = read_stones(path)
    assert [(s.id, s.area_px) for s in again] == [(s.id, s.area_px) for s in stones]
    assert again.source.px_per_m == 1000.0
    if ending != ".json":
        assert read_wall(path).px_per_m == 1000.0
        write_stones(stones, path, None)  # the scale of another picture does not stay
        assert read_stones(path).source.px_per_m is None


def test_a_sidecar_is_of_the_image_that_it_names(tmp_path):
    for name in ("one.png", "other.png"):
        write_labels(image(), tmp_path / name)
    write_sidecar(PhotoSidecar(130, 90, 250.0, labels="one.png"), tmp_path)
    scales = [read_stones(tmp_path / name).source.px_per_m for name in ("one.png", "other.png")]
    assert scales == [250.0, None]
    (tmp_path / "stones.json").write_text("{")
    assert read_stones(tmp_path / "other.png").source.px_per_m is None


def test_a_photograph_of_a_wall_is_told_how_walls_are_traced(tmp_path):
    noise = np.random.default_rng(1).integers(0, 256, (80, 90, 3), np.uint8)
    smooth = np.vstack([np.full((40, 90, 3), 200, np.uint8), noise[40:]])
    made = (("a.png", noise, "E102"), ("a.jpg", noise, "E102"), ("b.jpg", smooth, "E101"))
    for name, values, code in made:
        Image.fromarray(values).save(tmp_path / name)
        with pytest.raises(DrystoneError, match="#from-a-photograph-of-a-wall") as caught:
            read_wall(tmp_path / name)
        assert caught.value.code == code
        assert "segment" not in caught.value.cure


def course(*ids):
    """A course of touching stones under empty rows, one of them in two pieces."""
    labels = np.zeros((12, 10 * len(ids)), np.uint32)
    for index, value in enumerate(ids):
        labels[4:, 10 * index : 10 * index + 10] = value
    labels[2, 0] = ids[-1]
    return labels


@pytest.mark.parametrize("top", [2, 65535, 70000, 2**32 - 1, 0])
def test_nothing_is_dropped_split_or_filled(tmp_path, top):
    labels = course(top, 2**24 + 1 if top > 70000 else 300) if top else np.full((40, 20), 7)
    labels = labels.astype(np.uint32)
    name = "wall.png" if top < 2**16 else "wall.tif"
    if top == 2:  # a hole, and a speck
        labels[8, 4], labels[0, 9] = 0, 77
    path = write_wall_image(labels, tmp_path)
    assert path == tmp_path / name
    found = read_wall_image(path)
    assert found.dtype == np.uint32
    np.testing.assert_array_equal(found, labels)
    assert [p.name for p in tmp_path.iterdir()] == [name]
    with pytest.raises(PlanError, match="E206"):
        write_wall_image(labels, tmp_path / "none")


def test_files_that_are_no_walls_are_refused_with_a_code(tmp_path):
    photo = np.random.default_rng(1).integers(0, 255, (60, 80, 3)).astype(np.uint8)
    Image.fromarray(photo).save(tmp_path / "photo.png")
    assert write_wall_image(np.zeros((9, 9), np.uint32), tmp_path) == tmp_path / "wall.png"
    framed = np.pad(course(3, 9), 6)
    Image.fromarray(np.where(framed, framed, 255).astype(np.uint8)).save(tmp_path / "white.png")
    np.save(tmp_path / "halves.npy", course(1, 2) / 2)
    tifffile.imwrite(tmp_path / "pages.tif", np.stack([course(1, 2)] * 3), photometric="minisblack")
    for name, code in {
        "none.png": "E100", "photo.png": "E102", "wall.png": "E104", "white.png": "E105",
        "halves.npy": "E108", "pages.tif": "E109", ".": "E100",
    }.items():  # fmt: skip
        with pytest.raises(DrystoneError, match=code):
            read_wall_image(tmp_path / name)
    with pytest.raises(DrystoneError, match="E110"):
        read_wall_image(tmp_path / "photo.png", max_image_mpx=0.001)
    # Another background becomes zero, where nothing else is.
    np.testing.assert_array_equal(read_wall_image(tmp_path / "white.png", background=255), framed)
    with pytest.raises(DrystoneError, match="E108"):
        read_wall_image(write_wall_image(course(255, 300), tmp_path), background=255)
