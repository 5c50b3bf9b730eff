"""What is read is never written over, and what cannot be written is refused before the work."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from drystone.cli import output, planning
from drystone.cli.commands import segment
from drystone.io.photo_beside import LABELS, PhotoSidecar, write_sidecar
from drystone.io.wall_image import write_labels
from tests.cli.conftest import WALL, contents
from tests.statics.walls import stacked

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
    asked = ("check", plan_copy, "--stones", rubble, "--picture", wall, "--overwrite")
    run(*asked).refused(f"E129 {wall}: is read here")
    for name in ("", "plan.json", "wall.png"):
        asked = ("analyse", plan_copy / name, "-o", plan_copy, "--load", "gravity", "--overwrite")
        run(*asked).refused("E129", "belongs to the plan")
    assert contents(plan_copy) == before
    plan = (plan_copy / "plan.json").rename(plan_copy / "poses.json")
    asked = ("export", plan, "--to", "csv", "poses", "--px-per-m", 100, "--overwrite")
    run(*asked).refused(f"E129 {plan}: is read here")
    before["poses.json"] = before.pop("plan.json")
    assert contents(plan_copy) == before


def test_segment_keeps_its_photograph(tmp_path, run):
    photo, out = tmp_path / "photo.png", tmp_path / "out"
    Image.new("RGB", (40, 40)).save(photo)
    before = photo.read_bytes()
    for name, more in (("photo.jpg", ()), ("stones.png", ("--overwrite",))):
        photo = photo.rename(tmp_path / name)
        ran = run("segment", photo, "--px-per-m", 400, "-o", tmp_path, *more)
        ran.refused(f"E129 {photo}: is read here")
        assert contents(tmp_path) == {name: before}
    # Another name of the same photograph is seen too.
    out.mkdir()
    os.link(photo, out / "photo.jpg")
    run("segment", photo, "-o", out, "--overwrite").refused("E129")
    assert contents(out) == {"photo.jpg": before}


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


def test_a_choice_that_is_read_is_kept(rubble, plan_copy, run):
    """A new plan takes out the choice of an earlier search."""
    place, picture = plan_copy / "pareto" / "01", plan_copy / "pareto.png"
    place.mkdir(parents=True)
    for name in ("plan.json", "settings.toml"):
        shutil.copy(plan_copy / name, place)
    for path in (place / "wall.png", picture):
        shutil.copy(rubble, path)
    before, more = contents(place), ("-o", plan_copy, "--overwrite")
    plan, settings = ("plan", rubble, *WALL), place / "settings.toml"
    for asked in (plan, ("demo",)):
        run(*asked, "--settings", settings, *more).refused(f"E129 {settings}: is read here")
    for stones in (place / "wall.png", picture):
        run("plan", stones, *WALL, *more).refused(f"{stones.name}: is read here")
    for given in (place, place / "plan.json"):
        run(*plan, "--from", given, *more).refused("E129")
    assert contents(place) == before


def test_nothing_is_drawn_among_masks(finished, tmp_path, run):
    masks = tmp_path / "masks"
    masks.mkdir()
    for number in range(4):
        write_labels(np.pad(np.full((10, 20), 255, np.uint16), 3), masks / f"{number}.png")
    before, plan = contents(masks), ("plan", masks, "--wall", "40x20", *WALL[2:])
    for asked in (
        ("stones", masks, "-o", masks / "preview.png"),
        (*plan, "-o", masks, "--overwrite"),
        ("check", finished, "--stones", masks, "--picture", masks / "check.png"),
    ):
        run(*asked).refused("E129", "among the masks")
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
def test_a_file_is_replaced_only_when_that_is_said(line, name, rubble, settled, tmp_path, run):
    wall, folder = tmp_path / "wall.png", tmp_path / "out"
    at = folder / name
    folder.mkdir()
    write_labels(stacked((30, 10, 0), (20, 10, 5)), wall)
    at.write_bytes(b"mine")
    known = {"at": at, "folder": folder, "rubble": rubble, "plan": settled, "wall": wall}
    words = [word.format(**known) for word in line.split()]
    run(*words).refused(f"E129 {at}: exists")
    assert contents(folder) == {name: b"mine"}
    assert run(*words, "--overwrite").code == 0
    assert at.read_bytes() != b"mine"
    inside = [word.replace(str(folder), str(at)) for word in words]
    run(*inside).refused("E129")  # a file is no folder


@pytest.fixture
def _no_work(monkeypatch):
    """Nothing is planned or looked for."""

    def refuse_to_work(*_, **__):
        raise AssertionError("it was planned before the folder was looked at")

    monkeypatch.setattr(planning, "plan_wall", refuse_to_work)
    monkeypatch.setattr(segment, "segment_photo", refuse_to_work)


@pytest.mark.usefixtures("_no_work")
@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("report.html", "folder"),
        ("wall.tif", "folder"),
        ("pareto.png", "folder"),
        ("pareto", "file"),
        ("pareto/02", "file"),
        ("pareto/01/plan.json", "folder"),
        ("stones.json", "folder"),
    ],
)
def test_what_is_in_the_way_is_said_before_the_search(name, kind, rubble, tmp_path, run):
    photo, at = tmp_path / "photo.png", tmp_path / "out" / name
    Image.new("RGB", (40, 40), (90, 90, 90)).save(photo)
    at.parent.mkdir(parents=True)
    at.mkdir() if kind == "folder" else at.touch()
    before = sorted(tmp_path.rglob("*"))
    asked = ("segment", photo) if name == "stones.json" else ("plan", rubble, *WALL, "--pareto")
    ran = run(*asked, "-o", tmp_path / "out", "--overwrite")
    ran.refused("E129", f"{at.name}: is a {kind}")
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.usefixtures("_no_work")
def test_a_folder_that_is_read_only_is_said_before_the_search(rubble, tmp_path, run, monkeypatch):
    def read_only(**_):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(output, "TemporaryFile", read_only)
    said = f"E206 {tmp_path}: no file can be written there (Read-only file system)"
    run("plan", rubble, *WALL, "-o", tmp_path).refused(said, exit_code=3)
    assert list(tmp_path.iterdir()) == []
