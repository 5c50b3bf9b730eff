"""What `--json` prints is what docs/plan-format.md lists."""

import re
from pathlib import Path

import pytest

from drystone.model.plan import PlanMetrics
from tests.cli.conftest import WALL

PAGE = Path(__file__).parents[2] / "docs" / "plan-format.md"
NOT_KEYS = {"raster", "exact", "null", "answers"}
"""Values, and a word for keys of both directions."""


def listed(command):
    """Names in the row of a command; options are none."""
    (row,) = re.findall(rf"^\| `{command} --json`.*$", PAGE.read_text("utf-8"), re.MULTILINE)
    return {name for name in re.findall(r"`(\w+)`", row.split("|", 2)[2]) if name not in NOT_KEYS}


def keys(report, *within):
    """Names at the top and in some of the objects."""
    return set(report).union(*(report[name] for name in within))


@pytest.mark.parametrize("command", ["stones", "measure", "craft"])
def test_of_what_looks(command, rubble, finished, run):
    given = rubble if command == "stones" else finished
    assert set(run(command, given, "--json").json()) == listed(command)


def test_of_rehearse(settled, run):
    report = run("rehearse", settled, "--json", "--runs", 2).json()
    found = keys(report, "errors").union(*report["stones"], ("runs", "low", "median", "high"))
    assert found == listed("rehearse")


def test_of_plan(rubble, tmp_path, run):
    asked = ("plan", rubble, *WALL, "-o", tmp_path / "out", "--json", "--profile", "--pareto")
    report = run(*asked).json()
    metrics = set(PlanMetrics.__dataclass_fields__)  # "the metrics" on the page
    found = keys(report, "profile").union(*report["pareto"])
    assert found - metrics == listed("plan") - metrics
    assert metrics - found == {"alpha_left_coulomb", "alpha_right_coulomb"}


def test_of_check(plan_copy, tmp_path, run):
    pytest.importorskip("pymunk")
    report = run("check", plan_copy, "--json", "--physics", "--picture", tmp_path / "x.png").json()
    assert keys(report, "physics") == listed("check")


def test_of_analyse(finished, run):
    plain = run("analyse", finished, "--json").json()
    one_way = run("analyse", finished, "--json", "--load", "gravity").json()
    found = keys(plain, "certificate") | keys(one_way, "certificate") | {"scatter"}
    found |= {"gaps", "chosen_px", "stands_from_px", "steady", "tried"}
    assert found == listed("analyse")
