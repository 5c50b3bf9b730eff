import os
import signal
import threading
from concurrent.futures import Future
from contextlib import nullcontext
from dataclasses import replace

import pytest

from drystone.errors import DrystoneError, UsageError
from drystone_lab.runs import workers
from drystone_lab.runs.outcome import Runner, one_by_one
from drystone_lab.runs.workers import ONE_THREAD, Crew, work_of
from tests.lab.runs.bricks import NOT_SIX, deadly, kept, run


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
