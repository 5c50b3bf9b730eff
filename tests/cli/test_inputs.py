"""What is read is never written over, whatever is said of overwriting."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from drystone.cli.commands.segment import WRITTEN
from drystone.io.photo_beside import LABELS, PhotoSidecar, write_sidecar
from drystone.io.wall_image import write_labels
from tests.cli.conftest import EXACT, UNTRIED, WALL, masks_in
from tests.statics.walls import stacked


@pytest.fixture
def photo(tmp_path):
    """Two stones on blue cloth."""
    picture = np.full((300, 400, 3), (60, 90, 150), np.uint8)
    picture[60:140, 60:160] = picture[130:210, 220:330] = (170, 160, 140)
    path = tmp_path / "photo.jpg"
    Image.fromarray(picture).save(path)
    return path


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


PLAN = f"plan {{at}} {' '.join(WALL)} -o {{folder}}"


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("analyse {at} -o {folder}", "contacts.png"),
        ("measure {at} -o {folder}", "paths_F_AV.png"),
        ("craft {at} -o {folder}", "craft.png"),
        ("stones {at} -o {at}", "mine.png"),
        ("check {plan} --stones {at} --picture {at}", "mine.png"),
        (PLAN, "wall.png"),
        (PLAN, "picture.png"),
        (f"{PLAN.replace('{at}', '{rubble}')} --settings {{at}}", "settings.toml"),
        ("demo --settings {at} -o {folder}", "settings.toml"),
    ],
)
def test_what_is_read_is_not_written_over(line, name, rubble, finished, tmp_path, run):
    at = tmp_path / name
    shutil.copy(finished / name if at.suffix == ".toml" else rubble, at)
    known = {"at": at, "folder": tmp_path, "rubble": rubble, "plan": finished}
    before = contents(tmp_path)
    ran = run(*(word.format(**known) for word in line.split()), "--overwrite")
    ran.refused(f"E129 {at}: is read here")
    assert contents(tmp_path) == before


def test_what_a_plan_has_is_not_written_over(rubble, plan_copy, run):
    before, wall = contents(plan_copy), plan_copy / "wall.png"
    drawn = ("-o", plan_copy, "--load", "gravity")
    for asked, said in (
        (("check", plan_copy, "--stones", rubble, "--picture", wall), f"E129 {wall}: is read here"),
        *((("analyse", plan_copy / name, *drawn), "belongs to the plan")
          for name in ("", "plan.json", "wall.png")),
    ):  # fmt: skip
        run(*asked, "--overwrite").refused("E129", said)
        assert contents(plan_copy) == before
    plan = (plan_copy / "plan.json").rename(plan_copy / "poses.json")
    asked = ("export", plan, "--to", "csv", "poses", "--px-per-m", 100, "--overwrite")
    run(*asked).refused(f"E129 {plan}: is read here")
    before["poses.json"] = before.pop("plan.json")
    assert contents(plan_copy) == before


def test_segment_keeps_its_photograph(photo, run):
    given, before = photo, photo.read_bytes()
    for name, more in (("photo.jpg", ()), ("stones.png", ("--overwrite",))):
        given = given.rename(photo.with_name(name))
        ran = run("segment", given, "--px-per-m", 400, "-o", photo.parent, *more)
        ran.refused(f"E129 {given}: is read here")
        assert [path.name for path in photo.parent.iterdir()] == [name]
        assert given.read_bytes() == before
    # Another name of the same photograph is seen too.
    photo, out = given, photo.parent / "out"
    out.mkdir()
    os.link(photo, out / "photo.jpg")
    run("segment", photo, "-o", out, "--overwrite").refused("E129")
    assert len(list(out.iterdir())) == 1
    (out / "photo.jpg").unlink()
    ran = run("segment", photo, "--px-per-m", 400, "-o", out)
    assert ran.code == 0, ran.err
    assert {path.name for path in out.iterdir()} == set(WRITTEN)


def test_stones_keeps_what_it_reads(rubble, tmp_path, run):
    masks, found = tmp_path / "masks", tmp_path / "found"
    for path in (masks / "1.png", found / LABELS):
        path.parent.mkdir()
        shutil.copy(rubble, path)
    with Image.open(rubble) as picture:
        write_sidecar(PhotoSidecar(*picture.size), found)
    for source, picture in ((masks, masks / "1.png"), (found, found / LABELS)):
        run("stones", source, "-o", picture, "--overwrite").refused(f"E129 {picture}: is read here")
        assert picture.read_bytes() == rubble.read_bytes()
    # Pictures may lie beside the stones of a photograph.
    assert run("stones", found, "-o", found / "drawn.png").code == 0
    assert run("stones", found).code == 0


def test_a_plan_keeps_photographs_that_are_not_its_own(rubble, tmp_path, run, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(rubble, "labels.png")
    names = ("photo.jpg", "photo.png")
    for name in names:
        Path(name).write_bytes(b"mine")
    for _ in range(2):
        ran = run("plan", "labels.png", *WALL, "-o", ".", "--overwrite")
        assert ran.code in (0, 4), ran.err
        assert "photo.jpg was not put there by a plan and stays" in ran.err
        assert [Path(name).read_bytes() for name in names] == [b"mine", b"mine"]


def test_plan_keeps_the_choice_that_it_begins_with(rubble, tmp_path, run):
    asked = ("plan", rubble, *EXACT, *UNTRIED, "--seed", 1, "-o", tmp_path)
    assert run(*asked, "--pareto").code in (0, 4)
    first = tmp_path / "pareto" / "01"
    before = (first / "plan.json").read_bytes()
    for given in (first, first / "plan.json"):
        run(*asked, "--from", given, "--overwrite").refused("E129")
    assert (first / "plan.json").read_bytes() == before
    # The plan itself is replaced by one that is as good at least.
    assert run(*asked, "--from", tmp_path, "--overwrite").code in (0, 4)


@pytest.mark.parametrize("command", ["plan", "demo"])
def test_a_choice_that_is_read_is_kept(command, rubble, plan_copy, run):
    """A new plan takes out the choice of an earlier search."""
    place = plan_copy / "pareto" / "01"
    place.mkdir(parents=True)
    for name in ("plan.json", "settings.toml"):
        shutil.copy(plan_copy / name, place)
    stones = shutil.copy(rubble, place / "wall.png")
    before = (place / "settings.toml").read_bytes()
    more = ("--settings", place / "settings.toml", "-o", plan_copy, "--overwrite")
    asked = ("plan", rubble, *WALL) if command == "plan" else ("demo",)
    run(*asked, *more).refused("settings.toml: is read here")
    if command == "plan":
        run("plan", stones, *WALL, *more[2:]).refused("wall.png: is read here")
        picture = shutil.copy(rubble, plan_copy / "pareto.png")
        run("plan", picture, *WALL, *more[2:]).refused("pareto.png: is read here")
    assert (place / "settings.toml").read_bytes() == before
    assert Path(stones).read_bytes() == rubble.read_bytes()


def test_nothing_is_drawn_among_masks(tmp_path, run):
    masks = masks_in(tmp_path / "masks")
    before = contents(masks)
    wall = ("--wall", "40x20", "--scale", "1", "--method", "paper")
    assert run("plan", masks, *wall, "-o", tmp_path / "out").code in (0, 4)
    for asked in (
        ("stones", masks, "-o", masks / "preview.png"),
        ("plan", masks, *wall, "-o", masks, "--overwrite"),
        ("check", tmp_path / "out", "--stones", masks, "--picture", masks / "check.png"),
    ):
        run(*asked).refused("E129", "among the masks")
        assert contents(masks) == before
    # A folder of its own is no stone.
    assert run("stones", masks, "-o", masks / "drawn" / "preview.png").code == 0
    assert run("stones", masks).code == 0
    assert contents(masks) == before


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("stones {rubble} -o {at}", "stones.pdf"),
        ("stones {rubble} --labels {at}", "labels.tif"),
        ("generate brick -o {at}", "bricks.png"),
        ("markers -o {at}", "sheet.pdf"),
        ("analyse {wall} --associative-only -o {folder}", "blocks.csv"),
        ("measure {wall} -o {folder}", "paths_F_AH.png"),
        ("craft {wall} -o {folder}", "laps.png"),
        ("export {plan} --to geojson csv -o {folder}", "steps.csv"),
        ("check {plan} --stones {rubble} --picture {at}", "wall.svg"),
        ("rehearse {plan} --runs 1 -o {at}", "risk.png"),
    ],
)
def test_a_file_is_replaced_only_when_that_is_said(
    line, name, rubble, settled, tmp_path_factory, tmp_path, run
):
    at, wall = tmp_path / name, tmp_path_factory.mktemp("wall") / "wall.png"
    write_labels(stacked((30, 10, 0), (20, 10, 5)), wall)
    at.write_bytes(b"mine")
    known = {"at": at, "folder": tmp_path, "rubble": rubble, "plan": settled, "wall": wall}
    words = [word.format(**known) for word in line.split()]
    run(*words).refused(f"E129 {at}: exists")
    assert contents(tmp_path) == {name: b"mine"}
    assert run(*words, "--overwrite").code == 0
    assert at.read_bytes() != b"mine"
    inside = [word.replace(str(tmp_path), str(at)) for word in words]
    run(*inside).refused("E129")  # a file is no folder
