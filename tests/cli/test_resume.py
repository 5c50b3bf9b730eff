"""An interrupt and the time limit keep what is built, and --resume goes on from there."""

import json
import shutil
import signal
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import pytest

from drystone.cli import keeping, main
from drystone.io.checkpoint import CHECKPOINT
from drystone.io.folder_lock import LOCK, locked
from drystone.io.plan_json import read_plan
from drystone.planner.deadline import Deadline
from drystone.planner.events import Callbacks
from tests.cli.conftest import UNTRIED, WALL, Run, coarse, rewrite
from tests.cli.test_keeping import Killed, killed_at
from tests.planner.scenes import after_looks


def test_resume_gives_the_plan_that_no_interrupt_would_have_changed(
    finished, rubble, tmp_path, run, monkeypatch
):
    def interrupt(_, step):
        if step.number == 3:
            raise KeyboardInterrupt

    interrupted = tmp_path / "partial"
    with monkeypatch.context() as patch:
        patch.setattr(Callbacks, "on_step", interrupt)
        ran = run("plan", rubble, *WALL, "--seed", 1, "-o", interrupted)
    assert ran.code == 130
    assert ran.out.startswith("interrupted: --resume goes on from here")
    plan, count = read_plan(interrupted), len(read_plan(finished).stone_steps)
    assert (plan.stopped, len(plan.stone_steps), len(plan.unused)) == ("interrupted", 3, 3)
    assert count > 3
    assert (interrupted / "report.html").exists()
    assert run("check", interrupted, "--stones", rubble).code == 0
    told = []
    monkeypatch.setattr(Callbacks, "on_step", lambda _, step: told.append(step.number))
    ran = run("plan", rubble, *WALL, "--seed", 1, "-o", interrupted, "--resume")
    assert ran.code in (0, 4)
    first, read, wrote = ran.err.splitlines()
    assert first == "drystone: going on after 3 stones"
    assert (read.split()[1], wrote.split()[1]) == ("Read", "wrote")
    for name in ("plan.json", "wall.png", "settings.toml", "picture.png"):
        assert (interrupted / name).read_bytes() == (finished / name).read_bytes()
    assert told == list(range(4, count + 1))  # the first three were not planned again


def test_a_finished_plan_is_left_as_it_is(finished, standing, rubble, bricks, tmp_path, run):
    whole = shutil.copytree(standing, tmp_path / "whole")
    low = shutil.copytree(finished, tmp_path / "low")
    full = ("plan", bricks, "--wall", "60x20", *WALL[2:], "--seed", 1, "-o", whole)
    lower = ("plan", rubble, *WALL, "--seed", 1, "-o", low)
    for code, asked, out in ((4, lower, low), (0, full, whole)):
        before = {path.name: path.read_bytes() for path in out.iterdir()}
        again, as_json = run(*asked, "--resume"), run(*asked, "--resume", "--json")
        assert (again.code, as_json.code, "finished" in again.err) == (code, code, True)
        assert ("incomplete: the top is at" in again.err) == (code == 4)
        told = as_json.json()
        assert (told["status"], told["shortfall"], told["seconds"]) == ("finished", None, None)
        assert told["placed"] == len(read_plan(out).stone_steps)
        assert {path.name: path.read_bytes() for path in out.iterdir()} == before


def limit(monkeypatch, looks):
    """Let `--time` strike by how often the clock was looked at; what follows has time."""
    limits = iter([after_looks(looks)])
    monkeypatch.setattr(Deadline, "after", lambda *_: next(limits, Deadline()))


def test_a_first_wall_that_the_time_limit_cuts_short_is_gone_on_with(
    rubble, tmp_path, run, monkeypatch
):
    plan = ("plan", rubble, "--wall", "70x30", "--scale", "1", "--seed", 1, *UNTRIED)
    timed = (*plan, "--time", "5", "-o", tmp_path / "part")
    placed = []
    more = ()
    while True:
        limit(monkeypatch, 9)
        ran = run(*timed, *more)
        part = read_plan(tmp_path / "part")
        if "W128 the time limit struck after" not in ran.err:
            break
        assert part.stopped == "the time limit struck"
        placed.append(len(part.stone_steps))
        if len(placed) == 2:
            assert run("check", tmp_path / "part", "--stones", rubble).code == 0
        # By the rule for any wall: incomplete where its top is low.
        assert ran.code == (4 if "the time limit struck; the top is at" in ran.out else 0)
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
    settled, rubble, tmp_path, run, monkeypatch
):
    limit(monkeypatch, 0)
    plan = ("plan", rubble, "--wall", "70x30", "--scale", "1", "--seed", 1)
    ran = run(*plan, "-o", tmp_path)
    assert (ran.code in (0, 4), "W128" in ran.err) == (True, False)
    assert (tmp_path / "plan.json").read_bytes() == (settled / "plan.json").read_bytes()


SMALL = (
    "[search]\nbudget = 7\npasses = 3\nchains = 2\nshare_every = 2\ncycle = 3\n"
    "[settle]\ntrials = 0\n[goal]\nfallen = 0\n"
)
"""A search that does everything but rehearse within seven walls."""


@dataclass(frozen=True)
class Search:
    """A command that searches; what its whole plan is, and how it is called."""

    stones: Path
    arguments: tuple[str, ...]
    whole: Path
    run: Run

    def __call__(self, folder, *more):
        return self.run(*self.arguments, folder, *more)

    def holds(self, folder):
        """Say whether `check` accepts what is in a folder."""
        return self.run("check", folder, "--stones", self.stones).code == 0


@pytest.fixture(scope="module")
def searched(rubble, tmp_path_factory):
    """The folder of the whole search, not to be changed."""
    folder = tmp_path_factory.mktemp("search")
    (folder / "small.toml").write_text(SMALL)
    plan = ("plan", str(rubble), "--wall", "70x30", "--scale", "1", "--seed", "1")
    arguments = (*plan, "--settings", str(folder / "small.toml"), "-o")
    with coarse():
        assert main([*arguments, str(folder / "whole")]) in (0, 4)
    return Search(rubble, arguments, folder / "whole", cast(Run, None))


@pytest.fixture
def search(searched, run):
    """The same, to be called."""
    return replace(searched, run=run)


@pytest.fixture(scope="module")
def killed(searched, tmp_path_factory):
    """The folder of the search when it is killed after five walls; not to be changed."""
    folder = tmp_path_factory.mktemp("killed") / "out"
    with coarse(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(keeping, "EVERY_S", 0.0)
        patch.setattr(keeping, "SHARE", 1.0)
        patch.setattr(Callbacks, "on_walls", killed_at(5))
        with pytest.raises(Killed):
            main([*searched.arguments, str(folder)])
    assert read_plan(folder).stopped == "interrupted"
    return folder


def same(folder, whole):
    """Say whether two folders have the same plan, and nothing of a search is left."""
    names = ("plan.json", "blocks.json", "wall.png", "picture.png", "settings.toml")
    left = {path.name for path in folder.iterdir()}
    return left == {path.name for path in whole.iterdir()} and all(
        (folder / name).read_bytes() == (whole / name).read_bytes() for name in names
    )


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(
    ("sent", "walls", "stood"), [(signal.SIGINT, 1, None), (signal.SIGTERM, 7, 7)]
)
def test_a_search_that_is_interrupted_goes_on_to_the_same_plan(
    sent, walls, stood, search, tmp_path, monkeypatch
):
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
    assert search.holds(tmp_path)
    assert (tmp_path / "report.html").exists()
    assert (tmp_path / CHECKPOINT).exists() == (stood is not None)
    ran = search(tmp_path, "--resume")
    after = f"{len(part.stone_steps)} stones" if stood is None else f"{stood} walls"
    assert ran.err.startswith(f"drystone: going on after {after}\n")
    assert same(tmp_path, search.whole)


@pytest.mark.usefixtures("interruptible")
def test_signals_while_the_end_is_written_lose_nothing(
    finished, rubble, tmp_path, run, monkeypatch
):
    def write_film(*_):
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGINT)

    with monkeypatch.context() as patch:
        patch.setattr("drystone.cli.planning.write_film", write_film)
        ran = run("plan", rubble, *WALL, "--seed", 1, "-o", tmp_path)
    assert ran.code == 143
    assert "F_LR_coulomb" in ran.out
    assert "wrote" in ran.err
    assert read_plan(tmp_path) == read_plan(finished)
    assert not (tmp_path / CHECKPOINT).exists()


def test_a_search_that_is_killed_goes_on_from_its_checkpoint(search, killed, tmp_path):
    """With a smaller budget it ends where it is."""
    on, ended = (shutil.copytree(killed, tmp_path / name) for name in ("on", "ended"))
    assert search.holds(on)
    search(on).refused("E129")
    ran = search(on, "--resume")
    assert ran.err.startswith("drystone: going on after 5 walls\n")
    assert same(on, search.whole)
    ran = search(ended, "--resume", "--budget", 1)
    assert ran.code in (0, 4)
    assert search(tmp_path / "five", "--budget", 5).code == ran.code
    assert same(ended, tmp_path / "five")


@pytest.mark.parametrize("earlier", [False, True], ids=["nothing", "an earlier plan"])
def test_of_a_plan_that_was_killed_before_anything_was_kept_there_is_nothing_to_go_on_with(
    earlier, rubble, finished, tmp_path, run, monkeypatch
):
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


def test_a_damaged_checkpoint_is_set_aside_and_the_partial_plan_gone_on_from(
    search, killed, tmp_path, monkeypatch
):
    out = shutil.copytree(killed, tmp_path / "out")
    part, path = read_plan(out), out / CHECKPOINT
    path.write_bytes(path.read_bytes()[:-20])
    told = []
    with monkeypatch.context() as patch:
        patch.setattr(Callbacks, "on_walls", lambda _, found: told.append(found.F_SF))
        ran = search(out, "--resume")
    assert ran.code in (0, 4)
    notice, going, *_ = ran.err.splitlines()
    assert notice.startswith(f"drystone: W129 {path}: the search cannot go on from it: ")
    assert going == f"drystone: going on after {len(part.stone_steps)} stones"
    assert told[0] == pytest.approx(part.metrics.F_SF, abs=0.02)
    assert search.holds(out)
    assert not path.exists()


def test_two_runs_do_not_write_into_one_folder(rubble, finished, tmp_path, run):
    out = tmp_path / "out"
    plan = ("plan", rubble, *WALL, "--seed", 1, "-o", out)
    out.mkdir()
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
        (("--seed", "2"), "--seed"),
        (("--sampling", "full"), "settings"),
        (("--wall", "80x30"), "--wall"),
        (("--scale", ".9"), "--scale"),
        (("--px-per-m", "100"), "--px-per-m"),
    ):
        run("plan", rubble, *asked, *more).refused("E136", said)
    run("plan", bricks, *asked).refused("E136")
    assert path.read_bytes() == before
    plan = json.loads(before)
    for kept in ((), ("mu", "settle")):
        settings = {name: plan["settings"][name] for name in kept}
        path.write_text(json.dumps({**plan, "settings": settings}), encoding="utf-8")
        assert "other settings" in run("plan", rubble, *asked).err
