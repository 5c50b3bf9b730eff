"""What is kept while a plan is made: when, what for, and what a full disk does to it."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from drystone.cli import keeping
from drystone.cli.keeping import EVERY_S, SHARE, Keeper
from drystone.errors import PlanError
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.plan_json import read_plan
from drystone.planner.events import Callbacks
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import SoFar, plan_wall
from drystone.search.state import Progress, SearchState
from tests.cli.conftest import UNTRIED, WALL
from tests.planner.scenes import greedy, rubble

SEARCH = ("--wall", "70x30", "--scale", "1", "--seed", "1", "--budget", "3", *UNTRIED)


class Clock:
    """Goes on when it is told to."""

    now = 0.0

    def __call__(self):
        return self.now


def progress(walls, merit):
    state = None if walls == 1 else SearchState(0, None, ())
    best = cast(Any, SimpleNamespace(merit=merit))
    return Progress(walls, best, cast(Any, None), (), state)


def so_far(one):
    return SoFar(one, lambda: cast(PlanResult, one))


@pytest.fixture
def kept(monkeypatch):
    """What is written, and nothing is."""
    written = []
    monkeypatch.setattr(Keeper, "_keep_plan", lambda *_: written.append("plan"))
    monkeypatch.setattr(keeping, "write_checkpoint", lambda *_: written.append("search"))
    return written


def test_plans_are_kept_when_they_are_better_and_seldom(kept, tmp_path):
    clock = Clock()
    keeper = Keeper(tmp_path, {}, None, clock)
    keeper.begin(None)
    assert kept == ["search"]

    def after(seconds, one):
        clock.now += seconds
        kept.clear()
        keeper(so_far(one))
        return list(kept)

    assert after(0.0, None) == []
    assert after(EVERY_S, None) == ["search", "plan"]
    # A first wall that is whole does not wait.
    assert after(0.1, None) == []
    assert after(0.1, progress(1, 1.0)) == ["search", "plan"]
    assert after(0.1, progress(2, 2.0)) == []
    assert after(EVERY_S, progress(3, 2.0)) == ["search", "plan"]
    assert after(0.1, progress(4, 2.0)) == []
    # Walls that are no better are progress of the search all the same.
    assert after(EVERY_S, progress(5, 2.0)) == ["search"]
    assert after(EVERY_S, replace(progress(5, 1.0), state=None)) == []
    assert after(0.1, progress(6, 3.0)) == ["search", "plan"]


def test_what_takes_long_is_kept_less_often(kept, tmp_path, monkeypatch):
    clock, seconds = Clock(), 2.0 * EVERY_S * SHARE

    def slow(*_):
        clock.now += seconds
        kept.append("plan")

    monkeypatch.setattr(Keeper, "_keep_plan", slow)
    keeper = Keeper(tmp_path, {}, None, clock)
    keeper(so_far(progress(1, 1.0)))
    kept.clear()
    for walls in range(2, 22):
        clock.now += 0.1 * EVERY_S
        keeper(so_far(progress(walls, float(walls))))
    assert kept == ["search", "search", "plan"]


def test_a_full_disk_ends_no_search_and_is_told_once(rubble, tmp_path, run, monkeypatch):
    whole = run("plan", rubble, *SEARCH, "-o", tmp_path / "whole")
    calls = []

    def full(*_):
        calls.append(_)
        raise PlanError("E206", "the file cannot be written (No space left on device).")

    monkeypatch.setattr(keeping, "EVERY_S", 0.0)
    monkeypatch.setattr(keeping, "SHARE", 1.0)
    monkeypatch.setattr(Keeper, "_keep_plan", full)
    ran = run("plan", rubble, *SEARCH, "-o", tmp_path / "full")
    assert len(calls) > 1
    assert ran.code == whole.code
    assert (ran.err.count("W130"), "No space left" in ran.err) == (1, True)
    plans = [(tmp_path / name / "plan.json").read_bytes() for name in ("full", "whole")]
    assert plans[0] == plans[1]


@pytest.mark.parametrize(
    ("place", "more"),
    [
        ("drystone.cli.planning.write_plan_folder", ()),
        ("drystone.drawing.write_pictures", ("--json",)),
    ],
)
def test_the_card_of_a_wall_that_cannot_be_written_is_printed(
    place, more, rubble, tmp_path, run, monkeypatch
):
    def full(*_, **__):
        raise OSError(28, "No space left on device", "picture.png")

    plan = ("plan", rubble, *WALL, "-o", tmp_path / "out", *more)
    with monkeypatch.context() as patch:
        patch.setattr(place, full)
        ran = run(*plan)
    assert ran.code == 3
    assert "E206 picture.png: the file cannot be written (No space left on device)." in ran.err
    assert "F_LR_coulomb" in ran.out
    assert "wrote" not in ran.err
    # The end was not written to its end, so it is not finished.
    assert (tmp_path / "out" / CHECKPOINT).exists()
    assert run(*plan, "--resume").code in (0, 4)
    assert not (tmp_path / "out" / CHECKPOINT).exists()
    assert (tmp_path / "out" / "report.html").exists()


class Killed(BaseException):
    """As a signal that nobody can catch."""


def killed_at(walls):
    def on_walls(_, found):
        if found.walls >= walls:
            raise Killed

    return on_walls


def test_pictures_of_an_earlier_plan_do_not_stay_beside_another(rubble, tmp_path, run, monkeypatch):
    plan = ("plan", rubble, *SEARCH, "-o", tmp_path)
    assert run(*plan, "--pareto").code in (0, 4)
    (tmp_path / "mine.txt").write_text("mine")
    monkeypatch.setattr(Callbacks, "on_walls", killed_at(2))
    with pytest.raises(Killed):
        run(*plan, "--overwrite", "--seed", "5")
    assert (read_plan(tmp_path).seed, read_plan(tmp_path).stopped) == (5, "interrupted")
    assert {path.name for path in tmp_path.iterdir()} == {
        "plan.json", "settings.toml", "wall.png", "blocks.json", CHECKPOINT, "mine.txt",
    }  # fmt: skip
    assert run("check", tmp_path, "--stones", rubble).code == 0


def test_the_photograph_is_beside_what_is_kept_too(tmp_path):
    photo, folder = tmp_path / "photo.jpg", tmp_path / "out"
    photo.write_bytes(b"a photograph")
    folder.mkdir()
    keeper = Keeper(folder, {}, photo)
    keeper.begin(None)
    changes = {"search": {"budget": 2}, "settle": {"trials": 0}, "goal": {"fallen": 0.0}}
    plan_wall(rubble(), 100, 36, scale=1.0, settings=greedy(changes), keep=keeper)
    assert (folder / "photo.jpg").read_bytes() == b"a photograph"
    assert read_plan(folder).source["photo"]["name"] == "photo.jpg"
