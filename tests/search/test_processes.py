import os
import time
from concurrent.futures import Executor

from drystone.search.processes import processes

GROWTH_BYTES = 350_000_000
"""More than what loky takes for a leak if it is not told otherwise."""

KEPT: list[bytes] = []


def test_a_process_that_remembers_much_is_kept() -> None:
    with processes(2) as workers:
        assert workers is not None
        both_at_work(workers)
        grown = set(workers.map(grow, range(2)))
        assert grown <= both_at_work(workers)


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
