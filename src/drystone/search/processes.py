"""Processes that work for a search, and threads that work for a single wall."""

import signal
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager

from drystone.search.interrupts import insisted

MUCH_MEMORY = {"LOKY_MAX_MEMORY_LEAK_SIZE": "4e9"}
"""Variables that let a process keep what it has prepared, B.

Turned stones and outcomes are remembered, up to 1 GB of them.  Loky takes a process that has grown
by .3 GB for one that leaks, warns, and begins with another one that remembers nothing: after 20 s
of IR on pixels (.46 GB, and no more after 300 s).
"""


@contextmanager
def processes(count: int) -> Iterator[Executor | None]:
    """Start processes; they end with the block, whatever they do then.

    Parameters
    ----------
    count : int
        How many; with 1, nothing is started and None is given.
    """
    if count == 1:
        yield None
        return
    from loky import ProcessPoolExecutor  # noqa: PLC0415 - most plans do without

    executor = ProcessPoolExecutor(count, initializer=_left_alone, env=MUCH_MEMORY)
    try:
        yield executor
    finally:
        insisted(lambda: executor.shutdown(wait=True, kill_workers=True))


@contextmanager
def threads(count: int) -> Iterator[Executor | None]:
    """Start threads that evaluate candidates; with 1, nothing is started and None is given."""
    if count == 1:
        yield None
        return
    executor = ThreadPoolExecutor(count)
    try:
        yield executor
    finally:
        insisted(executor.shutdown)


def _left_alone() -> None:
    """Leave interrupts to the process that asks for work."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
