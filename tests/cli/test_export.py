"""`drystone export`: what it writes, what it refuses, and that nothing is written then."""

import json
import shutil
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import ezdxf
import pytest

from drystone.drawing.export.formats import FORMATS
from tests.cli.conftest import WALL, rewrite
from tests.drawing.export.robot_plans import write_plan_folder

QUICK = ("poses", "compas", "moveit", "urdf", "obj", "glb", "stl", "csv", "geojson")
"""Formats that need no drawing."""


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    """The folder of a plan in px; not to be changed."""
    return write_plan_folder("exact", tmp_path_factory.mktemp("plan"))


@pytest.fixture
def plan(planned, tmp_path):
    """The plan.json of a plan in px."""
    return Path(shutil.copytree(planned, tmp_path / "plan")) / "plan.json"


def tree(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b""
        for path in sorted(folder.rglob("*"))
    }


def test_formats_are_listed(run):
    ran = run("export", "--list")
    assert ran.code == 0
    assert [line.partition(":")[0] for line in ran.out.splitlines()] == list(FORMATS)


def test_files_are_added_beside_the_plan(run, plan):
    before = tree(plan.parent)
    scale = ("--px-per-m", 200, "--thickness", 0.25, "--density", 2000)
    ran = run("export", plan, "--to", *QUICK, *scale)
    assert ran.code == 0, ran.err
    after = tree(plan.parent)
    assert {name: after[name] for name in before} == before
    new = set(after) - set(before)
    assert {"poses.json", "assembly.compas.json", "scene.yaml", "wall.scene", "urdf/wall.urdf",
            "wall.obj", "wall.mtl", "wall.glb", "stl/wedge_010.stl", "steps.csv",
            "wall.geojson"} <= new  # fmt: skip
    assert [line.partition(":")[0] for line in ran.out.splitlines()] == list(QUICK)
    assert ran.err == ""
    poses = json.loads((plan.parent / "poses.json").read_bytes())
    assert (poses["thickness_m"], poses["density_kg_m3"]) == (0.25, 2000)


def test_json_names_every_file(run, plan, tmp_path):
    folder = tmp_path / "new" / "deep"
    asked = (*QUICK, "csv", "--px-per-m", 200, "-o", folder, "--json")
    ran = run("export", plan.parent, "--to", *asked)
    files = ran.json()["files"]
    assert list(files) == list(QUICK)
    named = sorted(Path(name) for names in files.values() for name in names)
    assert named == sorted(path for path in folder.rglob("*") if path.is_file())
    assert ("no --thickness: parts are 0." in ran.err, "W123" in ran.err) == (True, False)
    odd = run("export", plan, "--to", "csv", "--px-per-m", 20_000, "--json")
    assert "W123" in odd.err


def test_a_ruler_is_a_scale(run, plan, tmp_path):
    for folder, scale in (("a", ("--px-per-m", "200")), ("b", ("--ruler", "0,0,30,40=25cm"))):
        assert run("export", plan, "--to", *QUICK, *scale, "-o", tmp_path / folder).code == 0
    assert tree(tmp_path / "a") == tree(tmp_path / "b")
    both = run("export", plan, "--to", "csv", "--px-per-m", "200", "--ruler", "0,0,3,4=1m")
    assert both.code == 2


def test_a_title_of_any_letters_makes_files_that_can_be_read(run, plan):
    title = "<b>\n\x01 $x_1$ \N{CJK UNIFIED IDEOGRAPH-6F22}"
    ran = run("export", plan, "--to", "svg", "dxf", "png", "pdf", "--title", title)
    assert (ran.code, ran.err) == (0, "")
    read = ET.fromstring((plan.parent / "wall.svg").read_bytes())  # noqa: S314 - our own file
    said = "<b>   $x_1$ \N{CJK UNIFIED IDEOGRAPH-6F22}"
    assert read.findtext("{http://www.w3.org/2000/svg}title") == said
    texts = ezdxf.readfile(plan.parent / "wall.dxf").modelspace().query("TEXT")
    assert said in [text.dxf.text for text in texts]


def test_exports_of_an_earlier_plan_are_named(run, plan_copy, rubble):
    folder = plan_copy
    assert run("export", folder, "--to", "csv", "stl", "--px-per-m", 200).code == 0
    said = run("plan", rubble, *WALL, "-o", folder, "--overwrite").err
    assert f"W181 of an earlier plan: stl/, steps.csv, in {folder}." in said
    assert (folder / "steps.csv").exists()


def test_files_of_another_plan_in_a_folder_of_its_own_are_named(run, plan):
    first = run("export", plan, "--to", "stl", "--px-per-m", "200")
    assert "W180" not in first.err
    (plan.parent / "stl" / "stone_999.stl").write_bytes(b"of an earlier plan")
    again = run("export", plan, "--to", "stl", "--px-per-m", "200", "--overwrite")
    assert (again.code, "W180 not of this plan: stl/stone_999.stl, in" in again.err) == (0, True)
    assert (plan.parent / "stl" / "stone_999.stl").exists()


def test_nothing_is_written_when_one_format_cannot_be(run, plan, monkeypatch):
    before = tree(plan.parent)

    def refused(code, *asked):
        ran = run("export", plan, "--to", "csv", *asked)
        assert (ran.code in (2, 3), code in ran.err, ran.out) == (True, True, "")
        assert tree(plan.parent) == before
        return ran.err

    said = refused("E131", "poses")
    assert all(way in said for way in ("--px-per-m", "--ruler", "markers"))
    refused("E187", "svg", "projector", "--px-per-m", "100", "--projector", "640x480@1000")
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "ezdxf", None)
        refused("E185", "dxf")
    (plan.parent / "photo.png").write_bytes(b"no picture")
    before = tree(plan.parent)
    refused("E189", "pdf")

    def orphan(read):
        next(step for step in read["steps"] if step["kind"] == "wedge")["under"] = 9999

    rewrite(plan, orphan)
    before = tree(plan.parent)
    refused("E214", "gif")
