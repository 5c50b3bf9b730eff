"""The walk-throughs of examples/ run as they are written, with small stone sets."""

import runpy
import subprocess
import sys
import tempfile
from contextlib import chdir
from pathlib import Path

import pytest

from drystone.cli import main
from tests.cli.conftest import coarse

# Some machines do much else.
pytestmark = pytest.mark.timeout(900)

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def walked(tmp_path, monkeypatch, capfd):
    """Run a script and return what it prints.

    Commands are called in this process but for `bench`, which must find a package of the script.
    """

    def called(command, *, cwd, **more):
        if command[1:3] != ["-m", "drystone"] or command[3] == "bench":
            return in_a_process(command, cwd=cwd, **more)
        shown = capfd.readouterr().out
        with chdir(cwd), coarse():
            code = main(command[3:])
        told = capfd.readouterr()
        sys.stdout.write(shown)
        return subprocess.CompletedProcess(command, code, told.out, told.err)

    def walk(script):
        monkeypatch.setattr(sys, "argv", [script])
        runpy.run_path(str(EXAMPLES / script), run_name="__main__")
        assert list(tmp_path.iterdir()) == []
        return capfd.readouterr().out

    in_a_process = subprocess.run
    monkeypatch.syspath_prepend(EXAMPLES)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(subprocess, "run", called)
    yield walk
    for name in ("walk", "mine"):
        sys.modules.pop(name, None)


def test_robot(walked):
    said = walked("robot.py")
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


def test_researcher(walked):
    for extra in ("spyrrow", "gymnasium"):
        pytest.importorskip(extra, reason="an extra that the script is about")
    said = walked("researcher.py")
    assert "mine: --policy of public suites: a policy of another package that is installed" in said
    assert "spyrrow is a yardstick" in said
    for name in ("paper", "random", "filter", "spyrrow", "mine"):
        assert f"\n   bricks 2:1  {name}" in said
    assert "runs.csv" in said
    assert "stones, F_SF " in said
    assert "actions, return " in said


def test_engineer(walked):
    said = walked("engineer.py")
    first, closed = said.split("$ drystone analyse")[1:3]
    assert "W305" in first
    assert "does not stand" in first
    assert "own weight           stands" in closed
    assert "m wide" in closed
    assert "analysis/report.html to look around in" in closed
    assert "scatter" in said
    assert "point loads" in said
