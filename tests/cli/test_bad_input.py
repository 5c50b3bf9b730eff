"""Bad input gives a coded error with the place and the cure, exit code 3, and nothing written."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.cli.conftest import WALL, Run


@pytest.fixture
def inputs(tmp_path: Path, rubble: Path) -> Path:
    """A folder of things that are no stones, walls or plans."""
    folder = tmp_path / "inputs"
    (folder / "empty").mkdir(parents=True)
    with Image.open(rubble) as picture:
        pixels = np.asarray(picture)
    Image.fromarray((pixels * 30).astype(np.uint8)).save(folder / "labels.jpg")
    (folder / "other.json").write_text('{"a": 1}', encoding="utf-8")
    (folder / "list.json").write_text("[1, 2]", encoding="utf-8")
    (folder / "cut.json").write_text('{"schema": "drystone-', encoding="utf-8")
    (folder / "old.json").write_text('{"schema": "drystone-plan/0"}', encoding="utf-8")
    (folder / "bytes.json").write_bytes(b"\xff\xfe\x00")
    (folder / "deep.json").write_text("[" * 100_000, encoding="utf-8")
    (folder / "text.png").write_text("no picture", encoding="utf-8")
    blocks = {"blocks_xywh": [[0, 0, 2, 2], [1, 1, 2, 2]]}
    (folder / "overlap.json").write_text(json.dumps(blocks), encoding="utf-8")
    return folder


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
def test_numbers_of_a_plan_that_none_can_have(
    path: tuple[str | int, ...], value: object, code: str, plan_copy: Path, run: Run
) -> None:
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


def test_friction_from_which_forces_would_overflow(run: Run, plan_copy: Path) -> None:
    ran = run("measure", plan_copy, "--mu", "1e308")
    assert (ran.code, ran.err.startswith("drystone: E302 mu")) == (3, True)


@pytest.mark.parametrize("command", ["stones", "measure", "segment", "check", "plan"])
def test_pipes_are_not_waited_for(command: str, tmp_path: Path, run: Run, rubble: Path) -> None:
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


@pytest.mark.parametrize(
    ("command", "name", "code"),
    [
        ("plan", "nowhere.png", "E100"),
        ("plan", "empty", "E111"),
        ("plan", "labels.jpg", "E101"),
        ("plan", "text.png", "E107"),
        ("stones", "nowhere.png", "E100"),
        ("stones", "empty", "E111"),
        ("analyse", "nowhere.png", "E100"),
        ("analyse", "nowhere.json", "E132"),
        ("analyse", "empty", "E132"),
        ("analyse", "cut.json", "E132"),
        ("analyse", "bytes.json", "E132"),
        ("analyse", "deep.json", "E132"),
        ("measure", "deep.json", "E132"),
        ("analyse", "other.json", "E204"),
        ("analyse", "list.json", "E204"),
        ("analyse", "overlap.json", "E304"),
        ("analyse", "labels.jpg", "E101"),
        ("measure", "text.png", "E107"),
        ("measure", "other.json", "E204"),
        ("check", "nowhere.json", "E202"),
        ("check", "empty", "E202"),
        ("check", "cut.json", "E203"),
        ("check", "bytes.json", "E203"),
        ("check", "other.json", "E204"),
        ("check", "list.json", "E204"),
        ("check", "old.json", "E204"),
        ("check", "overlap.json", "E204"),
        ("check", "text.png", "E203"),
    ],
)
def test_bad_input(
    command: str, name: str, code: str, inputs: Path, tmp_path: Path, run: Run
) -> None:
    out = tmp_path / "out"
    options = [*WALL, "-o", out] if command == "plan" else []
    ran = run(command, inputs / name, *options)
    assert (ran.code, ran.out) == (3, "")
    assert ran.err.startswith(f"drystone: {code} ")
    assert Path(name).stem in ran.err or code == "E304"
    assert ran.err.count("\n") == 1
    assert ran.err.rstrip().endswith((".", ")", "?"))
    assert not out.exists()


@pytest.mark.parametrize("command", ["check", "measure", "analyse", "craft", "export"])
@pytest.mark.parametrize("made", ["plan_copy", "settled_copy"])
def test_a_byte_order_mark_is_no_fault(
    command: str, made: str, tmp_path: Path, run: Run, request: pytest.FixtureRequest
) -> None:
    plan: Path = request.getfixturevalue(made)
    for path in plan.glob("*.json"):
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    more = ("--to", "csv", "-o", tmp_path / "out") if command == "export" else ()
    ran = run(command, plan, *more)
    assert ran.code == 0, ran.err


def test_stones_that_are_not_there_are_not_a_failed_check(plan_copy: Path, run: Run) -> None:
    ran = run("check", plan_copy, "--stones", plan_copy / "nowhere.png")
    assert ran.code == 3
    assert "E100" in ran.err
