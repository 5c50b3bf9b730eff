"""Every method option gives a plan that holds."""

import argparse
from pathlib import Path

import pytest
import tomli_w

from drystone.cli.parser import build_parser
from drystone.cli.settings import recorded_method, settings_from
from drystone.io.plan_json import read_plan
from drystone.planner.settings import METHODS
from tests.cli.conftest import WALL, Run


@pytest.mark.parametrize(
    ("options", "path", "value"),
    [
        (["--sampling", "variant"], ["sampling"], "variant"),
        (["--sampling", "uniform"], ["sampling"], "uniform"),
        (["--sampling", "twofold"], ["sampling"], "twofold"),
        (["--sampling", "full"], ["sampling"], "full"),
        (["--placement", "eq12"], ["placement", "rule"], "eq12"),
        (["--placement", "lowest"], ["placement", "rule"], "lowest"),
        (["--placement", "snug"], ["placement", "rule"], "snug"),
        (["--reach", "above"], ["placement", "reach"], "above"),
        (["--stabilise", "rotation"], ["stabilise", "method"], "rotation"),
        (["--stabilise", "wedge"], ["stabilise", "method"], "wedge"),
        (["--stabilise", "none"], ["stabilise", "method"], "none"),
        (["--orientations", "quarter"], ["orientations"], "quarter"),
        (["--orientations", "45deg"], ["orientations"], "45deg"),
        (["--two-sided"], ["two_sided"], True),
        (["--one-sided"], ["two_sided"], False),
        (["--mu", ".7"], ["mu"], 0.7),
        (["--geometry", "raster"], ["two_sided"], False),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_plan_with_this_option_holds(
    options: list[str], path: list[str], value: object, rubble: Path, tmp_path: Path, run: Run
) -> None:
    assert run("plan", rubble, *WALL, *options, "-o", tmp_path / "out").code in (0, 4)
    plan = read_plan(tmp_path / "out")
    setting: object = plan.settings
    for name in path:
        assert isinstance(setting, dict)
        setting = setting[name]
    assert setting == value
    assert plan.stone_steps
    checked = run("check", tmp_path / "out", "--stones", rubble, "--json").json()
    assert (checked["ok"], checked["problems"]) == (True, [])


def test_one_sided_and_stabilise_none_mean_it(rubble: Path, tmp_path: Path, run: Run) -> None:
    run("plan", rubble, *WALL, "--stabilise", "none", "--one-sided", "-o", tmp_path / "out")
    plan = read_plan(tmp_path / "out")
    assert {step.side for step in plan.stone_steps} == {"left"}
    assert not plan.wedge_steps
    assert {step.rotation_moves for step in plan.stone_steps} == {0}


def test_two_sided_uses_both_sides(rubble: Path, tmp_path: Path, run: Run) -> None:
    run("plan", rubble, *WALL, "--two-sided", "-o", tmp_path / "out")
    assert {step.side for step in read_plan(tmp_path / "out").stone_steps} == {"left", "right"}


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (["--orientations", "north"], "E122"),
        (["--orientations", "0deg"], "E122"),
        (["--method", "wurst"], "E124"),
        (["--mu", "-1"], "E123"),
        (["--mu", "nan"], "E123"),
    ],
)
def test_wrong_values(
    options: list[str], code: str, rubble: Path, tmp_path: Path, run: Run
) -> None:
    ran = run("plan", rubble, *WALL, *options, "-o", tmp_path / "out")
    assert ran.code == 2
    assert code in ran.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--mu", "-1"], "E123 --mu: mu must be in (0, 1e+06], not -1.0. Change mu."),
        (
            ["--ban", "2", "3", "--pin", "3"],
            "E123 --ban and --pin: ban and pin name the same stones: 3. Change ban or pin.",
        ),
        (["--orientations", "north"], "E122 --orientations: 'north' is no set of orientations."),
    ],
)
def test_wrong_values_are_blamed_on_their_option(
    options: list[str], said: str, rubble: Path, tmp_path: Path, run: Run
) -> None:
    ran = run("plan", rubble, *WALL, *options, "-o", tmp_path / "out")
    assert ran.code == 2
    assert said in ran.err


@pytest.mark.parametrize(
    ("text", "where", "said"),
    [
        ("mu = -1.0", "", "E123 {}: mu must be in (0, 1e+06], not -1.0. Change mu."),
        ("wonder = 1", "", "E123 {}: there is no setting 'wonder'."),
        ("[stop]\nfilling = 2.0", " [stop]", "E123 {}: filling must be in (0, 1]"),
        ("[stop]\nfailures = 'five'", "", "E123 {}: stop.failures = 'five' has the wrong type."),
        ("orientations = 'north'", "", "E122 {}: 'north' is no set of orientations."),
        ("mu = 1e308", "", "E123 {}: mu must be a finite number up to 1e12"),
        ("mu = 1e7", "", "E123 {}: mu must be in (0, 1e+06], not 10000000.0. Change mu."),
    ],
)
def test_wrong_values_of_a_file_are_blamed_on_the_file(
    text: str, where: str, said: str, rubble: Path, tmp_path: Path, run: Run
) -> None:
    toml = tmp_path / "mine.toml"
    toml.write_text(text, encoding="utf-8")
    ran = run("plan", rubble, *WALL, "--settings", toml, "-o", tmp_path / "out")
    assert ran.code == 2
    assert said.format(f"{toml}{where}") in ran.err


def test_a_file_that_is_not_there_says_what_to_give(rubble: Path, tmp_path: Path, run: Run) -> None:
    ran = run("plan", rubble, *WALL, "--settings", tmp_path / "none.toml", "-o", tmp_path / "out")
    assert (ran.code, "E128" in ran.err) == (3, True)
    assert "Give a TOML file, such as the settings.toml" in ran.err


def test_a_settings_file_may_have_a_byte_order_mark_but_no_abyss(
    rubble: Path, tmp_path: Path, run: Run
) -> None:
    toml = tmp_path / "mine.toml"
    asked = ("plan", rubble, *WALL, "--settings", toml, "-o", tmp_path / "out")
    for text in ("[" * 100_000, "7" * 5000, "[" * 900 + "]" * 900, "0.5 #" + " " * 1_000_000):
        toml.write_text(f"mu = {text}", encoding="utf-8")
        ran = run(*asked)
        assert (ran.code, ran.err.count("\n")) == (3, 1)
        assert ran.err.startswith("drystone: E128")
    toml.write_text("mu = 0.5\n", encoding="utf-8-sig")
    assert run(*asked).code in (0, 4)


def parsed(*options: object) -> argparse.Namespace:
    """A command line of `plan` with some options."""
    words = ["plan", "stones.png", "--wall", "100x36", "-o", "out", *map(str, options)]
    return build_parser().parse_args(words)


def test_what_is_said_of_single_stones_wins_over_the_file(tmp_path: Path) -> None:
    toml = tmp_path / "mine.toml"
    toml.write_text("ban = [3]\npin = [4]\n", encoding="utf-8")
    settings = settings_from(parsed("--settings", toml, "--ban", 4, "--pin", 3))
    assert (settings.ban, settings.pin) == ((4,), (3,))


@pytest.mark.parametrize("method", ["paper", "best"])
def test_a_whole_file_of_the_other_method_is_neither(method: str, tmp_path: Path) -> None:
    whole, part = tmp_path / "settings.toml", tmp_path / "mine.toml"
    changed = METHODS[method].updated({"mu": 0.6, "skip_too_large": True}).as_dict()
    whole.write_bytes(tomli_w.dumps(changed).encode())
    part.write_text("mu = 0.6\n[search]\nbudget = 3\n", encoding="utf-8")
    named = {
        (path.name, asked): recorded_method(parsed("--settings", path, "--method", asked))
        for path in (whole, part)
        for asked in METHODS
    }
    other = {"paper": "best", "best": "paper"}[method]
    assert named == {
        ("settings.toml", method): method,
        ("settings.toml", other): "custom",
        ("mine.toml", "paper"): "paper",
        ("mine.toml", "best"): "best",
    }
    assert recorded_method(parsed("--method", method)) == method


def test_a_plan_by_a_whole_file_of_another_method_says_so(
    finished: Path, rubble: Path, tmp_path: Path, run: Run
) -> None:
    asked = ("--wall", "100x36", "--scale", "1", "--settings", finished / "settings.toml")
    ran = run("plan", rubble, *asked, "--method", "best", "-o", tmp_path / "out")
    assert ran.code in (0, 4)
    assert "so that nothing of --method best is left; the plan names the method custom" in ran.err
    assert read_plan(tmp_path / "out").method == "custom"
    again = run("plan", rubble, *asked, "--method", "best", "-o", tmp_path / "out", "--resume")
    assert "E136" not in again.err


def test_a_search_on_pixels_is_refused(rubble: Path, tmp_path: Path, run: Run) -> None:
    ran = run("plan", rubble, *WALL, "--budget", 3, "-o", tmp_path / "out")
    assert (ran.code, "E123 --budget: better walls are looked for on outlines" in ran.err) == (
        2,
        True,
    )


@pytest.mark.parametrize(
    ("options", "useless"),
    [
        (["--placement", "snug"], "--placement"),
        (["--reach", "any", "--geometry", "exact"], "--reach"),
        (["--geometry", "raster", "--settle", "pivot"], "--settle"),
        (["--method", "paper", "--settle", "energy"], "--settle"),
    ],
)
def test_options_that_would_do_nothing_are_refused(
    rubble: Path, tmp_path: Path, run: Run, options: list[str], useless: str
) -> None:
    ran = run("plan", rubble, "--wall", "100x36", "-o", tmp_path / "out", *options)
    assert ran.code == 2
    assert "E138" in ran.err
    assert f"{useless} would do nothing" in ran.err
