"""The walk-throughs of examples/ run as they are written, with small stone sets."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

# A minute together on a machine that does nothing else; some machines do.
pytestmark = pytest.mark.timeout(900)

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(script, tmp_path):
    """Run a script where nothing of the checkout is in the way; return what it prints."""
    ran = subprocess.run(  # noqa: S603 - a script of this repository
        [sys.executable, str(EXAMPLES / script)],
        cwd=tmp_path,
        env=os.environ | {"TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert list(tmp_path.iterdir()) == []
    return ran.stdout


def test_robot(tmp_path):
    said = run("robot.py", tmp_path)
    assert "drystone: Read 10 stones (largest 30.3 x 10.0 cm" in said
    assert "wrote to out: plan.json report.html wall.png" in said
    assert "build.gif" in said
    for written in ("assembly.compas.json", "scene.yaml", "wall.obj", "urdf/"):
        assert written in said
    assert '"drystone-poses/' in said
    loop = said.split("# the live loop")[1].split("live loop in Python")[0]
    assert loop.count("  stands\n") >= 7
    assert "does not stand" not in loop
    assert "broke: planned on without it" in loop
    assert "--ban 5 -o without/" in said


def test_researcher(tmp_path):
    for extra in ("spyrrow", "gymnasium"):
        pytest.importorskip(extra, reason="an extra that the script is about")
    said = run("researcher.py", tmp_path)
    assert "mine: --policy of public suites: a policy of another package that is installed" in said
    assert "spyrrow is a yardstick" in said
    for name in ("paper", "random", "filter", "spyrrow", "mine"):
        assert f"\n   bricks 2:1  {name}" in said
    assert "runs.csv" in said
    assert "stones, F_SF " in said
    assert "actions, return " in said


def test_engineer(tmp_path):
    said = run("engineer.py", tmp_path)
    first, closed = said.split("$ drystone analyse")[1:3]
    assert "W305" in first
    assert "does not stand" in first
    assert "own weight           stands" in closed
    assert "m wide" in closed
    assert "analysis/report.html to look around in" in closed
    assert "scatter" in said
    assert "point loads" in said
