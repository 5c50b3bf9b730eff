"""Bad input gives a coded error with the place and the cure, exit code 3, and nothing written."""

import json
import os

import pytest

from tests.cli.conftest import WALL


@pytest.mark.parametrize(
    ("path", "value", "code"),
    [
        (("wall", "width"), 1e308, "E205"),
        (("wall", "width"), 1e9, "E121"),
        (("steps", 0, "centroid"), [1e308, 1e308], "E205"),
        (("settings", "mu"), "x", "E205"),
        (("settings", "mu"), 1e308, "E205"),
        (("settings", "settle"), 3, "E205"),
        (("metrics", "F_SF"), 1e308, "E205"),
        (("stopped",), ["deep"], "E132"),
    ],
)
def test_numbers_of_a_plan_that_none_can_have(path, value, code, plan_copy, run):
    plan = json.loads((plan_copy / "plan.json").read_text())
    at = plan
    for name in path[:-1]:
        at = at[name]
    at[path[-1]] = value
    text = json.dumps(plan).replace('["deep"]', "[" * 900 + "]" * 900)
    (plan_copy / "plan.json").write_text(text)
    ran = run("measure", plan_copy)
    assert (ran.code, ran.out) == (2 if code == "E121" else 3, "")
    assert ran.err.startswith(f"drystone: {code} ")
    checked = run("check", plan_copy, "--stones", plan_copy / "rubble.png")
    assert checked.err.startswith(f"drystone: {'E203' if code == 'E132' else 'E2'}")
    assert "Warning" not in ran.err + checked.err


@pytest.mark.parametrize("command", ["stones", "measure", "segment", "check", "plan"])
def test_pipes_are_not_waited_for(command, tmp_path, run, rubble):
    pipe = tmp_path / "pipe.png"
    os.mkfifo(pipe)
    given = [*WALL, "-o", tmp_path / "out"] if command == "plan" else []
    if command == "segment":
        given = ["-o", tmp_path / "out"]
    ran = run(command, pipe, *given)
    assert (ran.code, ran.out) == (3, "")
    assert "it is a pipe, and no regular file" in ran.err
    if command == "plan":
        ran = run(command, rubble, *given, "--settings", pipe)
        assert (ran.code, "E128" in ran.err) == (3, True)


def test_a_byte_order_mark_is_no_fault(settled_copy, run):
    for path in settled_copy.glob("*.json"):
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    for command in ("check", "measure"):
        ran = run(command, settled_copy)
        assert ran.code == 0, ran.err
