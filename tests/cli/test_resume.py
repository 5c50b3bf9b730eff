"""An interrupt keeps what is built, and --resume goes on from there."""

from pathlib import Path

import pytest

from drystone.io.plan_json import read_plan
from drystone.planner.events import Callbacks, Step
from tests.cli.conftest import WALL, Run


@pytest.fixture
def interrupted(rubble: Path, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a plan that was interrupted after its third stone."""

    def interrupt(_: Callbacks, step: Step) -> None:
        if step.number == 3:
            raise KeyboardInterrupt

    folder = tmp_path / "partial"
    with monkeypatch.context() as patch:
        patch.setattr(Callbacks, "on_step", interrupt)
        ran = run("plan", rubble, *WALL, "--seed", 1, "-o", folder)
    assert ran.code == 130
    assert ran.out.startswith("interrupted: --resume goes on from here")
    return folder


def test_the_partial_plan_is_whole(interrupted: Path, rubble: Path, run: Run) -> None:
    plan = read_plan(interrupted)
    assert plan.stopped == "interrupted"
    assert len(plan.stone_steps) == 3
    assert len(plan.unused) == 5
    assert (interrupted / "report.html").exists()
    assert run("check", interrupted, "--stones", rubble).code == 0


def test_resume_gives_the_plan_that_no_interrupt_would_have_changed(
    interrupted: Path, finished: Path, rubble: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    count = len(read_plan(finished).stone_steps)
    assert count > 3
    told: list[int] = []
    monkeypatch.setattr(Callbacks, "on_step", lambda _, step: told.append(step.number))
    ran = run("plan", rubble, *WALL, "--seed", 1, "-o", interrupted, "--resume")
    assert ran.code in (0, 4)
    first, read, wrote = ran.err.splitlines()
    assert first == "drystone: going on after 3 stones"
    assert (read.split()[1], wrote.split()[1]) == ("Read", "wrote")
    for name in ("plan.json", "wall.png", "settings.toml", "picture.png"):
        assert (interrupted / name).read_bytes() == (finished / name).read_bytes()
    assert told == list(range(4, count + 1))  # the first three were not planned again


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--seed", "2"], "--seed"),
        (["--sampling", "full"], "settings"),
        (["--wall", "110x36"], "--wall"),
        (["--wall", "100x37"], "--wall"),
        (["--scale", ".9"], "--scale"),
        (["--px-per-m", "100"], "--px-per-m"),
    ],
)
def test_resume_refuses_another_command(
    options: list[str], said: str, interrupted: Path, rubble: Path, run: Run
) -> None:
    before = (interrupted / "plan.json").read_bytes()
    ran = run("plan", rubble, *WALL, "--seed", 1, "-o", interrupted, "--resume", *options)
    assert ran.code == 2
    assert "E136" in ran.err
    assert said in ran.err
    assert (interrupted / "plan.json").read_bytes() == before


def test_resume_refuses_other_stones(interrupted: Path, bricks: Path, run: Run) -> None:
    ran = run("plan", bricks, *WALL, "--seed", 1, "-o", interrupted, "--resume")
    assert ran.code == 2
    assert "E136" in ran.err
    assert "other stones" in ran.err


def test_resume_without_a_plan_starts(
    rubble: Path, finished: Path, tmp_path: Path, run: Run
) -> None:
    folder = tmp_path / "new"
    assert run("plan", rubble, *WALL, "--seed", 1, "-o", folder, "--resume").code in (0, 4)
    assert (folder / "plan.json").read_bytes() == (finished / "plan.json").read_bytes()


def test_a_finished_plan_is_left_as_it_is(rubble: Path, tmp_path: Path, run: Run) -> None:
    plan = ["plan", rubble, *WALL, "-o", tmp_path / "out"]
    first = run(*plan)
    assert first.code in (0, 4)
    before = {p.name: p.read_bytes() for p in (tmp_path / "out").iterdir()}
    ran = run(*plan, "--resume")
    assert ran.code == first.code
    assert "finished" in ran.err
    assert "going on" not in ran.err
    told = run(*plan, "--resume", "--json").json()
    assert (told["status"], told["shortfall"], told["seconds"]) == ("finished", None, None)
    assert told["placed"] == len(read_plan(tmp_path / "out").stone_steps)
    assert {p.name: p.read_bytes() for p in (tmp_path / "out").iterdir()} == before


def test_a_finished_wall_that_is_incomplete_stays_so(
    bricks: Path, tmp_path: Path, run: Run
) -> None:
    plan = ("plan", bricks, "--wall", "80x60", "--scale", "1", "--method", "paper")
    for code, more in ((4, ()), (0, ("--wall", "60x20"))):
        asked = (*plan, *more, "-o", tmp_path / str(code))
        first, again = run(*asked), run(*asked, "--resume")
        assert (first.code, again.code) == (code, code)
        assert ("incomplete: the top is at" in again.err) == (code == 4)
        assert run(*asked, "--resume", "--json").code == code


def test_a_search_goes_on_from_an_interrupted_first_wall(
    rubble: Path, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a first wall that was interrupted no search is recorded, whatever was asked for."""

    def interrupt(_: Callbacks, step: Step) -> None:
        if step.number == 3:
            raise KeyboardInterrupt

    plan = ("plan", rubble, "--wall", "100x36", "--scale", "1", "--seed", 1, "--budget", 3)
    with monkeypatch.context() as patch:
        patch.setattr(Callbacks, "on_step", interrupt)
        assert run(*plan, "-o", tmp_path / "part").code == 130
    whole = run(*plan, "-o", tmp_path / "whole")
    ran = run(*plan, "-o", tmp_path / "part", "--resume")
    assert ran.code == whole.code
    plans = [(tmp_path / name / "plan.json").read_bytes() for name in ("part", "whole")]
    assert plans[0] == plans[1]
