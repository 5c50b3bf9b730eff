"""Every method option gives a plan that holds."""

from pathlib import Path

import pytest

from drystone.io.plan_json import read_plan
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
