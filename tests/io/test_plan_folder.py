"""A plan from Python is a folder that every command reads, with the blocks of its outlines."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from PIL import Image

import drystone as ds
from drystone.cli.main import main
from drystone.contacts.given import model_from_json
from drystone.contacts.settled import model_of_outlines
from drystone.io.photo_beside import place_photo
from drystone.io.plan_folder import blocks_to_json
from drystone.io.wall_image import read_wall_image, write_labels
from drystone.io.walls import read_wall
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from tests.planner.scenes import bricks, greedy, rubble
from tests.verify.exact_examples import SETTINGS, exact_example
from tests.verify.examples import example


@cache
def planned(geometry="raster"):
    settings = greedy({"geometry": geometry})
    return ds.plan_wall(rubble(), 100, 36, scale=1.0, settings=settings, budget=1, px_per_m=100)


@pytest.mark.parametrize("geometry", ["exact", "raster"])
def test_commands_read_what_python_wrote(geometry, tmp_path, capsys):
    result = planned(geometry)
    path = ds.write_plan_folder(result, tmp_path / "new" / "out")
    assert path == tmp_path / "new" / "out" / "plan.json"
    assert ds.read_plan(path) == result.plan
    wall = read_wall(path.parent)
    assert (wall.labels == result.wall.labels).all()
    assert (wall.blocks is not None) == (geometry == "exact")
    for command in ("analyse", "measure", "craft"):
        assert main([command, str(path.parent)]) == 0
    assert main(["export", str(path.parent), "--to", "poses", "-o", str(tmp_path / "ex")]) == 0
    capsys.readouterr()


def test_no_file_of_another_wall_is_left(tmp_path):
    for geometry in ("exact", "raster"):
        (tmp_path / "mine.txt").write_text("mine")
        ds.write_plan_folder(planned(geometry), str(tmp_path))
    assert {path.name for path in tmp_path.iterdir()} == {
        "mine.txt", "plan.json", "settings.toml", "wall.png",
    }  # fmt: skip


def test_a_planner_becomes_a_plan_at_any_step():
    planner = ds.Planner(bricks(4), Site(40, 20), seed=1, settings=greedy({}))
    for step in planner.steps():
        if step.number == 2:
            break
    half = ds.result_of(planner)
    assert (half.status, len(half.plan.stone_steps)) == ("interrupted", 2)
    assert half.plan.seed == 1
    assert half.plan.stopped == "interrupted"  # as --resume looks for
    for _ in planner.steps():
        pass
    whole = ds.result_of(planner)
    assert whole.message == planner.stopped.text
    again = ds.plan_wall(bricks(4), 40, 20, scale=1.0, seed=1, settings=greedy({}), budget=1)
    assert whole.plan.steps == again.plan.steps
    assert np.array_equal(whole.wall.labels, again.wall.labels)
    assert whole.plan.settings["search"]["budget"] == 1


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    for place in (tmp_path / "file", tmp_path / "file" / "in"):
        with pytest.raises(ds.DrystoneError, match=r"E206 .*file"):
            ds.write_plan_folder(planned(), place)


def test_stones_of_a_few_px_are_not_taken_for_blended_ids(tmp_path):
    stones = ds.generate.rubble_stones(
        ds.generate.RubbleSettings(count=14), np.random.default_rng(3)
    )
    settings = greedy({"geometry": "raster"})
    result = ds.plan_wall(stones, 200, 100, scale=0.12, settings=settings, budget=1)
    ds.write_plan_folder(result, tmp_path)
    with pytest.raises(ds.DrystoneError, match="E101"):
        read_wall_image(tmp_path / "wall.png")
    assert (read_wall(tmp_path).labels == result.wall.labels).all()


def test_what_the_stones_were_read_from_is_never_replaced(tmp_path):
    settings = greedy({"geometry": "raster"})
    labels = ds.generate.lay_out(bricks(4))
    masks = tmp_path / "masks"
    masks.mkdir()
    for name, stone in zip(("wall.png", "other.png"), bricks(4), strict=False):
        Image.fromarray(np.pad(stone.mask, 2)).save(masks / name)
    for source in (tmp_path / "wall.tif", tmp_path / "wall.png", masks):
        if not source.is_dir():
            write_labels(labels, source)
        result = ds.plan_wall(ds.read_stones(source), 40, 20, settings=settings, budget=1)
        place = source if source.is_dir() else source.parent
        before = {path.name: path.read_bytes() for path in place.iterdir() if path.is_file()}
        with pytest.raises(ds.DrystoneError, match=r"E129 .*wall\.(tif|png)"):
            ds.write_plan_folder(result, place)
        assert before == {p.name: p.read_bytes() for p in place.iterdir() if p.is_file()}
        if not source.is_dir():
            source.unlink()


def test_files_that_no_plan_left_stay(tmp_path):
    mine = {name: tmp_path / name for name in ("wall.tif", "blocks.json", "photo.jpg")}
    for path in mine.values():
        path.write_bytes(b"mine")
    ds.write_plan_folder(planned(), tmp_path)
    assert {path.read_bytes() for path in mine.values()} == {b"mine"}


def test_the_photograph_of_an_earlier_plan_goes(tmp_path):
    photo = tmp_path / "pile" / "photo.jpg"
    photo.parent.mkdir()
    Image.fromarray(np.zeros((8, 8, 3), np.uint8)).save(photo)
    folder = tmp_path / "out"
    result = planned()
    folder.mkdir()
    _, record = place_photo(photo, folder)
    source = {**result.plan.source, **record}
    ds.write_plan_folder(replace(result, plan=replace(result.plan, source=source)), folder)
    assert (folder / "photo.jpg").exists()
    ds.write_plan_folder(result, folder)
    assert not (folder / "photo.jpg").exists()


def test_stones_of_a_program_can_be_checked_with_a_file_of_them(tmp_path, capsys):
    labels = ds.generate.lay_out(bricks(4))
    settings = greedy({"geometry": "raster"})
    result = ds.plan_wall(ds.read_stones(labels), 40, 20, settings=settings, budget=1)
    ds.write_plan_folder(result, tmp_path / "out")
    assert main(["check", str(tmp_path / "out")]) == 3
    assert "E202" in (said := capsys.readouterr().err)
    assert "given by a program" in said
    write_labels(labels, tmp_path / "stones.png")
    assert main(["check", str(tmp_path / "out"), "--stones", str(tmp_path / "stones.png")]) == 0
    assert "there is no file to compare bytes with" in capsys.readouterr().out
    write_labels(np.flipud(labels), tmp_path / "stones.png")
    assert main(["check", str(tmp_path / "out"), "--stones", str(tmp_path / "stones.png")]) == 5


def built(scale=1.0, px_per_m=None):
    """Return a wall with a wedge, and its model at another friction than that of its plan."""
    wall = exact_example(scale, px_per_m).wall
    return wall, model_of_outlines(wall.outlines, 0.7, SETTINGS.settle.contact_px)


@pytest.mark.parametrize(("scale", "px_per_m"), [(1.0, None), (0.5, 137.0)])
def test_what_is_written_is_the_model_in_the_units_of_the_plan(scale, px_per_m):
    wall, model = built(scale, px_per_m)
    units = px_per_m or 1.0
    read = model_from_json(json.loads(json.dumps(blocks_to_json(wall, model))))
    assert read.mu == model.mu == 0.7
    assert [block.id for block in read.blocks] == [block.id for block in model.blocks]
    for one, other in zip(read.blocks, model.blocks, strict=True):
        assert one.area * units**2 == pytest.approx(other.area, rel=1e-9)
        assert np.array(one.centroid) * units == pytest.approx(np.array(other.centroid))
        assert not one.fixed
    assert len(read.interfaces) == len(model.interfaces) > 6
    for one, other in zip(read.interfaces, model.interfaces, strict=True):
        assert (one.block, one.other, one.normal) == (other.block, other.other, other.normal)
        assert one.points * units == pytest.approx(other.points)
    assert any(interface.other == GROUND for interface in read.interfaces)
    there, here = lateral_resistance(read), lateral_resistance(model)
    assert there.left.alpha == pytest.approx(here.left.alpha, abs=1e-9)
    assert there.right.alpha == pytest.approx(here.right.alpha, abs=1e-9)
    assert here.left.success
    assert here.right.success


def test_a_wall_of_pixels_needs_none():
    _, model = built()
    with pytest.raises(ValueError, match="are their pixels"):
        blocks_to_json(example().wall, model)


def test_an_empty_wall_has_no_blocks():
    wall = Wall.empty(Site.from_source(40.0, 20.0, 0.5), exact=True)
    read = blocks_to_json(wall, model_of_outlines(wall.outlines, 0.58, 0.1))
    assert read == {"mu": 0.58, "blocks": [], "interfaces": []}
    assert model_from_json(read).blocks == ()
