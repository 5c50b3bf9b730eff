"""What a plan says of itself: its settings, also when not all of them can be used."""

from dataclasses import replace

import pytest

from drystone.planner.settings import METHODS, PlannerSettings
from drystone.verify.lengths import plan_settings
from tests.verify.examples import example


def found(settings, method="best"):
    whole = METHODS.get(method, PlannerSettings()).as_dict() | settings
    return plan_settings(replace(example().plan, method=method, settings=whole))


@pytest.mark.parametrize("method", ["paper", "best"])
def test_a_setting_out_of_range_is_the_one_of_the_plans_method(method):
    settings, (problem,) = found({"mu": -3.0, "vary": 0.1}, method)
    assert settings == replace(METHODS[method], vary=0.1)
    assert problem.code == "E217"
    assert "mu must be in (0, 1e+06], not -3.0" in problem.message
    assert f"Used instead, of the method {method!r}: mu = 0.58." in problem.message
    assert problem.message.endswith("The others are those of the plan.")
    assert found({"mu": 0.6}, method) == (replace(METHODS[method], mu=0.6), [])
    # Of a method that is not known the default is used.
    settings, (problem,) = found({"orientations": "north"}, "custom")
    assert settings == PlannerSettings()
    assert "Used instead, the package's own: orientations = 'quarter'." in problem.message


def test_unknown_ones_are_left_out_and_wrong_groups_named():
    stop = {"filling": 0.9, "wonder": 1}
    settings, (problem,) = found({"wings": 2, "stop": stop, "score": 3})
    assert settings == METHODS["best"].updated({"stop": {"filling": 0.9}})
    assert "Used instead, of the method 'best': score. " in problem.message
    assert "Left out: stop.wonder, wings." in problem.message


def test_those_that_need_each_other_are_kept_in_any_order():
    policy = {"selection_rule": "towers", "search": {"budget": 1}, "mu": -1.0}
    settings, _ = found(policy)
    assert (settings.selection_rule, settings.search.budget) == ("towers", 1)


def test_what_a_plan_does_not_say_is_the_default_beside_a_bad_setting_too():
    plan = replace(example().plan, method="best", settings={"search": {"budget": 1}, "mu": -1.0})
    settings, _ = plan_settings(plan)
    assert settings == PlannerSettings().updated({"search": {"budget": 1}})
    assert settings.geometry != METHODS["best"].geometry
