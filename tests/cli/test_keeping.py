"""What is kept while a plan is made, and how `--resume` goes on from it."""

import json
import shutil
import signal
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from drystone.cli import keeping
from drystone.cli.keeping import EVERY_S, SHARE, Keeper
from drystone.errors import PlanError
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.folder_lock import LOCK, locked
from drystone.io.plan_json import read_plan
from drystone.planner.deadline import Deadline
from drystone.planner.events import Callbacks
from drystone.search.plan_result import PlanResult
from drystone.search.plan_wall import SoFar, plan_wall
from drystone.search.state import Progress, SearchState
from tests.cli.conftest import SIZE, UNTRIED, WALL, contents, plan_into, rewrite
from tests.planner.scenes import after_looks, greedy, rubble


def so_far(walls, merit=1.0, **more):
    """A search after some walls, of which the best has this merit."""
    state = None if walls == 1 else SearchState("", 0, None, ())
    best = cast(Any, SimpleNamespace(merit=merit))
    one = replace(Progress(walls, best, cast(Any, None), (), state), **more)
    return SoFar(one, lambda: cast(PlanResult, one))


def test_plans_are_kept_when_they_are_better_and_seldom(tmp_path, monkeypatch):
    now, kept = 0.0, []
    monkeypatch.setattr(Keeper, "_keep_plan", lambda *_: kept.append("plan"))
    monkeypatch.setattr(keeping, "write_checkpoint", lambda *_: kept.append("search"))
    keeper = Keeper(tmp_path, {}, None, lambda: now)
    keeper.begin(None)
    assert kept == ["search"]
    nothing = SoFar(None, lambda: cast(PlanResult, None))
    for seconds, one, written in (
        (0.0, nothing, []),
        (EVERY_S, nothing, ["search", "plan"]),
        # A first wall that is whole does not wait.
        (0.1, nothing, []),
        (0.1, so_far(1), ["search", "plan"]),
        (0.1, so_far(2, 2.0), []),
        (EVERY_S, so_far(3, 2.0), ["search", "plan"]),
        (0.1, so_far(4, 2.0), []),
        # Walls that are no better are progress of the search all the same.
        (EVERY_S, so_far(5, 2.0), ["search"]),
        (EVERY_S, so_far(5, state=None), []),
        (0.1, so_far(6, 3.0), ["search", "plan"]),
    ):
        now += seconds
        kept.clear()
        keeper(one)
        assert kept == written

    def slow(*_):
        nonlocal now
        now += 2.0 * EVERY_S * SHARE
        kept.append("plan")

    # What takes long is kept less often.
    monkeypatch.setattr(Keeper, "_keep_plan", slow)
    keeper = Keeper(tmp_path, {}, None, lambda: now)
    keeper(so_far(1))
    kept.clear()
    for walls in range(2, 22):
        now += 0.1 * EVERY_S
        keeper(so_far(walls, float(walls)))
    assert kept == ["search", "search", "plan"]


@pytest.mark.parametrize(
    ("place", "more"),
    [("drystone.cli.planning.write_plan_folder", ()),
     ("drystone.drawing.write_pictures", ("--json",))],
)  # fmt: skip
def test_a_wall_that_cannot_be_written_is_printed(place, more, rubble, tmp_path, run, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device", "picture.png")

    plan = ("plan", rubble, *WALL, "-o", tmp_path, *more)
    with monkeypatch.context() as patch:
        patch.setattr(place, full)
        ran = run(*plan)
    assert (ran.code, "F_LR_coulomb" in ran.out, "wrote" in ran.err) == (3, True, False)
    assert "E206 picture.png: the file cannot be written (No space left on device)." in ran.err
    # The end was not written to its end, so it is not finished.
    assert (tmp_path / CHECKPOINT).exists()
    assert run(*plan, "--resume").code in (0, 4)
    assert not (tmp_path / CHECKPOINT).exists()
    assert (tmp_path / "report.html").exists()


class Killed(BaseException):
    """As a signal that nobody can catch."""


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


def test_resume_gives_the_plan_without_an_interrupt(finished, rubble, tmp_path, run, monkeypatch):
    told, count = [], len(read_plan(finished).stone_steps)
    plan = ("plan", rubble, *WALL, "--seed", 1, "-o", tmp_path)

    def on_step(_, step):
        told.append(step.number)
        if told == [1, 2, 3]:
            raise KeyboardInterrupt

    monkeypatch.setattr(Callbacks, "on_step", on_step)
    ran = run(*plan)
    assert ran.code == 130
    assert ran.out.startswith("interrupted: --resume goes on from here")
    part = read_plan(tmp_path)
    assert (part.stopped, len(part.stone_steps), len(part.unused)) == ("interrupted", 3, 3)
    assert (tmp_path / "report.html").exists()
    assert run("check", tmp_path, "--stones", rubble).code == 0
    ran = run(*plan, "--resume")
    assert ran.code in (0, 4)
    first, read, wrote = ran.err.splitlines()
    assert first == "drystone: going on after 3 stones"
    assert (read.split()[1], wrote.split()[1]) == ("Read", "wrote")
    for name in ("plan.json", "wall.png", "settings.toml", "picture.png"):
        assert (tmp_path / name).read_bytes() == (finished / name).read_bytes()
    # The first three were not planned again.
    assert told == [*range(1, count + 1)] > [1, 2, 3]


def test_a_finished_plan_is_left_as_it_is(finished, standing, rubble, bricks, tmp_path, run):
    for code, stones, given, wall in (
        (4, rubble, finished, WALL),
        (0, bricks, standing, ("--wall", "60x20", *WALL[2:])),
    ):
        out = shutil.copytree(given, tmp_path / given.parent.name)
        before = contents(out)
        asked = ("plan", stones, *wall, "--seed", 1, "-o", out, "--resume")
        again, as_json = run(*asked), run(*asked, "--json")
        assert (again.code, as_json.code, "finished" in again.err) == (code, code, True)
        assert ("incomplete: the top is at" in again.err) == (code == 4)
        told = as_json.json()
        assert (told["status"], told["shortfall"], told["seconds"]) == ("finished", None, None)
        assert told["placed"] == len(read_plan(out).stone_steps)
        assert contents(out) == before


def limit(monkeypatch, looks):
    """Let `--time` strike by how often the clock was looked at; what follows has time."""
    limits = iter([after_looks(looks)])
    monkeypatch.setattr(Deadline, "after", lambda *_: next(limits, Deadline()))


def test_a_first_wall_that_is_cut_short_is_gone_on_with(
    settled, rubble, tmp_path, run, monkeypatch
):
    part, whole, bare = (tmp_path / name for name in ("part", "whole", "bare"))
    asked = ("plan", rubble, "--wall", SIZE, "--scale", "1", "--seed", 1)
    timed, placed = (*asked, *UNTRIED, "--time", "5", "-o", part), []
    while True:
        limit(monkeypatch, 9)
        ran, plan = run(*timed, *(["--resume"] if placed else [])), read_plan(part)
        if "W128 the time limit struck after" not in ran.err:
            break
        assert (plan.stopped, "--resume" in ran.err) == ("the time limit struck", True)
        placed.append(len(plan.stone_steps))
        if len(placed) == 2:
            assert run("check", part, "--stones", rubble).code == 0
        # By the rule for any wall: incomplete where its top is low.
        assert ran.code == (4 if "the time limit struck; the top is at" in ran.out else 0)
    assert len(placed) > 2
    assert placed == sorted(set(placed))
    assert ran.err.startswith(f"drystone: going on after {placed[-1]} stones")
    used = plan.settings["search"]["budget"]
    assert run(*asked, *UNTRIED, "--budget", used, "-o", whole).code == ran.code
    assert (part / "plan.json").read_bytes() == (whole / "plan.json").read_bytes()
    # Time that nobody asked for cuts nothing short.
    limit(monkeypatch, 0)
    ran = run(*asked, "-o", bare)
    assert (ran.code in (0, 4), "W128" in ran.err) == (True, False)
    assert (bare / "plan.json").read_bytes() == (settled / "plan.json").read_bytes()


SEVEN = (
    *("--wall", SIZE, "--scale", "1", *UNTRIED, "--set", "search.budget=7"),
    *("--set", "search.chains=2", "--set", "search.passes=3", "--set", "search.cycle=3"),
    *("--set", "search.share_every=2"),
)
"""A search that does everything but rehearse within seven walls."""


@pytest.fixture(scope="module")
def whole(rubble, tmp_path_factory):
    """The folder of the whole search; not to be changed."""
    return plan_into(tmp_path_factory, rubble, *SEVEN)


@pytest.fixture
def search(rubble, run):
    """Search into a folder, with more options."""
    return lambda folder, *more: run("plan", rubble, *SEVEN, "--seed", 1, "-o", folder, *more)


@pytest.fixture
def holds(rubble, run):
    """Say whether `check` accepts what is in a folder."""
    return lambda folder: run("check", folder, "--stones", rubble).code == 0


def same(folder, whole):
    """Say whether two folders have the same plan, and nothing of a search is left."""
    names = ("plan.json", "blocks.json", "wall.png", "picture.png", "settings.toml")
    left = {path.name for path in folder.iterdir()}
    return left == {path.name for path in whole.iterdir()} and all(
        (folder / name).read_bytes() == (whole / name).read_bytes() for name in names
    )


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(("sent", "walls"), [(signal.SIGINT, 1), (signal.SIGTERM, 7)])
def test_an_interrupted_search_goes_on(sent, walls, search, holds, whole, tmp_path, monkeypatch):
    def on_walls(_, found):
        if found.walls == walls:
            signal.raise_signal(sent)

    with monkeypatch.context() as patch:
        patch.setattr(Callbacks, "on_walls", on_walls)
        ran = search(tmp_path)
    assert ran.code == {signal.SIGINT: 130, signal.SIGTERM: 143}[sent]
    assert ran.out.startswith("interrupted: --resume goes on from here")
    part = read_plan(tmp_path)
    assert (part.stopped, part.settings["search"]["budget"]) == ("interrupted", walls)
    assert holds(tmp_path)
    assert (tmp_path / "report.html").exists()
    assert (tmp_path / CHECKPOINT).exists() == (walls > 1)
    ran = search(tmp_path, "--resume")
    after = f"{len(part.stone_steps)} stones" if walls == 1 else f"{walls} walls of {CHECKPOINT}"
    assert ran.err.startswith(f"drystone: going on after {after}\n")
    assert same(tmp_path, whole)


@pytest.mark.usefixtures("interruptible")
def test_signals_at_the_end_lose_nothing(finished, rubble, tmp_path, run, monkeypatch):
    def write_film(*_):
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("drystone.cli.planning.write_film", write_film)
    ran = run("plan", rubble, *WALL, "--seed", 1, "-o", tmp_path)
    assert (ran.code, "F_LR_coulomb" in ran.out, "wrote" in ran.err) == (143, True, True)
    assert read_plan(tmp_path) == read_plan(finished)
    assert not (tmp_path / CHECKPOINT).exists()


def test_a_full_disk_ends_no_search_and_is_told_once(search, whole, tmp_path, monkeypatch):
    tried = []

    def full(*_):
        tried.append(_)
        raise PlanError("E206", "the file cannot be written (No space left on device).")

    monkeypatch.setattr(keeping, "EVERY_S", 0.0)
    monkeypatch.setattr(keeping, "SHARE", 1.0)
    monkeypatch.setattr(Keeper, "_keep_plan", full)
    ran = search(tmp_path)
    assert (ran.code in (0, 4), len(tried) > 1, ran.err.count("W130")) == (True, True, 1)
    assert "No space left" in ran.err
    assert same(tmp_path, whole)


def test_a_killed_search_goes_on(search, holds, finished, whole, tmp_path, monkeypatch):
    """With a smaller budget it ends where it is."""

    def killed(_, found):
        if found.walls >= 5:
            raise Killed

    on, ended, damaged = (tmp_path / name for name in ("on", "ended", "damaged"))
    (shutil.copytree(finished, on) / "pareto" / "01").mkdir(parents=True)
    for name in ("pareto.png", "pareto/01/plan.json"):
        (on / name).touch()
    with monkeypatch.context() as patch:
        patch.setattr(keeping, "EVERY_S", 0.0)
        patch.setattr(keeping, "SHARE", 1.0)
        patch.setattr(Callbacks, "on_walls", killed)
        with pytest.raises(Killed):
            search(on, "--overwrite")
    # Pictures of an earlier plan do not stay beside another.
    kept = {"plan.json", "settings.toml", "wall.png", "blocks.json", CHECKPOINT}
    assert {path.name for path in on.iterdir()} == kept
    assert (read_plan(on).stopped, holds(on)) == ("interrupted", True)
    for copy in (ended, damaged):
        shutil.copytree(on, copy)
    search(on).refused("E129", "not empty. Add --resume to go on")
    (on / "plan.json").write_text("{}")  # nothing of it is gone on from
    ran = search(on, "--resume")
    assert ran.err.startswith(f"drystone: going on after 5 walls of {CHECKPOINT}\n")
    assert same(on, whole)
    ran = search(ended, "--resume", "--budget", 1)
    assert ran.code in (0, 4)
    assert search(tmp_path / "five", "--budget", 5).code == ran.code
    assert same(ended, tmp_path / "five")
    # A damaged checkpoint is set aside and the partial plan gone on from.
    part, path, told = read_plan(damaged), damaged / CHECKPOINT, []
    path.write_bytes(path.read_bytes()[:-20])
    monkeypatch.setattr(Callbacks, "on_walls", lambda _, found: told.append(found.F_SF))
    ran = search(damaged, "--resume")
    assert ran.code in (0, 4)
    notice, going, *_ = ran.err.splitlines()
    assert notice.startswith(f"drystone: W129 {path}: the search cannot go on from it: ")
    assert going == f"drystone: going on after {len(part.stone_steps)} stones"
    assert told[0] == pytest.approx(part.metrics.F_SF, abs=0.02)
    assert (holds(damaged), path.exists()) == (True, False)


@pytest.mark.parametrize("earlier", [False, True], ids=["nothing", "an earlier plan"])
def test_nothing_kept_is_begun_anew(earlier, rubble, finished, tmp_path, run, monkeypatch):
    def on_step(_, __):
        raise Killed

    out = tmp_path / "out"
    if earlier:
        rewrite(shutil.copytree(finished, out) / "plan.json", lambda plan: plan.update(seed=3))
    plan = ("plan", rubble, *WALL, "--seed", 1, "-o", out)
    with monkeypatch.context() as patch:
        patch.setattr(Callbacks, "on_step", on_step)
        with pytest.raises(Killed):
            run(*plan, "--overwrite")
    (out / f".plan.json.{32 * 'a'}.part").write_bytes(b"half")
    (out / LOCK).write_bytes(b"")
    if not earlier:
        run(*plan, "--resume", "--seed", 2).refused("E136", "--seed")
    ran = run(*plan, "--resume")
    assert ran.err.startswith("drystone: nothing to go on with yet, planning begins anew\n")
    assert {path.name for path in out.iterdir()} == {path.name for path in finished.iterdir()}
    assert (out / "plan.json").read_bytes() == (finished / "plan.json").read_bytes()


def test_two_runs_do_not_write_into_one_folder(rubble, finished, tmp_path, run):
    out = tmp_path
    plan = ("plan", rubble, *WALL, "--seed", 1, "-o", out)
    with locked(out):
        for more in ((), ("--overwrite",), ("--resume",)):
            run(*plan, *more).refused("E149")
        run("demo", "-o", out).refused("E149")
        assert [path.name for path in out.iterdir()] == [LOCK]
    assert run(*plan).code in (0, 4)
    assert (out / "plan.json").read_bytes() == (finished / "plan.json").read_bytes()
    # The lock of a run that was killed at its end goes.
    (out / LOCK).touch()
    assert "finished" in run(*plan, "--resume").err
    assert not (out / LOCK).exists()
    with locked(out):
        run(*plan, "--resume").refused("E149")
    assert not (out / LOCK).exists()


def test_resume_refuses_what_is_of_something_else(finished, rubble, bricks, tmp_path, run):
    path = shutil.copytree(finished, tmp_path / "out") / "plan.json"
    rewrite(path, lambda plan: plan.update(stopped="interrupted"))
    before = path.read_bytes()
    asked = (*WALL, "--seed", 1, "-o", path.parent, "--resume")
    for more, said in (
        ("--seed 2", "--seed"),
        ("--sampling full", "settings"),
        ("--wall 80x30", "--wall"),
        ("--scale .9", "--scale"),
        ("--px-per-m 100", "--px-per-m"),
    ):
        run("plan", rubble, *asked, *more.split()).refused("E136", said)
    run("plan", bricks, *asked).refused("E136")
    assert path.read_bytes() == before
    for kept in ((), ("mu", "settle")):
        settings = {name: json.loads(before)["settings"][name] for name in kept}
        rewrite(path, lambda plan, kept=settings: plan.update(settings=kept))
        assert "other settings" in run("plan", rubble, *asked).err
