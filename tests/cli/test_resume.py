"""An interrupt and the time limit keep what is built, and --resume goes on from there."""

from pathlib import Path

import pytest

from drystone.io.plan_json import read_plan
from drystone.planner.deadline import Deadline
from drystone.planner.events import Callbacks, Step
from tests.cli.conftest import WALL, Run
from tests.planner.scenes import after_looks


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


def limit(monkeypatch: pytest.MonkeyPatch, looks: int) -> None:
    """Let `--time` strike by how often the clock was looked at; what follows has time."""
    limits = iter([after_looks(looks)])
    monkeypatch.setattr(Deadline, "after", lambda *_: next(limits, Deadline()))


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_first_wall_that_the_time_limit_cuts_short_is_gone_on_with(
    jobs: int, rubble: Path, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = ("plan", rubble, "--wall", "100x36", "--scale", "1", "--seed", 1)
    timed = (*plan, "--time", "5", "--jobs", jobs, "-o", tmp_path / "part")
    placed: list[int] = []
    more: tuple[str, ...] = ()
    while True:
        limit(monkeypatch, 9)
        ran = run(*timed, *more)
        part = read_plan(tmp_path / "part")
        assert run("check", tmp_path / "part", "--stones", rubble).code == 0
        if "W128 the time limit struck after" not in ran.err:
            break
        assert part.stopped == "the time limit struck"
        placed.append(len(part.stone_steps))
        # By the rule for any wall: incomplete where its top is low.
        assert ran.code == (
            4 if "incomplete: the time limit struck; the top is at" in ran.out else 0
        )
        assert "--resume" in ran.err
        more = ("--resume",)
    assert len(placed) > 2
    assert placed == sorted(set(placed))
    assert ran.err.startswith(f"drystone: going on after {placed[-1]} stones")
    used = part.settings["search"]["budget"]
    assert run(*plan, "--budget", used, "-o", tmp_path / "whole").code == ran.code
    plans = [(tmp_path / name / "plan.json").read_bytes() for name in ("part", "whole")]
    assert plans[0] == plans[1]


def test_time_that_nobody_asked_for_does_not_cut_the_first_wall_short(
    rubble: Path, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = ("plan", rubble, "--wall", "100x36", "--scale", "1", "--seed", 1, "-o")
    limit(monkeypatch, 0)
    ran = run(*plan, tmp_path / "by default")
    assert "W128" not in ran.err
    assert run(*plan, tmp_path / "one", "--budget", 1).code == ran.code
    plans = [(tmp_path / name / "plan.json").read_bytes() for name in ("by default", "one")]
    assert plans[0] == plans[1]
