"""Processes that work for a search."""

import signal
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager


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

    executor = ProcessPoolExecutor(count, initializer=_left_alone)
    try:
        yield executor
    finally:
        executor.shutdown(wait=True, kill_workers=True)


def _left_alone() -> None:
    """Leave interrupts to the process that asks for work."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
