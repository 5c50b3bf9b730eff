"""What the reader is told on the command line reaches it, and the plan remembers it."""

import json

import numpy as np
import pytest

from drystone.cli import main


@pytest.fixture
def on_white(tmp_path):
    """Four bricks on a background of 255."""
    labels = np.full((40, 120), 255, np.uint16)
    for number in range(4):
        labels[10:20, 5 + 28 * number : 25 + 28 * number] = number + 1
    path = tmp_path / "white.npy"
    np.save(path, labels)
    return path


def test_background_and_skip_are_read_and_remembered(on_white, tmp_path, capsys):
    plan = ["plan", str(on_white), "--wall", "60x20", "--method", "paper", "--scale", "1"]
    assert main([*plan, "-o", str(tmp_path / "no")]) == 3
    assert "background" in capsys.readouterr().err
    told = [*plan, "-o", str(tmp_path / "out"), "--background", "255", "--skip", "2", "--skip", "4"]
    assert main(told) in (0, 4)
    source = json.loads((tmp_path / "out" / "plan.json").read_text())["source"]
    assert source["reading"] == {"background": 255, "skip": [2, 4]}
    assert source["stones"] == 2
    assert main(["check", str(tmp_path / "out"), "--stones", str(on_white)]) == 0


def test_stones_takes_the_same_options(on_white, capsys):
    assert main(["stones", str(on_white), "--background", "255", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["stones"] == 4
