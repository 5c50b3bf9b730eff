"""Runs done by several processes of this machine."""

import signal
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from drystone.experiments.runs.failures import died
from drystone.experiments.runs.outcome import Outcome, execute
from drystone.experiments.runs.runner import Work, one_by_one
from drystone.experiments.runs.spec import RunSpec

ONE_THREAD = (
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS",
)  # fmt: skip
"""Variables that BLAS libraries take their number of threads from.

The matrices of a run are small: a search of four walls of PR came to the same bytes with one
thread and with two, and took 3 to 5 % more processor time with two.
"""


Process = Any
"""An executor of loky, which tells nothing of its types, with one process."""


@contextmanager
def processes_at_work(jobs: int) -> Iterator[Work]:
    """Start processes that do runs; they end with the block, whatever they do then.

    Parameters
    ----------
    jobs : int
        How many; 1 is this process itself.

    Yields
    ------
    Work
        An interrupt (Ctrl-C) goes to the caller after the outcomes of the runs that have ended.
        When a run fails, those that are being done are done to their end, no other is begun, and
        the error of the first in order that failed is raised: its own, or E402 when its process
        died.
    """
    if jobs == 1:
        yield one_by_one
        return
    crew = _Crew(jobs)
    try:
        yield crew.work
    finally:
        crew.end()


class _Crew:
    """Processes with one worker each, so that it is known at which run one died."""

    def __init__(self, jobs: int) -> None:
        self.free = [_process() for _ in range(jobs)]

    def work(self, specs: Sequence[RunSpec], data: Path | None) -> Iterator[Outcome]:
        """Do runs."""
        waiting = deque(specs)
        busy: dict[Future[Outcome], tuple[RunSpec, Process]] = {}
        failed: dict[RunSpec, BaseException] = {}
        try:
            while busy or (waiting and not failed):
                while waiting and self.free and not failed:
                    spec, process = waiting.popleft(), self.free.pop()
                    busy[_begun(process, spec, data)] = spec, process
                for future in wait(busy, return_when=FIRST_COMPLETED).done:
                    spec, process = busy.pop(future)
                    error = future.exception()
                    self.free.append(_alive(process, error))
                    if error is None:
                        yield future.result()
                    else:
                        failed[spec] = error
        except KeyboardInterrupt:
            yield from _ended(busy)
            raise
        finally:
            self.free += [process for _, process in busy.values()]
        for spec in specs:
            if spec in failed:
                raise _told(failed[spec], spec)

    def end(self) -> None:
        """End the processes."""
        for process in self.free:
            process.shutdown(wait=True, kill_workers=True)


def _process() -> Process:
    """Return an executor of one process, which starts when it has something to do."""
    from loky import ProcessPoolExecutor  # noqa: PLC0415 - not needed to work in this process

    return ProcessPoolExecutor(1, initializer=_left_alone, env=dict.fromkeys(ONE_THREAD, "1"))


def _left_alone() -> None:
    """Leave interrupts to the process that asks for runs."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _begun(process: Process, spec: RunSpec, data: Path | None) -> Future[Outcome]:
    """Give a run to a process; it fails at once if the process died when it had nothing to do."""
    future: Future[Outcome] = Future()
    try:
        future = process.submit(execute, spec, data)
    except BrokenProcessPool as error:
        future.set_exception(error)
    return future


def _alive(process: Process, error: BaseException | None) -> Process:
    """Return the process, or another one in its place if it died."""
    if not isinstance(error, BrokenProcessPool):
        return process
    process.shutdown(wait=True, kill_workers=True)
    return _process()


def _ended(busy: dict[Future[Outcome], tuple[RunSpec, Process]]) -> Iterator[Outcome]:
    """Give the outcomes of the runs that have ended well by now."""
    for future in tuple(busy):
        if future.done() and future.exception() is None:
            yield future.result()


def _told(error: BaseException, spec: RunSpec) -> BaseException:
    """Return what is raised for a run."""
    if not isinstance(error, BrokenProcessPool):
        return error
    told = died(spec, "process")
    told.__cause__ = error
    return told
