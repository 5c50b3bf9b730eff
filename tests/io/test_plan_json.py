"""A plan and its file, and the folder that every command reads."""

import copy
import json
import math
from dataclasses import replace
from functools import cache

import jsonschema
import numpy as np
import pytest
from PIL import Image

import drystone as ds
from drystone.cli.main import main
from drystone.contacts.given import model_from_json
from drystone.contacts.settled import model_of_outlines
from drystone.errors import PlanError
from drystone.io.photo_beside import place_photo
from drystone.io.plan_folder import blocks_to_json
from drystone.io.plan_json import plan_from_json, plan_schema, plan_to_json, read_plan, write_plan
from drystone.io.wall_image import read_wall_image, write_labels
from drystone.io.walls import read_wall
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from tests.planner.scenes import bricks, greedy, rubble
from tests.verify.exact_examples import SETTINGS, exact_example
from tests.verify.examples import example

INDICES = {"SF": 0.9, "LFR": 1 / 3, "GDS": 0.5, "NHR": 0.1, "IWR": 0.2, "IS": -0.1, "LLC": 0.7}


def stone_step(**values):
    step = StoneStep(
        1, 17, 12.0, (30.25, 40.1), (100.0, 0.1 + 0.2), "left", 3, 1, INDICES, 21.5, None, None
    )
    return replace(step, **values)


def plan(**values):
    wedge = WedgeStep(2, 256, 17, ((1.0, 0.0), (3.0, 0.0), (3.0, 2.0)), 0.41, 0.39)
    whole = Plan(
        version="0.1.0", method="paper", seed=1, length_unit="px", px_per_m=None,
        settings={"mu": 0.58, "stop": {"failures": 5, "filling": 0.99}}, working_scale=0.5,
        source={"path": "PR.png", "sha256": "5" * 64, "stones": 32, "width_px": 598,
                "height_px": 156},
        width=560.0, height=160.0, steps=(stone_step(), wedge), unused=(4,),
        stopped="Steine aufgebraucht: größte übrig",
        metrics=PlanMetrics(0.8, None, 2.5, 0.67, 0.1, 0.2, 0.41, 0.39, 8.0),
    )  # fmt: skip
    return replace(whole, **values)


def test_plan_survives_its_file(tmp_path):
    path = tmp_path / "plan.json"
    more = {**plan().source, "photographer": {"name": "A. B."}}
    settings = {"b": [1, 2.5], "a": {"z": None, "y": 0.5}, "c": "text", "d": True}
    for one in (
        plan(),
        plan(length_unit="m", px_per_m=437.25, width=1.1 + 2.2, height=0.1 + 0.2),
        plan(steps=(), unused=(), source=more, settings=settings),
    ):
        write_plan(one, path)
        assert read_plan(path) == one
        assert read_plan(tmp_path) == one
    assert [p.name for p in tmp_path.iterdir()] == ["plan.json"]


def test_schema_is_valid_and_describes_every_field_and_keys_are_its_in_its_order():
    data, schema = plan_to_json(plan()), plan_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    nodes = [schema, *schema["$defs"].values()]
    for node in nodes:  # which grow
        for name, field in node.get("properties", {}).items():
            target = schema["$defs"][field["$ref"].split("/")[-1]] if "$ref" in field else field
            assert {"description", "const"} & (target | field).keys(), name
            nodes.append(field)
    assert len(nodes) > 70
    assert data["schema"] == "drystone-plan/1"
    assert list(data) == list(schema["properties"])
    for name in ("units", "wall", "metrics"):
        assert list(data[name]) == list(schema["properties"][name]["properties"])
    for step in data["steps"]:
        assert list(step) == list(schema["$defs"][f"{step['kind']}_step"]["properties"])
    assert [step["kind"] for step in data["steps"]] == ["stone", "wedge"]
    assert list(data["source"]) == ["path", "sha256", "stones", "width_px", "height_px"]
    assert list(data["steps"][0]["indices"]) == list(INDICES)


def test_equal_plans_give_equal_bytes(tmp_path):
    one = plan(source={**plan().source, "files": ["a.png"], "b": 1, "a": 2})
    step = stone_step(indices=dict(reversed(INDICES.items())), angle_deg=12)
    other = plan(
        settings=dict(reversed(one.settings.items())),
        source=dict(reversed(one.source.items())),
        steps=(step, *one.steps[1:]),
        width=560,
        seed=np.int64(1),
    )
    assert one == other
    texts = []
    for made in (one, other):
        write_plan(made, tmp_path / "plan.json")
        texts.append((tmp_path / "plan.json").read_bytes())
    assert texts[0] == texts[1]
    assert texts[0].endswith(b"}\n")
    assert "größte".encode() in texts[0]
    zero, minus = (plan(steps=(stone_step(angle_deg=value),)) for value in (0.0, -0.0))
    assert json.dumps(plan_to_json(zero)) == json.dumps(plan_to_json(minus))


def test_failed_write_leaves_the_old_plan(tmp_path):
    path = tmp_path / "plan.json"
    write_plan(plan(), path)
    before = path.read_bytes()
    for place, change in (
        ("$.steps[0].angle_deg", {"steps": (stone_step(angle_deg=math.nan),)}),
        ("$.settings.a[1]", {"settings": {"a": [0, math.inf]}}),
        ("$.metrics.F_AV", {"metrics": replace(plan().metrics, F_AV=-math.inf)}),
        ("", {"working_scale": -1.0}),
    ):
        with pytest.raises(PlanError, match="E205") as caught:
            write_plan(plan(**change), path)
        assert place in caught.value.where
        assert path.read_bytes() == before
    (tmp_path / "taken").mkdir()
    for place in ("no folder/plan.json", "taken"):
        with pytest.raises(PlanError, match="E206"):
            write_plan(plan(), tmp_path / place)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plan.json", "taken"]


def bad(path, value):
    """The contents of a plan with one value replaced; `...` takes it out."""
    data = copy.deepcopy(plan_to_json(plan()))
    *parents, last = (int(name) if name.isdigit() else name for name in path.split("/"))
    at = data
    for name in parents:
        at = at[name]
    if value is ...:
        del at[last]
    else:
        at[last] = value
    return data


def test_plan_that_breaks_the_schema_is_refused_with_its_place_and_what_belongs_there():
    for path, value, place, cure in (
        ("steps/0/angel_deg", 12.0, "$.steps[0]", ""),
        ("steps/0/stone", 1.5, "$.steps[0].stone", ""),
        ("steps/0/side", "top", "$.steps[0].side", ""),
        ("steps/0/kind", ..., "$.steps[0]", ""),
        ("units/length", "m", "$.units.px_per_m", ""),
        ("units/px_per_m", 200.0, "$.units.px_per_m", ""),
        ("wall/width", 10**400, "$.wall.width", ""),
        ("metrics/F_SF", None, "$.metrics.F_SF", ""),
        ("seed", True, "$.seed", ""),
        ("seed", -1, "$.seed", ""),
        *(("steps/0/angle_deg", end, "$.steps[0].angle_deg", "") for end in (-180.5, 180.5)),
        ("steps/0/indices/SF", 1.1, "$.steps[0].indices.SF", ""),
        ("steps/0/indices/NHR", -1, "$.steps[0].indices.NHR", ""),
        ("steps/1/alpha_left", -0.1, "$.steps[1].alpha_left", ""),
        ("source/stones", 0, "$.source.stones", ""),
        ("method", ..., "$", "What belongs there: Name of the planning method"),
        ("steps/0/stone", ..., "$.steps[0]", "What belongs there: Id of a stone"),
        ("colour", 1.0, "$", "Known there: schema, version, method, "),
        ("steps/1/angle_deg", 1.0, "$.steps[1]", "Known there: step, kind, id, under, polygon, "),
    ):
        with pytest.raises(PlanError) as caught:
            plan_from_json(bad(path, value))
        error = caught.value
        assert (error.code, error.where) == ("E205", f"plan: {place}")
        assert error.what
        assert error.cure
        assert error.cure.startswith(cure)
        assert not cure or repr(path.rsplit("/", maxsplit=1)[-1]) in error.what
        assert len(str(error)) < 700


def test_what_the_contract_does_not_ask_for_may_be_missing():
    data = bad("steps/0/course_height", ...)
    del data["steps"][1]["alpha_left"], data["steps"][1]["alpha_right"]
    del data["metrics"]["T_LEVEL"], data["metrics"]["E_FLUSH"]
    data["steps"][0]["stone"] = 17.0
    found = plan_from_json(data)
    assert found.stone_steps[0].course_height is None
    assert type(found.stone_steps[0].stone) is int
    assert found.wedge_steps[0].alpha_left is None
    assert found.metrics.T_LEVEL is None


def test_file_that_is_no_plan_is_refused(tmp_path):
    path = tmp_path / "plan.json"
    start = '{"schema": "drystone-plan/1"'
    for text, code in (
        ("", "E203"),
        (b"\xff\xfe\x00", "E203"),
        (f'{start}, "seed": NaN}}', "E203"),
        (f'{start}, "schema": "drystone-plan/1"}}', "E203"),
        ("[" * 100_000, "E203"),
        (f'{start}, "seed": {"7" * 5000}}}', "E203"),
        ("{}", "E204"),
        ('{"schema": "drystone-plan/999"}', "E204"),
        (start + "}", "E205"),
        (f'{start}, "seed": 1e999}}', "E205"),
        (None, "E202"),
    ):
        path.unlink(missing_ok=True)
        if text is not None:
            path.write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(PlanError) as caught:
            read_plan(tmp_path if text is None else path)
        assert caught.value.code == code
        assert str(path) in caught.value.where


@cache
def planned(geometry="raster"):
    settings = greedy({"geometry": geometry})
    return ds.plan_wall(rubble(), 100, 36, scale=1.0, settings=settings, budget=1, px_per_m=100)


def planned_of(source):
    """A wall of few bricks that are read."""
    settings = greedy({"geometry": "raster"})
    return ds.plan_wall(ds.read_stones(source), 40, 20, settings=settings, budget=1)


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def test_files_of_an_earlier_plan_go_others_stay_and_no_folder_is_made_that_cannot_be(tmp_path):
    folder, photo, others = tmp_path / "out", tmp_path / "photo.jpg", tmp_path / "others"
    Image.fromarray(np.zeros((8, 8, 3), np.uint8)).save(photo)
    folder.mkdir()
    (folder / "mine.txt").write_text("mine")
    exact = planned("exact")
    source = {**exact.plan.source, **place_photo(photo, folder)[1]}
    ds.write_plan_folder(replace(exact, plan=replace(exact.plan, source=source)), str(folder))
    assert contents(folder).keys() > {"mine.txt", "blocks.json", "photo.jpg"}
    ds.write_plan_folder(planned(), folder)
    assert contents(folder).keys() == {"mine.txt", "plan.json", "settings.toml", "wall.png"}
    for place in (folder / "mine.txt", folder / "mine.txt" / "in"):
        with pytest.raises(ds.DrystoneError, match=r"E206 .*mine.txt"):
            ds.write_plan_folder(planned(), place)
    # No plan left these.
    mine = dict.fromkeys(("wall.tif", "blocks.json", "photo.jpg"), b"mine")
    others.mkdir()
    for name, data in mine.items():
        (others / name).write_bytes(data)
    ds.write_plan_folder(planned(), others)
    assert contents(others).items() > mine.items()


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


def test_what_python_wrote_is_read_again_and_stones_of_a_few_px_are_no_blended_ids(tmp_path):
    few = ds.generate.RubbleSettings(count=14)
    stones = ds.generate.rubble_stones(few, np.random.default_rng(3))
    settings = greedy({"geometry": "raster"})
    result = ds.plan_wall(stones, 200, 100, scale=0.12, settings=settings, budget=1)
    path = ds.write_plan_folder(result, tmp_path / "new" / "out")
    assert path == tmp_path / "new" / "out" / "plan.json"
    with pytest.raises(ds.DrystoneError, match="E101"):
        read_wall_image(path.with_name("wall.png"))
    wall = read_wall(path.parent)
    assert (wall.labels == result.wall.labels).all()
    assert (wall.plan, wall.blocks) == (result.plan, None)


def test_what_the_stones_were_read_from_is_never_replaced(tmp_path):
    masks = tmp_path / "masks"
    masks.mkdir()
    for name, stone in zip(("wall.png", "other.png"), bricks(4), strict=False):
        Image.fromarray(np.pad(stone.mask, 2)).save(masks / name)
    for source in (tmp_path / "wall.tif", tmp_path / "wall.png", masks):
        if source != masks:
            write_labels(ds.generate.lay_out(bricks(4)), source)
        place = masks if source == masks else tmp_path
        before = contents(place)
        with pytest.raises(ds.DrystoneError, match=r"E129 .*wall\.(tif|png)"):
            ds.write_plan_folder(planned_of(source), place)
        assert before == contents(place)
        if source != masks:
            source.unlink()


def test_stones_of_a_program_can_be_checked_with_a_file_of_them(tmp_path, capsys):
    labels = ds.generate.lay_out(bricks(4))
    ds.write_plan_folder(planned_of(labels), tmp_path / "out")
    assert main(["check", str(tmp_path / "out")]) == 3
    assert "E202" in (said := capsys.readouterr().err)
    assert "given by a program" in said
    for values, code in ((labels, 0), (np.flipud(labels), 5)):
        write_labels(values, tmp_path / "stones.png")
        words = ["check", str(tmp_path / "out"), "--stones", str(tmp_path / "stones.png")]
        assert main(words) == code
        if code == 0:
            assert "there is no file to compare bytes with" in capsys.readouterr().out


def built(scale=1.0, px_per_m=None):
    """Return a wall with a wedge, and its model at another friction than that of its plan."""
    wall = exact_example(scale, px_per_m).wall
    return wall, model_of_outlines(wall.outlines.blocks, 0.7, SETTINGS.settle.contact_px)


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
    for one, other in ((there.left, here.left), (there.right, here.right)):
        assert one.alpha == pytest.approx(other.alpha, abs=1e-9)
        assert other.success


def test_a_wall_of_pixels_and_an_empty_one_have_no_blocks():
    with pytest.raises(ValueError, match="are their pixels"):
        blocks_to_json(example().wall, built()[1])
    wall = Wall.empty(Site.from_source(40.0, 20.0, 0.5), exact=True)
    read = blocks_to_json(wall, model_of_outlines(wall.outlines.blocks, 0.58, 0.1))
    assert read == {"mu": 0.58, "px_per_m": None, "blocks": [], "interfaces": []}
    assert model_from_json(read).blocks == ()
