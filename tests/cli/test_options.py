"""Options of a plan are settings: of its method, how long is searched, and for what."""

import json

import pytest
import tomli_w

from drystone.cli.parser import build_parser
from drystone.cli.settings import limited, recorded_method, settings_from
from drystone.errors import UsageError
from drystone.io.plan_json import read_plan
from drystone.planner.search_settings import UNLIMITED
from drystone.planner.settings import METHODS, method_settings
from tests.cli.conftest import WALL


@pytest.mark.parametrize(("options", "path", "value"), [
    (["--sampling", "uniform"], "sampling", "uniform"),
    (["--method", "paper", "--placement", "lowest"], "placement.rule", "lowest"),
    (["--method", "paper", "--reach", "above"], "placement.reach", "above"),
    (["--stabilise", "rotation"], "stabilise.method", "rotation"),
    (["--settle", "pivot"], "settle.method", "pivot"),
    (["--budget", "2", "--aim", "F_LR=.5", "F_AH=2"], "goal.F_LR", 0.5),
    (["--budget", "2", "--aim", "F_LR=.5", "F_AH=2"], "goal.F_AH", 2.0),
    (["--orientations", "45deg"], "orientations", "45deg"),
    (["--two-sided"], "two_sided", True), (["--one-sided"], "two_sided", False),
    (["--mu", ".7"], "mu", 0.7), (["--fixed-order"], "order", "given"),
    (["--ban", "2", "--ban", "5", "2"], "ban", [2, 5]), (["--pin", "7"], "pin", [7]),
], ids=str)  # fmt: skip
def test_an_option_is_a_setting(options, path, value):
    setting = settings_from(parsed(*options)).as_dict()
    for name in path.split("."):
        assert isinstance(setting, dict)
        setting = setting[name]
    assert (list(setting) if isinstance(value, list) else setting) == value


def parsed(*options):
    """A command line of `plan` with some options."""
    words = ["plan", "stones.png", "--wall", "70x30", "-o", "out", *map(str, options)]
    return build_parser().parse_args(words)


def settings_of(*options):
    return settings_from(parsed(*options))


def limits(*options, stones=30):
    """Time limit and budget of a plan."""
    arguments = parsed(*options)
    settings, seconds = limited(settings_from(arguments), stones, arguments)
    return seconds, settings.search.budget


def test_what_is_said_of_single_stones_wins_over_the_file(tmp_path):
    toml = tmp_path / "mine.toml"
    toml.write_text("ban = [3]\npin = [4]\n", encoding="utf-8")
    settings = settings_of("--settings", toml, "--ban", 4, "--pin", 3)
    assert (settings.ban, settings.pin) == ((4,), (3,))


def test_any_setting_can_be_set_by_its_name(tmp_path):
    toml = tmp_path / "mine.toml"
    # A byte order mark is no fault.
    toml.write_text("mu = 0.4\n[settle]\nmethod = 'energy'\n", encoding="utf-8-sig")
    given = ("--set", "mu=.7", "--set", "settle.method=pivot", "--set", "ban=[3, 4]")
    settings = settings_of("--settings", toml, *given, "--set", "search.budget=3")
    assert (settings.mu, settings.settle.method, settings.ban) == (0.7, "pivot", (3, 4))
    assert settings.search.budget == 3  # the clock does not end this search
    assert settings_of("--settings", toml, "--set", "mu=.7", "--mu", ".6").mu == 0.6
    # Two that only make sense together.
    raster = settings_of("--set", "search.budget=1", "--set", "geometry=raster")
    assert (raster.geometry, raster.search.budget) == ("raster", 1)
    for wrong, code in (("settle.metod=pivot", "E123"), ("mu=high", "E123"), ("mu=[1", "E123")):
        with pytest.raises(UsageError, match=f"{code} --set: .*drystone settings"):
            settings_of("--set", wrong)


def test_a_whole_file_of_the_other_method_is_neither(tmp_path):
    whole, part = tmp_path / "settings.toml", tmp_path / "mine.toml"
    changed = METHODS["paper"].updated({"mu": 0.6, "skip_too_large": True}).as_dict()
    whole.write_bytes(tomli_w.dumps(changed).encode())
    part.write_text("mu = 0.6\n[search]\nbudget = 3\n", encoding="utf-8")
    for given, asked, named in (
        ((), "best", "best"),
        (("--settings", whole), "paper", "paper"),
        (("--settings", whole), "best", "custom"),
        (("--settings", part), "paper", "paper"),
        (("--settings", part), "best", "best"),
    ):
        assert recorded_method(parsed(*given, "--method", asked)) == named


def test_a_plan_by_a_whole_file_of_another_method_says_so(finished, rubble, tmp_path, run):
    asked = ("--wall", "70x30", "--scale", "1", "--settings", finished / "settings.toml")
    ran = run("plan", rubble, *asked, "--method", "best", "-o", tmp_path / "out")
    assert ran.code in (0, 4)
    assert "so that nothing of --method best is left; the plan names the method custom" in ran.err
    assert read_plan(tmp_path / "out").method == "custom"
    again = run("plan", rubble, *asked, "--method", "best", "-o", tmp_path / "out", "--resume")
    assert "E136" not in again.err


def test_a_budget_ends_a_search_unless_the_clock_shall(tmp_path):
    assert limits() == (600.0, 32)
    assert limits(stones=64) == (640.0, 20)
    assert limits(stones=5000) == (50_000.0, 8)
    assert limits("--time", 2.5) == (2.5, UNLIMITED)
    assert limits("--budget", 7) == (None, 7)
    assert limits("--budget", 7, "--time", 2.5) == (2.5, 7)
    assert limits("--method", "paper") == limits("--geometry", "raster") == (None, 1)
    assert limits("--method", "paper", "--time", 2) == (2.0, 1)
    assert limits("--policy", "random") == (None, 1)
    toml = tmp_path / "settings.toml"
    toml.write_text("mu = 0.6\n", encoding="utf-8")
    assert limits("--settings", toml) == (600.0, 32)
    toml.write_text("mu = 0.6\n[search]\npasses = 3\n", encoding="utf-8")
    assert limits("--settings", toml) == (600.0, 32)
    toml.write_text("[search]\nbudget = 5\n", encoding="utf-8")
    assert limits("--settings", toml) == (None, 5)
    assert limits("--settings", toml, "--time", 3) == (3.0, UNLIMITED)


@pytest.mark.parametrize("method", ["best", "paper"])
@pytest.mark.parametrize(
    ("name", "rule"), [("paper", "algorithm2"), ("random", "random"), ("towers", "towers")]
)
def test_a_policy_is_a_single_pass(name, rule, method):
    for more in ((), ("--budget", 1)):
        settings = settings_of("--policy", name, "--method", method, *more)
        assert (settings.selection_rule, settings.search.budget) == (rule, 1)
        assert settings.geometry == method_settings(method).geometry


def test_a_policy_wins_over_that_of_the_file(tmp_path):
    toml = tmp_path / "settings.toml"
    toml.write_text("selection_rule = 'lowest'\n[search]\nbudget = 1\n", encoding="utf-8")
    assert settings_of("--settings", toml).selection_rule == "lowest"
    assert settings_of("--settings", toml, "--policy", "filter").selection_rule == "filter"


def test_a_plan_repeats_from_its_settings(run, rubble, tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    toml = tmp_path / "given.toml"
    toml.write_text("[policy]\nmin_filling = 0.6\n", encoding="utf-8")
    given = ("--policy", "filter", "--settings", toml, "--seed", "4")
    assert run("plan", rubble, *WALL, *given, "-o", one).code in (0, 4)
    assert run("check", one, "--stones", rubble).code == 0
    again = ("--settings", one / "settings.toml", "--seed", "4", "--jobs", "2")
    assert run("plan", rubble, *WALL, *again, "-o", two).code in (0, 4)
    plans = [(folder / "plan.json").read_bytes() for folder in (one, two)]
    assert plans[0] == plans[1]
    settings = json.loads(plans[0])["settings"]
    assert (settings["selection_rule"], settings["policy"]["min_filling"]) == ("filter", 0.6)
