"""Options of a plan are settings: of its method, how long is searched, and for what."""

import json
from operator import attrgetter

import pytest
import tomli_w

from drystone.cli.parser import build_parser
from drystone.cli.settings import limited, recorded_method, settings_from
from drystone.errors import UsageError
from drystone.io.plan_json import read_plan
from drystone.planner.search_settings import UNLIMITED
from drystone.planner.settings import METHODS, method_settings
from tests.cli.conftest import WALL


def parsed(*options):
    """A command line of `plan` with some options."""
    words = ["plan", "stones.png", "--wall", "70x30", "-o", "out", *map(str, options)]
    return build_parser().parse_args(words)


def settings_of(*options):
    return settings_from(parsed(*options))


def test_an_option_is_a_setting():
    for options, path, value in (
        ("--sampling uniform", "sampling", "uniform"),
        ("--method paper --placement lowest", "placement.rule", "lowest"),
        ("--method paper --reach above", "placement.reach", "above"),
        ("--stabilise rotation", "stabilise.method", "rotation"),
        ("--settle pivot", "settle.method", "pivot"),
        ("--budget 2 --aim F_LR=.5 F_AH=2", "goal.F_LR", 0.5),
        ("--budget 2 --aim F_LR=.5 F_AH=2", "goal.F_AH", 2.0),
        ("--orientations 45deg", "orientations", "45deg"),
        ("--two-sided", "two_sided", True),
        ("--one-sided", "two_sided", False),
        ("--mu .7", "mu", 0.7),
        ("--fixed-order", "order", "given"),
        ("--ban 2 --ban 5 2", "ban", (2, 5)),
        ("--pin 7", "pin", (7,)),
    ):
        assert attrgetter(path)(settings_of(*options.split())) == value, options


@pytest.fixture
def toml(tmp_path):
    def written(text):
        # A byte order mark is no fault.
        (tmp_path / "mine.toml").write_text(text, encoding="utf-8-sig")
        return "--settings", tmp_path / "mine.toml"

    return written


def test_any_setting_can_be_set_by_its_name_and_options_win_over_the_file(toml):
    file = toml("mu = 0.4\n[settle]\nmethod = 'energy'\n")
    given = ("--set", "mu=.7", "--set", "settle.method=pivot", "--set", "ban=[3, 4]")
    settings = settings_of(*file, *given, "--set", "search.budget=3")
    assert (settings.mu, settings.settle.method, settings.ban) == (0.7, "pivot", (3, 4))
    assert settings.search.budget == 3  # the clock does not end this search
    assert settings_of(*file, "--set", "mu=.7", "--mu", ".6").mu == 0.6
    # Two that only make sense together.
    raster = settings_of("--set", "search.budget=1", "--set", "geometry=raster")
    assert (raster.geometry, raster.search.budget) == ("raster", 1)
    for wrong in ("settle.metod=pivot", "mu=high", "mu=[1"):
        with pytest.raises(UsageError, match=r"E123 --set: .*drystone settings"):
            settings_of("--set", wrong)
    settings = settings_of(*toml("ban = [3]\npin = [4]\n"), "--ban", 4, "--pin", 3)
    assert (settings.ban, settings.pin) == ((4,), (3,))
    file = toml("selection_rule = 'lowest'\n[search]\nbudget = 1\n")
    assert settings_of(*file).selection_rule == "lowest"
    assert settings_of(*file, "--policy", "filter").selection_rule == "filter"


def test_a_whole_file_of_the_other_method_is_neither(finished, rubble, tmp_path, toml, run):
    whole = tmp_path / "settings.toml"
    changed = METHODS["paper"].updated({"mu": 0.6, "skip_too_large": True}).as_dict()
    whole.write_bytes(tomli_w.dumps(changed).encode())
    part = toml("mu = 0.6\n[search]\nbudget = 3\n")
    for given, asked, named in (
        ((), "best", "best"),
        (("--settings", whole), "paper", "paper"),
        (("--settings", whole), "best", "custom"),
        (part, "paper", "paper"),
        (part, "best", "best"),
    ):
        assert recorded_method(parsed(*given, "--method", asked)) == named
    # Such a plan says so.
    asked = ("plan", rubble, *WALL[:4], "--settings", finished / "settings.toml")
    ran = run(*asked, "--method", "best", "-o", tmp_path / "out")
    assert ran.code in (0, 4)
    assert "so that nothing of --method best is left; the plan names the method custom" in ran.err
    assert read_plan(tmp_path / "out").method == "custom"
    again = run(*asked, "--method", "best", "-o", tmp_path / "out", "--resume")
    assert "E136" not in again.err


def test_a_budget_ends_a_search_unless_the_clock_shall(toml):
    def limits(*options, stones=30):
        """Time limit and budget of a plan."""
        arguments = parsed(*options)
        settings, seconds = limited(settings_from(arguments), stones, arguments)
        return seconds, settings.search.budget

    assert limits() == (600.0, 32)
    assert limits(stones=64) == (640.0, 20)
    assert limits(stones=5000) == (50_000.0, 8)
    assert limits("--time", 2.5) == (2.5, UNLIMITED)
    assert limits("--budget", 7) == (None, 7)
    assert limits("--budget", 7, "--time", 2.5) == (2.5, 7)
    assert limits("--method", "paper") == limits("--geometry", "raster") == (None, 1)
    assert limits("--method", "paper", "--time", 2) == (2.0, 1)
    assert limits("--policy", "random") == (None, 1)
    for more in ("", "[search]\npasses = 3\n"):
        assert limits(*toml(f"mu = 0.6\n{more}")) == (600.0, 32)
    file = toml("[search]\nbudget = 5\n")
    assert limits(*file) == (None, 5)
    assert limits(*file, "--time", 3) == (3.0, UNLIMITED)


@pytest.mark.parametrize("method", ["best", "paper"])
@pytest.mark.parametrize("more", [(), ("--budget", 1)])
def test_a_policy_is_a_single_pass(method, more):
    for name, rule in (("paper", "algorithm2"), ("towers", "towers")):
        settings = settings_of("--policy", name, "--method", method, *more)
        assert (settings.selection_rule, settings.search.budget) == (rule, 1)
        assert settings.geometry == method_settings(method).geometry


def test_a_plan_repeats_from_its_settings(run, rubble, tmp_path, toml):
    one, two = tmp_path / "one", tmp_path / "two"
    given = ("--policy", "filter", *toml("[policy]\nmin_filling = 0.6\n"))
    again = ("--settings", one / "settings.toml", "--jobs", "2")
    for folder, more in ((one, given), (two, again)):
        ran = run("plan", rubble, *WALL, *more, "--seed", "4", "-o", folder)
        assert ran.code in (0, 4)
    assert run("check", one, "--stones", rubble).code == 0
    plans = [(folder / "plan.json").read_bytes() for folder in (one, two)]
    assert plans[0] == plans[1]
    settings = json.loads(plans[0])["settings"]
    assert (settings["selection_rule"], settings["policy"]["min_filling"]) == ("filter", 0.6)
