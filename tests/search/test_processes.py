import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import AbstractContextManager
from typing import Any

import pytest
from loky import ProcessPoolExecutor

from drystone.search.processes import processes, threads
from tests.narrow import not_none

GROWTH_BYTES = 350_000_000
"""More than what loky takes for a leak if it is not told otherwise."""

KEPT: list[bytes] = []


def test_a_process_that_remembers_much_is_kept() -> None:
    with processes(2) as workers:
        assert workers is not None
        both_at_work(workers)
        grown = set(workers.map(grow, range(2)))
        assert grown <= both_at_work(workers)


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(
    ("start", "pool"), [(processes, ProcessPoolExecutor), (threads, ThreadPoolExecutor)]
)
def test_an_interrupt_while_they_end_waits_until_they_have(
    start: Callable[[int], AbstractContextManager[Executor | None]],
    pool: type[Executor],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ended, calls = pool.shutdown, []

    def impatient(self: Executor, *args: Any, **options: Any) -> None:
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
def test_processes_hear_no_interrupt_from_their_very_beginning() -> None:
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    with processes(2) as workers:
        heard = not_none(workers).submit(heard_here).result()
    assert heard == ({signal.SIGINT, signal.SIGTERM} | before, [signal.SIG_IGN] * 2)
    assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == before


def heard_here() -> tuple[set[int], list[object]]:
    """Return which signals are kept back here, and what is done at those of the keyboard."""
    mask = set(signal.pthread_sigmask(signal.SIG_BLOCK, ()))
    return mask, [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)]


ASKING = """
import time
from loky.backend.resource_tracker import _resource_tracker
from drystone.search.processes import processes
from tests.narrow import not_none

with processes(2) as workers:
    busy = [workers.submit(time.sleep, 0.0 if k < 2 else 1000.0) for k in range(4)]
    busy[0].result()
    print(*workers._processes, _resource_tracker._pid, flush=True)
    time.sleep(1000)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no such signal here")
def test_processes_end_with_the_one_that_asks_whatever_kills_it() -> None:
    command = [sys.executable, "-c", ASKING]
    with subprocess.Popen(  # noqa: S603 - our own code
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as asking:
        left = {int(one) for one in not_none(asking.stdout).readline().split()}
        assert len(left) == 3
        assert all(alive(one) for one in left)
        asking.kill()
    for _ in range(100):
        if not any(alive(one) for one in left):
            return
        time.sleep(0.1)
    raise AssertionError(f"{[one for one in left if alive(one)]} are left")


def alive(process: int) -> bool:
    """Say whether a process is at work; one that nobody has asked after is not."""
    said = subprocess.run(  # noqa: S603 - the number is ours
        ["ps", "-o", "stat=", "-p", str(process)],  # noqa: S607
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    return said.stdout.strip() != "" and not said.stdout.strip().startswith("Z")


def both_at_work(workers: Executor) -> set[int]:
    """Give tasks until two processes have done some."""
    seen: set[int] = set()
    while len(seen) < 2:
        seen |= set(workers.map(at_work, range(2)))
    return seen


def at_work(_number: int) -> int:
    time.sleep(0.1)
    return os.getpid()


def grow(_number: int) -> int:
    KEPT.append(b"x" * GROWTH_BYTES)
    time.sleep(1.2)  # loky looks at the memory once a second, after a task
    return os.getpid()
