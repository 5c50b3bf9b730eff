"""`drystone plan --policy`."""

import json

import pytest

from drystone.cli.parser import build_parser
from drystone.cli.settings import settings_from
from drystone.planner.settings import method_settings

SIZE = ("--wall", "100x36", "--scale", "1", "--geometry", "raster", "--quiet")


def asked(*options):
    """Settings of a plan."""
    words = ["plan", "stones.png", "--wall", "100x36", "-o", "out", *map(str, options)]
    return settings_from(build_parser().parse_args(words))


@pytest.mark.parametrize("method", ["best", "paper"])
@pytest.mark.parametrize(
    ("name", "rule"), [("paper", "algorithm2"), ("random", "random"), ("towers", "towers")]
)
def test_a_policy_is_a_single_pass(name, rule, method):
    for more in ((), ("--budget", 1)):
        settings = asked("--policy", name, "--method", method, *more)
        assert (settings.selection_rule, settings.search.budget) == (rule, 1)
        assert settings.geometry == method_settings(method).geometry


def test_those_of_a_settings_file_too(tmp_path):
    toml = tmp_path / "settings.toml"
    toml.write_text("selection_rule = 'lowest'\n[search]\nbudget = 1\n", encoding="utf-8")
    assert asked("--settings", toml).selection_rule == "lowest"
    assert asked("--settings", toml, "--policy", "filter").selection_rule == "filter"


def test_a_plan_repeats_from_its_settings(run, rubble, tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    toml = tmp_path / "given.toml"
    toml.write_text("[policy]\nmin_filling = 0.6\n", encoding="utf-8")
    given = ("--policy", "filter", "--settings", toml, "--seed", "4")
    assert run("plan", rubble, *SIZE, *given, "-o", one).code in (0, 4)
    assert run("check", one, "--stones", rubble).code == 0
    again = ("--settings", one / "settings.toml", "--seed", "4", "--jobs", "2")
    assert run("plan", rubble, *SIZE, *again, "-o", two).code in (0, 4)
    plans = [(folder / "plan.json").read_bytes() for folder in (one, two)]
    assert plans[0] == plans[1]
    settings = json.loads(plans[0])["settings"]
    assert (settings["selection_rule"], settings["policy"]["min_filling"]) == ("filter", 0.6)
