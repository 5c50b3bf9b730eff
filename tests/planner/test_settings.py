"""Settings: composed, checked, read from TOML, written to the plan, varied from wall to wall."""

import json
import math
import tomllib
from dataclasses import fields

import numpy as np
import pytest
import tomli_w

from drystone.errors import UsageError
from drystone.planner.settings import METHODS, PlannerSettings, method_settings
from drystone.planner.vary import varied
from drystone.selection.scored import ScoreSettings
from tests.planner.scenes import greedy, of_rubble, same


@pytest.mark.parametrize("changes", [{}, {"ban": [3], "pin": [1, 2]}])
@pytest.mark.parametrize("method", list(METHODS))
def test_settings_survive_toml_and_json(method, changes):
    settings = method_settings(method).updated(changes)
    written = settings.as_dict()
    assert PlannerSettings().updated(tomllib.loads(tomli_w.dumps(written))) == settings
    assert PlannerSettings().updated(json.loads(json.dumps(written))) == settings


def test_what_is_not_said_stays_and_an_int_is_a_float_where_one_is_wanted():
    settings = method_settings("best").updated({"mu": 1, "placement": {"tries": 3}})
    assert (settings.mu, type(settings.mu)) == (1.0, float)
    assert settings.placement.tries == 3
    assert settings.placement.rule == method_settings("best").placement.rule
    assert settings.updated({}) == settings


@pytest.mark.parametrize(
    "changes",
    [
        *({"pin": value} for value in (7, [1.5], [True], ["7"], {"a": 1})),
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
        ({"pin": [1, 3], "ban": [3, 4]}, "the same stones: 3.", "pin or ban"),
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


WEIGHTS = [field.name for field in fields(ScoreSettings) if field.name != "analysed"]


def test_every_weight_gets_its_own_factor_and_nothing_else_changes():
    settings = method_settings("best")
    new = varied(settings, 0.3, np.random.default_rng(5))
    rng = np.random.default_rng(5)
    for name in WEIGHTS:
        factor = math.exp(0.3 * rng.normal())
        assert getattr(new.score, name) == getattr(settings.score, name) * factor
    assert new.vary == 0.0
    assert new.score.analysed == settings.score.analysed
    unvaried = {"score": settings.as_dict()["score"], "vary": settings.vary}
    assert new.updated(unvaried) == settings


def test_another_seed_gives_another_wall():
    varying, plain = (
        [of_rubble(greedy({"vary": vary}), seed=seed) for seed in (1, 2)] for vary in (0.3, 0.0)
    )
    assert not same(*varying)
    assert same(*plain)  # without it nothing is random here
