"""How long is searched, and for what."""

from drystone.cli.parser import build_parser
from drystone.cli.settings import limited, settings_from
from drystone.io.plan_json import read_plan
from drystone.planner.search_settings import UNLIMITED
from tests.cli.conftest import EXACT


def asked(*options, stones=30):
    """Time limit and budget of a plan."""
    words = ["plan", "stones.png", "--wall", "100x36", "-o", "out", *map(str, options)]
    arguments = build_parser().parse_args(words)
    settings, seconds = limited(settings_from(arguments), stones, arguments)
    return seconds, settings.search.budget


def test_a_budget_ends_a_search_unless_the_clock_shall(tmp_path):
    assert asked() == (600.0, 32)
    assert asked(stones=64) == (640.0, 20)
    assert asked(stones=5000) == (50_000.0, 8)
    assert asked("--time", 2.5) == (2.5, UNLIMITED)
    assert asked("--budget", 7) == (None, 7)
    assert asked("--budget", 7, "--time", 2.5) == (2.5, 7)
    assert asked("--method", "paper") == asked("--geometry", "raster") == (None, 1)
    assert asked("--method", "paper", "--time", 2) == (2.0, 1)
    assert asked("--policy", "random") == (None, 1)
    toml = tmp_path / "settings.toml"
    toml.write_text("mu = 0.6\n", encoding="utf-8")
    assert asked("--settings", toml) == (600.0, 32)
    toml.write_text("mu = 0.6\n[search]\npasses = 3\n", encoding="utf-8")
    assert asked("--settings", toml) == (600.0, 32)
    toml.write_text("[search]\nbudget = 5\n", encoding="utf-8")
    assert asked("--settings", toml) == (None, 5)
    assert asked("--settings", toml, "--time", 3) == (3.0, UNLIMITED)


def test_aims_are_settings(rubble, tmp_path, run):
    out = tmp_path / "out"
    options = (*EXACT[:-1], 2, "--aim", "F_LR=.5", "F_AH=2")
    assert run("plan", rubble, *options, "-o", out).code in (0, 4)
    goal = read_plan(out).settings["goal"]
    assert (goal["F_LR"], goal["F_AH"], goal["F_SF"]) == (0.5, 2.0, 0.0)


def test_walls_to_choose_from_do_not_outlive_their_search(rubble, tmp_path, run):
    out = tmp_path / "out"
    assert run("plan", rubble, *EXACT[:-1], 3, "--pareto", "-o", out).code in (0, 4)
    assert (out / "pareto.png").exists()
    assert (out / "pareto" / "01" / "plan.json").exists()
    assert run("plan", rubble, *EXACT, "-o", out, "--overwrite").code in (0, 4)
    assert not (out / "pareto.png").exists()
    assert not (out / "pareto").exists()
