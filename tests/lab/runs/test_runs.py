import os
import signal
import threading
from concurrent.futures import Future
from contextlib import nullcontext
from dataclasses import fields, replace
from unittest.mock import Mock

import numpy as np
import pytest
from PIL import Image

from drystone.errors import DrystoneError, InputError, UsageError
from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from drystone.search.plan_wall import plan_wall
from drystone_lab.runs import spec as spec_module
from drystone_lab.runs import workers
from drystone_lab.runs.outcome import FIGURES, Runner, execute, one_by_one
from drystone_lab.runs.spec import RunSpec, StoneSource, published
from drystone_lab.runs.workers import ONE_THREAD, Crew, work_of
from tests.lab.runs.bricks import NOT_SIX, SOURCE, deadly, kept, picture, run

SPEC = run(0)


def test_the_key_changes_with_every_field_and_with_the_version(monkeypatch):
    source = StoneSource(kind="rubble", name="a.png", seed=2, settings=(("count", 7),))
    changes = (("placement.beta", 0.5),)
    other = RunSpec(
        source=source, width=61, height=21, scale=0.5, method="best", changes=changes, seed=1
    )
    others = [replace(SPEC, **{one.name: getattr(other, one.name)}) for one in fields(other)]
    for one in fields(source):
        changed = replace(SOURCE, **{one.name: getattr(source, one.name)})
        others.append(replace(SPEC, source=changed))
    keys = {SPEC.key, *(one.key for one in others)}
    assert len(keys) == 1 + len(others)
    monkeypatch.setattr(spec_module, "version", lambda _: "0.0.0")
    assert SPEC.key not in keys


def test_equal_runs_have_equal_keys():
    as_floats = RunSpec(source=SOURCE, width=60.0, height=20.0, scale=1)
    assert as_floats == SPEC
    one, other = ("mu", 0.5), ("placement.beta", 0.5)
    assert replace(SPEC, changes=(one, other)).key == replace(SPEC, changes=(other, one)).key
    # What the method has anyway: walls of several items of the paper are planned once.
    usual = (("orientations", "quarter"), ("placement.beta", 0.7))
    assert replace(SPEC, changes=usual).key == SPEC.key == as_floats.key


def test_changes_replace_settings_leave_the_others_and_are_told():
    changed = replace(SPEC, changes=(("placement.beta", 0.5), ("mu", 0.4))).settings()
    default = method_settings("paper")
    assert (changed.placement.beta, changed.mu) == (0.5, 0.4)
    assert replace(changed, mu=default.mu, placement=default.placement) == default
    assert SPEC.settings() == default
    assert str(SPEC) == "brick 1, 60 x 20 px at 1, paper, seed 0"
    own = RunSpec(source=published("a/R.png"), changes=(("mu", 0.4),))
    assert str(own) == "a/R.png, own size at 1, paper, mu = 0.4, seed 0"


def test_published_stones_are_in_their_folder_or_others_in_their_place(tmp_path):
    own, theirs = published("set/bricks.png"), published("almeida/PR.png")
    for folder in (None, tmp_path):
        assert not own.is_there(folder)
        theirs.check(folder)  # a file that is missing is another matter
    picture(tmp_path / "set" / "bricks.png")
    assert own.is_there(tmp_path)
    assert len(own.stones(tmp_path)) == 6
    picture(tmp_path / "almeida" / "PR.png")
    for refused in (theirs.check, theirs.stones):
        with pytest.raises(InputError, match="E160"):
            refused(tmp_path)


def test_published_pictures_may_be_read_otherwise(tmp_path):
    path = tmp_path / "one.png"
    Image.fromarray(np.full((12, 24, 4), 255, np.uint8)).save(path)
    bricks = published("one.png", copies=3).stones(tmp_path)
    assert [(stone.id, stone.mask.shape) for stone in bricks] == [(n, (12, 24)) for n in (1, 2, 3)]
    grey = np.zeros((30, 40), np.uint8)
    grey[5:15, 5:15], grey[20:28, 20:38], grey[2, 2] = 7, 9, 8
    Image.fromarray(np.dstack([grey] * 3)).save(path)
    source = published("one.png", least_px=10)
    assert [stone.id for stone in source.stones(tmp_path)] == [7, 9]
    np.testing.assert_array_equal(source.labels(tmp_path), np.where(grey == 8, 0, grey))


def test_it_is_what_plan_wall_gives():
    outcome = execute(run(3), None)
    stones, rest = SOURCE.stones(None), {"seed": 3, "method": "paper", "scale": 1.0}
    result = plan_wall(stones, 60, 20, **rest, coulomb=False)
    assert outcome.as_plan == result.plan
    assert result.metrics.F_LR_coulomb is None
    assert plan_wall(stones, 60, 20, **rest).metrics.F_LR_coulomb is not None
    assert tuple(outcome.figures) == FIGURES
    assert outcome.figures["placed"] == outcome.figures["stones"] == 6
    assert outcome.figures["F_LR"] == result.metrics.F_LR
    assert outcome.figures["wedges"] == 0
    assert outcome.key == run(3).key
    # The wall is built again from its plan.
    wall = outcome.wall(run(3), None)
    assert set(np.unique(wall.labels)) - {0} == set(outcome.clusters)
    assert np.count_nonzero(wall.labels) / wall.labels.size == outcome.figures["F_SF"]
    # The image is the wall when no size is given.
    plan = execute(replace(run(1), width=0.0, height=0.0), None).plan
    assert tuple(plan["wall"].values()) == (stones.source.width_px, stones.source.height_px)


def test_an_interrupted_wall_is_no_outcome(monkeypatch):
    monkeypatch.setattr(Planner, "steps", Mock(side_effect=KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        execute(run(1), None)


def booked(done, stop=None):
    """Do runs one by one from the last, write down which, and be interrupted after some."""

    def work(specs, data):
        for spec in specs[::-1]:
            if len(done) == stop:
                raise KeyboardInterrupt
            yield from one_by_one([spec], data)
            done.append(spec.seed)

    return work


def test_outcomes_are_in_the_order_of_the_runs_and_equal_ones_are_done_once(tmp_path):
    done, said, specs = [], [], [run(3), run(1), run(3), run(2)]
    runner = Runner(tmp_path / "new" / "folder", work=booked(done), say=said.append)
    first, again = (runner.run(specs) for _ in range(2))
    assert [outcome.key for outcome in first] == [spec.key for spec in specs]
    assert first[0] is first[2]
    assert done == [2, 1, 3]
    assert [line.split(",")[0] for line in said] == [f"{k} of 3 walls" for k in (1, 2, 3)]
    assert [vars(one) for one in again] == [vars(one) for one in first]


def test_what_ended_before_an_interrupt_is_kept(tmp_path):
    specs, later = [run(1), run(2), run(3)], []
    with pytest.raises(KeyboardInterrupt):
        Runner(tmp_path, work=booked([], stop=2)).run(specs)
    assert [kept(tmp_path, spec) for spec in specs] == [False, True, True]
    assert len(Runner(tmp_path, work=booked(later)).run(specs)) == 3
    assert later == [1]
    # Runs that nobody did are missed.
    with pytest.raises(RuntimeError, match="lost"):
        Runner(tmp_path, work=lambda _specs, _data: iter(())).run([run(4)])


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[: len(text) // 2],
        lambda _: "null",
        lambda _: '{"figures": 1, "plan": 2, "times": 3}',
        lambda text: "\udcff" + text,
        lambda text: text.replace('"steps":', '"step":'),
        lambda text: text.replace('"wall":', '"walls":'),
        lambda text: text.replace('"F_LR":', '"F_L":'),
    ],
)
def test_a_damaged_file_is_named_with_the_cure(tmp_path, damage):
    runner = Runner(tmp_path)
    runner.run([run(1)])
    (path,) = tmp_path.iterdir()
    path.write_text(damage(path.read_text("utf-8")), "utf-8", errors="surrogateescape")
    with pytest.raises(DrystoneError, match=f"^E401 {path}: .*Delete the file"):
        runner.kept(run(1).key)


def test_options_name_who_works(monkeypatch):
    monkeypatch.setattr(workers, "cluster_at_work", nullcontext)
    with work_of(None, "tcp://a:1") as work:
        assert work == "tcp://a:1"
    for jobs in (None, 1):
        with work_of(jobs, None) as work:
            assert work is one_by_one
    with pytest.raises(UsageError, match="E138"), work_of(1, "tcp://a:1"):
        pass


class AtOnce:
    """Does what it is given when it is given."""

    def submit(self, do, *args):
        future = Future()
        try:
            future.set_result(do(*args))
        except DrystoneError as error:
            future.set_exception(error)
        return future

    def shutdown(self, wait=True, *, kill_workers=False):
        assert (wait, kill_workers) == (True, True)


@pytest.mark.usefixtures("interruptible")
def test_deaths_and_interrupts_lose_nothing_that_ended(tmp_path):
    with work_of(2, None) as work:
        runner = Runner(tmp_path, work=work)
        with pytest.raises(DrystoneError, match=f"^E402 {deadly(2)}: "):
            runner.run([run(1), deadly(2)])
        assert [kept(tmp_path, spec) for spec in (run(1), deadly(2))] == [True, False]
        # Another process is in the place of the dead one.
        found = [one.plan for one in runner.run([run(1), run(3), run(4), run(5)])]
        assert found[:2] == [one.plan for one in one_by_one([run(1), run(3)], None)]
        soon = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        endless = replace(run(0), method="best", changes=(("search.budget", 10**6),))
        with pytest.raises(KeyboardInterrupt):
            Runner(tmp_path, work=work, say=lambda _: soon.start()).run([run(6), endless])
        assert kept(tmp_path, run(6))


def test_a_run_that_fails_does_not_stop_those_that_have_begun(tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "_process", AtOnce)
    specs = [run(1), run(2, NOT_SIX), run(3), run(4), run(5)]
    with work_of(3, None) as work, pytest.raises(DrystoneError, match="E130"):
        Runner(tmp_path, work=work).run(specs)
    assert [kept(tmp_path, run(seed)) for seed in (1, 3, 5)] == [True, True, False]


@pytest.mark.parametrize("fresh", [False, True])
def test_processes_have_one_thread_and_are_used_again_or_not(monkeypatch, fresh):
    monkeypatch.setenv(ONE_THREAD[0], "2")
    with Crew(1, fresh=fresh) as processes:
        found = processes.work(lambda name: (os.getpid(), os.environ[name]), 2 * ONE_THREAD[:1])
        ids, threads = zip(*found, strict=True)
    assert threads == ("1", "1")
    ids = set(ids)
    assert os.getpid() not in ids
    assert len(ids) == (2 if fresh else 1)
    for one in ids:
        with pytest.raises(ProcessLookupError):
            os.kill(one, 0)
