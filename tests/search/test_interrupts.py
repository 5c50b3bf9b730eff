"""Signals come when they may, and processes end with those who asked for them."""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from threading import Thread

import pytest
from loky import ProcessPoolExecutor

from drystone.search.interrupts import SIGNALS, Terminated, held, terminable
from drystone.search.processes import processes, threads

pytestmark = pytest.mark.usefixtures("interruptible")


def handlers():
    return [signal.getsignal(one) for one in SIGNALS]


def test_termination_is_an_interrupt_and_leaves_no_handler_behind():
    before = handlers()
    with terminable() as came:
        assert came() is None
        with pytest.raises(KeyboardInterrupt) as caught:
            signal.raise_signal(signal.SIGTERM)
        assert isinstance(caught.value, Terminated)
        assert came() == signal.SIGTERM
        with pytest.raises(KeyboardInterrupt) as caught:
            signal.raise_signal(signal.SIGINT)
        assert not isinstance(caught.value, Terminated)
        assert came() == signal.SIGINT
    assert handlers() == before
    # One that is ignored stays ignored; the fixture puts back what was there.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with terminable() as came:
        signal.raise_signal(signal.SIGINT)
        assert came() is None


@pytest.mark.parametrize("first", SIGNALS)
def test_what_comes_while_they_are_held_comes_after_it_once(first):
    done = []

    def raise_all():
        for one in (first, *SIGNALS):
            signal.raise_signal(one)
            done.append(one)

    with terminable() as came:
        before = handlers()
        with pytest.raises(KeyboardInterrupt) as caught, held():
            raise_all()
        assert len(done) == 3
        assert isinstance(caught.value, Terminated) == (first == signal.SIGTERM)
        assert came() == first
        assert handlers() == before
    # Nothing comes where nothing came, and errors pass.
    before = handlers()
    with held():
        pass
    with pytest.raises(ZeroDivisionError), held():
        raise ZeroDivisionError
    assert handlers() == before


def test_other_threads_set_no_handlers():
    seen = []

    def look():
        with terminable() as came, held():
            seen.append([*handlers(), came()])

    thread = Thread(target=look)
    thread.start()
    thread.join()
    assert seen == [[*handlers(), None]]


GROWTH_BYTES = 350_000_000
"""More than what loky takes for a leak if it is not told otherwise."""

KEPT = []


def test_a_process_that_remembers_much_is_kept():
    with processes(2) as workers:
        both_at_work(workers)
        grown = set(workers.map(grow, range(2)))
        assert grown <= both_at_work(workers)


@pytest.mark.parametrize(
    ("start", "pool"), [(processes, ProcessPoolExecutor), (threads, ThreadPoolExecutor)]
)
def test_an_interrupt_while_they_end_waits_until_they_have(start, pool, monkeypatch):
    ended, calls = pool.shutdown, []

    def impatient(self, *args, **options):
        signal.raise_signal(signal.SIGINT)
        ended(self, *args, **options)
        calls.append(1)

    monkeypatch.setattr(pool, "shutdown", impatient)
    with pytest.raises(KeyboardInterrupt), start(2) as workers:
        assert workers is not None
    assert calls == [1]
    with pytest.raises(RuntimeError, match="shutdown"):
        workers.submit(int)


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="there are no masks here")
def test_processes_hear_no_interrupt_from_their_very_beginning():
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    with processes(2) as workers:
        heard = workers.submit(heard_here).result()
    assert heard == ({signal.SIGINT, signal.SIGTERM} | before, [signal.SIG_IGN] * 2)
    assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == before


def heard_here():
    """Return which signals are kept back here, and what is done at those of the keyboard."""
    mask = set(signal.pthread_sigmask(signal.SIG_BLOCK, ()))
    return mask, [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)]


ASKING = """
import time
from loky.backend.resource_tracker import _resource_tracker
from drystone.search.processes import processes

with processes(2) as workers:
    busy = [workers.submit(time.sleep, 0.0 if k < 2 else 1000.0) for k in range(4)]
    busy[0].result()
    print(*workers._processes, _resource_tracker._pid, flush=True)
    time.sleep(1000)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no such signal here")
def test_processes_end_with_the_one_that_asks_whatever_kills_it():
    command = [sys.executable, "-c", ASKING]
    with subprocess.Popen(  # noqa: S603 - our own code
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as asking:
        left = {int(one) for one in asking.stdout.readline().split()}
        assert len(left) == 3
        assert all(alive(one) for one in left)
        asking.kill()
    for _ in range(100):
        if not any(alive(one) for one in left):
            return
        time.sleep(0.1)
    raise AssertionError(f"{[one for one in left if alive(one)]} are left")


def alive(process):
    """Say whether a process is at work; one that nobody has asked after is not."""
    said = subprocess.run(  # noqa: S603 - the number is ours
        ["ps", "-o", "stat=", "-p", str(process)],  # noqa: S607
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    return said.stdout.strip() != "" and not said.stdout.strip().startswith("Z")


def both_at_work(workers):
    """Give tasks until two processes have done some."""
    seen = set()
    while len(seen) < 2:
        seen |= set(workers.map(at_work, range(2)))
    return seen


def at_work(_number):
    time.sleep(0.1)
    return os.getpid()


def grow(_number):
    KEPT.append(b"x" * GROWTH_BYTES)
    time.sleep(1.2)  # loky looks at the memory once a second, after a task
    return os.getpid()
