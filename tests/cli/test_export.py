"""`drystone export`: what it writes, what it refuses, and that nothing is written then."""

import json
from pathlib import Path
from xml.etree import ElementTree as ET

import ezdxf
import pytest

import drystone as ds
from drystone.cli.commands.export import CHANGED
from drystone.drawing.assembly import read_assembly
from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.cli.conftest import WALL
from tests.drawing.plans import planned

QUICK = ("poses", "compas", "moveit", "urdf", "obj", "glb", "stl", "csv", "geojson")
"""Formats that need no drawing."""


@pytest.fixture
def plan(tmp_path):
    ds.write_plan_folder(planned(), tmp_path)
    return tmp_path / "plan.json"


def tree(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b""
        for path in sorted(folder.rglob("*"))
    }


def test_files_are_added_beside_the_plan(run, plan):
    before = tree(plan.parent)
    scale = ("--px-per-m", 200, "--thickness", 0.25, "--density", 2000)
    ran = run("export", plan, "--to", *QUICK, *scale)
    assert (ran.code, ran.err) == (0, "")
    assert [line.partition(":")[0] for line in ran.out.splitlines()] == list(QUICK)
    after = tree(plan.parent)
    assert {name: after[name] for name in before} == before
    assert {"poses.json", "assembly.compas.json", "scene.yaml", "wall.scene", "urdf/wall.urdf",
            "wall.obj", "wall.mtl", "wall.glb", "stl/wedge_010.stl", "steps.csv",
            "wall.geojson"} <= set(after) - set(before)  # fmt: skip
    poses = json.loads(after["poses.json"])
    assert (poses["thickness_m"], poses["density_kg_m3"]) == (0.25, 2000)
    ran = run("export", "--list")
    assert (ran.code, [line.partition(":")[0] for line in ran.out.splitlines()]) == (0, [*FORMATS])


def test_json_names_every_file(run, plan, tmp_path):
    folder, ruled = tmp_path / "new" / "deep", tmp_path / "ruled"
    asked = ("export", plan.parent, "--to", *QUICK)
    ran = run(*asked, "csv", "--px-per-m", 200, "-o", folder, "--json")
    files = ran.json()["files"]
    assert list(files) == list(QUICK)
    named = sorted(Path(name) for names in files.values() for name in names)
    assert named == sorted(path for path in folder.rglob("*") if path.is_file())
    assert ("no --thickness: parts are 0." in ran.err, "W123" in ran.err) == (True, False)
    # A ruler is a scale.
    assert run(*asked, "--ruler", "0,0,30,40=25cm", "-o", ruled).code == 0
    assert tree(ruled) == tree(folder)
    assert run(*asked, "--px-per-m", "200", "--ruler", "0,0,3,4=1m").code == 2
    assert "W123" in run("export", plan, "--to", "csv", "--px-per-m", 20_000, "--json").err


def test_a_title_of_any_letters_makes_files_that_can_be_read(run, plan):
    title = "<b>\n\x01 $x_1$ \N{CJK UNIFIED IDEOGRAPH-6F22}"
    ran = run("export", plan, "--to", "svg", "dxf", "png", "pdf", "--title", title)
    assert (ran.code, ran.err) == (0, "")
    read = ET.fromstring((plan.parent / "wall.svg").read_bytes())  # noqa: S314 - our own file
    said = "<b>   $x_1$ \N{CJK UNIFIED IDEOGRAPH-6F22}"
    assert read.findtext("{http://www.w3.org/2000/svg}title") == said
    texts = ezdxf.readfile(plan.parent / "wall.dxf").modelspace().query("TEXT")
    assert said in [text.dxf.text for text in texts]


def test_an_option_is_for_the_formats_that_it_changes(plan):
    def made(px_per_m=200, thickness=None, density=2600.0, **settings):
        wall = read_assembly(plan, px_per_m=px_per_m, thickness_m=thickness, density_kg_m3=density)
        names = (*QUICK, "svg", "png", "gif", "projector")
        return {name: FORMATS[name].files(wall, ExportSettings(**settings)) for name in names}

    before = made()
    values = (300, 0.3, 2000, 50, "mine", (1200, 800), 2.0)
    for option, value in zip(CHANGED, values, strict=True):
        after = made(**{"projector_px" if option == "projector" else option: value})
        changed = {name for name in before if after[name] != before[name]}
        assert changed == {*before} & {*CHANGED[option].split()}


def test_exports_of_an_earlier_plan_are_named(run, plan_copy, rubble):
    asked = ("export", plan_copy, "--to", "csv", "stl", "--px-per-m", 200)
    other, table = plan_copy / "stl" / "stone_999.stl", plan_copy / "steps.csv"
    assert "W180" not in run(*asked).err
    other.write_bytes(b"of an earlier plan")
    said = run(*asked, "--overwrite").err
    assert "W180 not of this plan: stl/stone_999.stl, in" in said
    said = run("plan", rubble, *WALL, "-o", plan_copy, "--overwrite").err
    assert f"W181 of an earlier plan: stl/, steps.csv, in {plan_copy}." in said
    assert (other.exists(), table.exists()) == (True, True)


def test_nothing_is_written_when_one_format_cannot_be(run, plan):
    before, small = tree(plan.parent), ("--px-per-m", "100", "--projector", "640x480@1000")
    run("export", plan, "--to", "csv", "svg", "projector", *small).refused("E187")
    assert tree(plan.parent) == before
