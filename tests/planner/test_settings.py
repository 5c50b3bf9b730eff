"""Settings: composed, checked, read from TOML, written to the plan."""

import json
import tomllib

import pytest
import tomli_w

from drystone.errors import UsageError
from drystone.planner.settings import METHODS, PlannerSettings, method_settings


@pytest.mark.parametrize("method", list(METHODS))
def test_settings_survive_toml_and_json(method):
    settings = method_settings(method)
    written = settings.as_dict()
    assert PlannerSettings().updated(tomllib.loads(tomli_w.dumps(written))) == settings
    assert PlannerSettings().updated(json.loads(json.dumps(written))) == settings


def test_missing_values_stay_as_they_are():
    settings = method_settings("best").updated({"mu": 0.65, "placement": {"tries": 3}})
    assert settings.mu == 0.65
    assert settings.placement.tries == 3
    assert settings.placement.rule == method_settings("best").placement.rule
    assert settings.updated({}) == settings


def test_an_int_is_a_float_where_one_is_wanted():
    settings = PlannerSettings().updated({"mu": 1, "stabilise": {"max_turn_deg": 20}})
    assert type(settings.mu) is float
    assert type(settings.stabilise.max_turn_deg) is float


@pytest.mark.parametrize(
    "changes",
    [
        {"two_sided": 1},
        {"placement": {"tries": True}},
        {"placement": {"tries": 2.0}},
        {"mu": True},
        {"mu": "0.58"},
        {"orientations": 10},
        {"placement": 3},
        {"stop": {"failures": "five"}},
        {"mu": 10**400},
        {"placement": {"tries": 10**5000}},
        {"search": {"pin": [2**63]}},
        {"mu": 0.0},
        {"stabilise": {"margin": 0.5}},
        {"clusters": {"distance": -1}},
    ],
)
def test_values_of_the_wrong_type_or_out_of_range_are_refused(changes):
    with pytest.raises(UsageError) as caught:
        PlannerSettings().updated(changes)
    assert caught.value.code == "E123"
    assert next(iter(changes)) in str(caught.value)
    assert caught.value.cure


@pytest.mark.parametrize(
    ("changes", "named", "cure"),
    [
        ({"xyz": 1}, "'xyz'", "sampling"),
        ({"placement": {"wonder": 1}}, "'placement.wonder'", "reach"),
        ({"sampling": "some"}, "sampling = 'some'", "twofold"),
        ({"stabilise": {"method": "glue"}}, "stabilise.method = 'glue'", "wedge"),
    ],
)
def test_unknown_settings_are_refused_with_the_known_ones(changes, named, cure):
    with pytest.raises(UsageError) as caught:
        PlannerSettings().updated(changes)
    assert caught.value.code == "E123"
    assert named in caught.value.what
    assert cure in caught.value.cure


def test_a_wrong_orientation_set_keeps_its_own_code():
    with pytest.raises(UsageError, match="E122"):
        PlannerSettings().updated({"orientations": "north"})


def test_an_unknown_method_is_refused_with_the_known_ones():
    with pytest.raises(UsageError, match=r"E124 --method: there is no method 'x'\. .*paper, best"):
        method_settings("x")
