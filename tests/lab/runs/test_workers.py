"""Tests."""

import os
import signal
import threading
from concurrent.futures import Executor, Future
from contextlib import contextmanager

import pytest

from drystone.errors import DrystoneError, UsageError
from drystone_lab.runs import workers
from drystone_lab.runs.outcome import Runner, RunStore, one_by_one
from drystone_lab.runs.workers import ONE_THREAD, crew, processes_at_work, work_of
from tests.lab.runs.bricks import NOT_SIX, deadly, endless, kept, run


@contextmanager
def named(*args):
    yield args


def test_options_name_who_works(monkeypatch):
    monkeypatch.setattr(workers, "processes_at_work", lambda jobs: named("processes", jobs))
    monkeypatch.setattr(workers, "cluster_at_work", lambda address: named("cluster", address))
    with work_of(3, None) as work:
        assert work == ("processes", 3)
    with work_of(None, "tcp://a:1") as work:
        assert work == ("cluster", "tcp://a:1")


def test_processes_and_a_cluster_are_one_too_many():
    with pytest.raises(UsageError, match="E138"), work_of(1, "tcp://a:1"):
        pass


class AtOnce(Executor):
    """Does what it is given when it is given."""

    def submit(self, do, /, *args, **kwargs):
        future = Future()
        try:
            future.set_result(do(*args, **kwargs))
        except DrystoneError as error:
            future.set_exception(error)
        return future

    def shutdown(self, wait=True, *, kill_workers=False):
        assert wait
        assert kill_workers


def interrupt_soon(_):
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()


@pytest.mark.usefixtures("interruptible")
def test_deaths_and_interrupts_lose_nothing_that_ended(tmp_path):
    store = RunStore(tmp_path)
    with processes_at_work(2) as work:
        runner = Runner(store, work=work)
        with pytest.raises(DrystoneError) as caught:
            runner.run([run(1), deadly(2)])
        assert (caught.value.code, caught.value.where) == ("E402", str(deadly(2)))
        assert [kept(store, spec) for spec in (run(1), deadly(2))] == [True, False]
        # Another process is in the place of the dead one.
        outcomes = runner.run([run(1), run(3), run(4), run(5)])
        assert [one.plan for one in outcomes[:2]] == [
            one.plan for one in one_by_one([run(1), run(3)], None)
        ]
        with pytest.raises(KeyboardInterrupt):
            Runner(store, work=work, say=interrupt_soon).run([run(6), endless()])
        assert kept(store, run(6))


def test_a_run_that_fails_does_not_stop_those_that_have_begun(tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "_process", AtOnce)
    specs = [run(1), run(2, NOT_SIX), run(3), run(4), run(5)]
    store = RunStore(tmp_path)
    with processes_at_work(3) as work, pytest.raises(DrystoneError) as caught:
        Runner(store, work=work).run(specs)
    assert caught.value.code == "E130"
    assert kept(store, run(1))
    assert kept(store, run(3))
    assert not kept(store, run(5))


@pytest.mark.parametrize("fresh", [False, True])
def test_processes_have_one_thread_and_are_used_again_or_not(monkeypatch, fresh):
    monkeypatch.setenv(ONE_THREAD[0], "2")
    with crew(1, fresh=fresh) as processes:
        assert list(processes.work(os.getenv, ONE_THREAD[:1])) == ["1"]
        ids = set(processes.work(pid, range(2)))
    assert os.getpid() not in ids
    assert len(ids) == (2 if fresh else 1)
    assert not [one for one in ids if alive(one)]


def pid(_):
    """Return the number of this process."""
    return os.getpid()


def alive(process):
    """Return True when there is a process of this number."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True
