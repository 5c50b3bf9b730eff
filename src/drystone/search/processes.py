"""Processes that work for a search, and threads that work for a single wall."""

import gc
import os
import signal
import threading
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import AbstractContextManager, contextmanager, suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from drystone.search.interrupts import SIGNALS, blocked, held

MUCH_MEMORY = {"LOKY_MAX_MEMORY_LEAK_SIZE": "4e9"}
"""Variables that let a process keep what it has prepared, B.

Turned stones and outcomes are remembered, up to 1 GB of them.  Loky takes a process that has grown
by .3 GB for one that leaks, warns, and begins with another one that remembers nothing: after 20 s
of IR on pixels (.46 GB, and no more after 300 s).
"""

RARELY = 100_000
"""Walls, models and plans hold no cycles: of so many new objects the collector finds next to none.

With the usual 700 it takes a twelfth of the time of a search.
"""

Result = TypeVar("Result")


def mapped(
    executor: Executor | None,
    work: Callable[..., Result | None],
    tasks: Sequence[tuple[object, ...]],
) -> Iterator[Result | None]:
    """Do tasks, and give their results in order; after one that came too late there is no more."""
    if executor is None:
        yield from (work(*task) for task in tasks)
        return
    futures = [executor.submit(work, *task) for task in tasks]
    try:
        for future in futures:
            yield future.result()
    finally:
        for future in futures:
            future.cancel()


def processes(count: int) -> AbstractContextManager[Executor | None]:
    """Start processes; they end with the block, whatever they do then."""
    executor = process_pool(count, MUCH_MEMORY) if count != 1 else None
    return _ending(executor, kill_workers=True)


def threads(count: int) -> AbstractContextManager[Executor | None]:
    """Start threads that evaluate candidates; with 1, nothing is started and None is given."""
    return _ending(ThreadPoolExecutor(count) if count != 1 else None)


@contextmanager
def _ending(executor: Any, **how: bool) -> Iterator[Executor | None]:
    try:
        yield executor
    finally:
        if executor is not None:
            with held():
                executor.shutdown(**how)


def process_pool(count: int, env: Mapping[str, str]) -> Any:
    """Return an executor of loky, whose processes end with this one, whatever kills it."""
    from loky import ProcessPoolExecutor  # noqa: PLC0415 - most plans do without

    class Pool(ProcessPoolExecutor):  # type: ignore[misc]
        def submit(self, *args: Any, **kwargs: Any) -> Any:
            # Processes are started here, and are not to hear an interrupt before they leave it.
            with blocked():
                return super().submit(*args, **kwargs)

    far, near = Pipe(duplex=False)
    executor = Pool(count, initializer=_begin, initargs=(far,), env=env)
    # Nobody else has the near end, and nothing is ever sent: it is at an end when this process is.
    weakref.finalize(executor, near.close)
    return executor


def _begin(asking: Connection) -> None:
    """Leave signals to the process that asks for work, and end with it."""
    gc.set_threshold(RARELY)
    for one in SIGNALS:
        signal.signal(one, signal.SIG_IGN)
    threading.Thread(target=_end_with, args=(asking,), daemon=True).start()


def _end_with(asking: Connection) -> None:
    """Wait for the end of the process that asks, and end without a word."""
    with suppress(EOFError, OSError):
        asking.recv_bytes()
    os._exit(1)
