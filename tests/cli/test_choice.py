"""--pareto writes walls to choose from; the bound on F_SF is always printed."""

from pathlib import Path

import pytest

from drystone.io.plan_json import read_plan
from tests.cli.conftest import EXACT, UNTRIED, WALL

SEARCH = ("--wall", "70x30", "--scale", "1", "--budget", "3", "--seed", "1", *UNTRIED)


def test_walls_to_choose_from(rubble, tmp_path, run):
    out = tmp_path / "out"
    ran = run("plan", rubble, *SEARCH, "--pareto", "--json", "-o", out)
    assert ran.code in (0, 4)
    summary = ran.json()
    walls = summary["pareto"]
    assert len(walls) > 1
    assert [one["plan"] for one in walls] == [
        str(out / "pareto" / f"{k:02}" / "plan.json") for k in range(1, len(walls) + 1)
    ]
    assert (out / "pareto" / "01" / "plan.json").read_bytes() == (out / "plan.json").read_bytes()
    for one in walls:
        plan = read_plan(Path(one["plan"]))
        assert one["placed"] == len(plan.stone_steps)
        for name in ("F_SF", "F_AV", "F_AH", "F_LR"):
            assert one[name] == getattr(plan.metrics, name)
        assert run("check", one["plan"], "--stones", rubble).code == 0
    assert (out / "pareto.png").read_bytes().startswith(b"\x89PNG")

    # Fewer walls than before leave none of an earlier search.
    (out / "pareto" / "02" / "mine.txt").write_text("kept")
    few = run("plan", rubble, *EXACT, *UNTRIED, "--pareto", "--overwrite", "-o", out)
    header, row = few.out.splitlines()[-2:]
    assert header.split() == ["F_SF", "F_AV", "F_AH", "F_LR", "stones"]
    metrics = read_plan(out).metrics
    assert metrics.F_AV is not None
    assert row.split()[:3] == ["pareto/01", f"{metrics.F_SF:.3f}", f"{metrics.F_AV:.1f}"]
    assert sorted(p.name for p in (out / "pareto").iterdir()) == ["01", "02"]
    assert [p.name for p in (out / "pareto" / "02").iterdir()] == ["mine.txt"]
    # Walls to choose from do not outlive their search.
    (out / "pareto" / "02" / "mine.txt").unlink()
    assert run("plan", rubble, *WALL, "--overwrite", "-o", out).code in (0, 4)
    assert not (out / "pareto.png").exists()
    assert not (out / "pareto" / "01").exists()


@pytest.mark.parametrize(
    ("wall", "text"),
    [("70x30", "(the maximum for these stones is {:.3f})"), ("60x20", "(1 is a full wall)")],
)
def test_the_bound_is_printed(wall, text, rubble, tmp_path, run):
    options = ["--wall", wall, "--scale", "1", "--method", "paper", "--skip-too-large"]
    lines = run("plan", rubble, *options, "-o", tmp_path / "a").out.splitlines()
    (line,) = [line for line in lines if line.startswith("F_SF")]
    summary = run("plan", rubble, *options, "--json", "-o", tmp_path / "b").json()
    assert text.format(summary["F_SF_bound"]) in line
    assert summary["F_SF"] <= summary["F_SF_bound"]
