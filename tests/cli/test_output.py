"""What cannot be written is refused before the work, and JSON is JSON on any stdout."""

import io
import json
import sys

import numpy as np
import pytest
from PIL import Image

from drystone.cli import main, output, planning
from drystone.cli.commands import segment
from tests.cli.conftest import WALL


def refuse_to_work(*_, **__):
    raise AssertionError("it was planned before the folder was looked at")


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("report.html", "folder"),
        ("wall.tif", "folder"),
        ("pareto.png", "folder"),
        ("pareto", "file"),
        ("pareto/02", "file"),
        ("pareto/01/plan.json", "folder"),
    ],
)
def test_what_is_in_the_way_is_said_before_the_search(
    name, kind, rubble, tmp_path, run, monkeypatch
):
    out = tmp_path / "out"
    (out / name).mkdir(parents=True)
    if kind == "file":
        (out / name).rmdir()
        (out / name).write_bytes(b"mine")
    before, said = sorted(out.rglob("*")), f"{name.split('/')[-1]}: is a {kind}"
    monkeypatch.setattr(planning, "plan_wall", refuse_to_work)
    run("plan", rubble, *WALL, "--pareto", "-o", out, "--overwrite").refused("E129", said)
    assert sorted(out.rglob("*")) == before


def test_a_folder_that_cannot_be_written_into_is_said_before_the_search(
    rubble, tmp_path, run, monkeypatch
):
    def read_only(**_):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(output, "TemporaryFile", read_only)
    monkeypatch.setattr(planning, "plan_wall", refuse_to_work)
    out = tmp_path / "out"
    said = f"E206 {out}: no file can be written there (Read-only file system)"
    run("plan", rubble, *WALL, "-o", out).refused(said, exit_code=3)
    assert list(out.iterdir()) == []


def test_segment_looks_at_its_folder_before_the_photograph(tmp_path, run, monkeypatch):
    photo = tmp_path / "photo.jpg"
    Image.fromarray(np.full((40, 40, 3), 90, np.uint8)).save(photo)
    (tmp_path / "out" / "stones.json").mkdir(parents=True)
    monkeypatch.setattr(segment, "segment_photo", refuse_to_work)
    ran = run("segment", photo, "-o", tmp_path / "out", "--overwrite")
    ran.refused("stones.json: is a folder")


@pytest.mark.parametrize("encoding", ["cp1252", "utf-8", "ascii", "utf-16"])
def test_json_is_json_on_any_stdout(encoding, rubble, tmp_path, monkeypatch):
    named = tmp_path / "Stäine 🪨.png"
    named.write_bytes(rubble.read_bytes())
    out = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(out, encoding=encoding))
    assert main(["stones", str(named), "--json"]) == 0
    printed = out.getvalue().decode(encoding)
    assert encoding != "utf-8" or named.name in printed
    assert json.loads(printed)["source"] == named.name
