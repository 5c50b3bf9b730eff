import os
import time
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import AbstractContextManager
from typing import Any

import pytest
from loky import ProcessPoolExecutor

from drystone.search.processes import processes, threads

GROWTH_BYTES = 350_000_000
"""More than what loky takes for a leak if it is not told otherwise."""

KEPT: list[bytes] = []


def test_a_process_that_remembers_much_is_kept() -> None:
    with processes(2) as workers:
        assert workers is not None
        both_at_work(workers)
        grown = set(workers.map(grow, range(2)))
        assert grown <= both_at_work(workers)


@pytest.mark.parametrize(
    ("start", "pool"), [(processes, ProcessPoolExecutor), (threads, ThreadPoolExecutor)]
)
def test_an_interrupt_while_they_end_loses_nothing(
    start: Callable[[int], AbstractContextManager[Executor | None]],
    pool: type[Executor],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ended, calls = pool.shutdown, []

    def impatient(self: Executor, *args: Any, **options: Any) -> None:
        calls.append(1)
        if len(calls) == 1:
            raise KeyboardInterrupt
        ended(self, *args, **options)

    monkeypatch.setattr(pool, "shutdown", impatient)
    with start(2) as workers:
        assert workers is not None
    assert len(calls) == 2
    with pytest.raises(RuntimeError, match="shutdown"):
        workers.submit(int)


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
