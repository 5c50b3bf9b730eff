import copy
import json
import math
from dataclasses import replace

import jsonschema
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import PlanError
from drystone.io.plan_json import plan_from_json, plan_schema, plan_to_json, read_plan, write_plan
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from tests.strategies import repeatable

INDICES = {"SF": 0.9, "LFR": 1 / 3, "GDS": 0.5, "NHR": 0.1, "IWR": 0.2, "IS": -0.1, "LLC": 0.7}


def stone_step(**values):
    step = StoneStep(
        1, 17, 12.0, (30.25, 40.1), (100.0, 0.1 + 0.2), "left", 3, 1, INDICES, 21.5, None, None
    )
    return replace(step, **values)


def plan(**values):
    wedge = WedgeStep(2, 256, 17, ((1.0, 0.0), (3.0, 0.0), (3.0, 2.0)), 0.41, 0.39)
    whole = Plan(
        version="0.1.0",
        method="paper",
        seed=1,
        settings={"mu": 0.58, "stop": {"failures": 5, "filling": 0.99}},
        length_unit="px",
        px_per_m=None,
        working_scale=0.5,
        source={"path": "PR.png", "sha256": "5" * 64, "stones": 32, "width_px": 598,
                "height_px": 156},
        width=560.0,
        height=160.0,
        steps=(stone_step(), wedge),
        unused=(4,),
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
        plan(length_unit="m", px_per_m=437.25),
        plan(steps=(), unused=(), source=more, settings=settings),
    ):
        write_plan(one, path)
        assert read_plan(path) == one
        assert read_plan(tmp_path) == one
    assert [p.name for p in tmp_path.iterdir()] == ["plan.json"]


def test_keys_are_those_of_the_schema_in_its_order():
    data, schema = plan_to_json(plan()), plan_schema()
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
    other = plan(
        settings=dict(reversed([*one.settings.items()])),
        source=dict(reversed(list(one.source.items()))),
        steps=(stone_step(indices=dict(reversed(INDICES.items())), angle_deg=12), *one.steps[1:]),
        width=560,
        seed=np.int64(1),
    )
    assert one == other
    write_plan(one, tmp_path / "one.json")
    write_plan(other, tmp_path / "other.json")
    text = (tmp_path / "one.json").read_bytes()
    assert text == (tmp_path / "other.json").read_bytes()
    assert text.endswith(b"}\n")
    assert "größte".encode() in text
    zero, minus = (plan(steps=(stone_step(angle_deg=value),)) for value in (0.0, -0.0))
    assert json.dumps(plan_to_json(zero)) == json.dumps(plan_to_json(minus))


@repeatable(30)
@given(st.floats(-1e9, 1e9), st.floats(1e-9, 1e9))
def test_floats_keep_full_precision(angle_deg, width):
    one = plan(steps=(stone_step(angle_deg=angle_deg),), width=width)
    found = plan_from_json(json.loads(json.dumps(plan_to_json(one))))
    assert found == one


@pytest.mark.parametrize(
    ("place", "change"),
    [
        ("$.steps[0].angle_deg", {"steps": (stone_step(angle_deg=math.nan),)}),
        ("$.settings.a[1]", {"settings": {"a": [0, math.inf]}}),
        ("$.metrics.F_AV", {"metrics": replace(plan().metrics, F_AV=-math.inf)}),
    ],
)
def test_numbers_that_are_not_finite_are_never_written(tmp_path, place, change):
    path = tmp_path / "plan.json"
    with pytest.raises(PlanError, match="E205") as caught:
        write_plan(plan(**change), path)
    assert place in caught.value.where
    assert not path.exists()


def test_failed_write_leaves_the_old_plan(tmp_path):
    path = tmp_path / "plan.json"
    write_plan(plan(), path)
    before = path.read_bytes()
    with pytest.raises(PlanError, match="E205"):
        write_plan(plan(working_scale=-1.0), path)
    assert path.read_bytes() == before
    with pytest.raises(PlanError, match="E206"):
        write_plan(plan(), tmp_path / "no folder" / "plan.json")
    (tmp_path / "taken").mkdir()
    with pytest.raises(PlanError, match="E206"):
        write_plan(plan(), tmp_path / "taken")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plan.json", "taken"]


def bad(path, value):
    """The contents of a plan with one value replaced; `...` takes it out."""
    data = copy.deepcopy(plan_to_json(plan()))
    *parents, last = path.split("/")
    at = data
    for name in parents:
        at = at[int(name)] if isinstance(at, list) else at[name]
    key = int(last) if isinstance(at, list) else last
    if value is ...:
        del at[key]
    else:
        at[key] = value
    return data


@pytest.mark.parametrize(
    ("path", "value", "place"),
    [
        ("steps/0/angel_deg", 12.0, "$.steps[0]"),
        ("steps/0/stone", 1.5, "$.steps[0].stone"),
        ("steps/0/side", "top", "$.steps[0].side"),
        ("steps/0/kind", ..., "$.steps[0]"),
        ("units/length", "m", "$.units.px_per_m"),
        ("units/px_per_m", 200.0, "$.units.px_per_m"),
        ("wall/width", 10**400, "$.wall.width"),
        ("metrics/F_SF", None, "$.metrics.F_SF"),
        ("seed", True, "$.seed"),
    ],
)
def test_plan_that_breaks_the_schema_is_refused_with_its_place(path, value, place):
    with pytest.raises(PlanError) as caught:
        plan_from_json(bad(path, value))
    assert caught.value.code == "E205"
    assert caught.value.where == f"plan: {place}"
    assert caught.value.what
    assert caught.value.cure
    assert len(str(caught.value)) < 700


@pytest.mark.parametrize(
    ("path", "value", "cure"),
    [
        ("method", ..., "What belongs there: Name of the planning method"),
        ("steps/0/stone", ..., "What belongs there: Id of a stone"),
        ("colour", 1.0, "Known there: schema, version, method, "),
        ("steps/1/angle_deg", 1.0, "Known there: step, kind, id, under, polygon, "),
    ],
)
def test_what_is_missing_or_belongs_there_is_said(path, value, cure):
    with pytest.raises(PlanError) as caught:
        plan_from_json(bad(path, value))
    assert repr(path.rsplit("/", maxsplit=1)[-1]) in caught.value.what
    assert caught.value.cure.startswith(cure)


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


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "E203"),
        (b"\xff\xfe\x00", "E203"),
        ('{"schema": "drystone-plan/1", "seed": NaN}', "E203"),
        ('{"schema": "drystone-plan/1", "schema": "drystone-plan/1"}', "E203"),
        ("[" * 100_000, "E203"),
        ('{"schema": "drystone-plan/1", "seed": ' + "7" * 5000 + "}", "E203"),
        ("{}", "E204"),
        ('{"schema": "drystone-plan/999"}', "E204"),
        ('{"schema": "drystone-plan/1"}', "E205"),
        ('{"schema": "drystone-plan/1", "seed": 1e999}', "E205"),
    ],
)
def test_file_that_is_no_plan_is_refused(tmp_path, text, code):
    path = tmp_path / "plan.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(PlanError) as caught:
        read_plan(path)
    assert caught.value.code == code
    assert str(path) in caught.value.where
    path.unlink()
    with pytest.raises(PlanError, match="E202") as caught:
        read_plan(tmp_path)
    assert str(path) in caught.value.where


def test_schema_is_valid_and_describes_every_field():
    schema = plan_schema()
    jsonschema.Draft202012Validator.check_schema(schema)

    def undescribed(node, path):
        found = []
        for name, field in node.get("properties", {}).items():
            target = schema["$defs"][field["$ref"].split("/")[-1]] if "$ref" in field else field
            if "description" not in {**target, **field} and "const" not in field:
                found.append(f"{path}.{name}")
            found += undescribed(target, f"{path}.{name}")
        return found

    assert undescribed(schema, "$") == []
    for name, node in schema["$defs"].items():
        assert undescribed(node, name) == []
