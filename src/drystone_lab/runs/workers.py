"""Who does runs: processes of this machine, or a cluster, as the command line names it."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from typing import Any, Self, TypeVar

from drystone.errors import UsageError
from drystone.search.processes import MUCH_MEMORY, process_pool
from drystone_lab.runs.cluster import cluster_at_work
from drystone_lab.runs.outcome import RunWorker, died, execute, one_by_one

ONE_THREAD = (
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS",
)  # fmt: skip
"""Variables that BLAS libraries take their number of threads from.

The matrices of a run are small: a search of four walls of PR came to the same bytes with one
thread and with two, and took 3 to 5 % more processor time with two.
"""


Task = TypeVar("Task")
Done = TypeVar("Done")
Process = Any
"""An executor of loky, which tells nothing of its types, with one process."""


class Crew:
    """Processes with one worker each, so that it is known at which task one died.

    They end with the block, whatever they do then.  With `fresh` each task has a new process: what
    one remembers takes no time from another.
    """

    def __init__(self, jobs: int, *, fresh: bool = False) -> None:
        self.free = [_process() for _ in range(jobs)]
        self.fresh = fresh

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self.free:
            process.shutdown(wait=True, kill_workers=True)

    def work(self, do: Callable[[Task], Done], tasks: Sequence[Task]) -> Iterator[Done]:
        """Do tasks, and give what comes of them in whatever order they end.

        An interrupt (Ctrl-C) goes to the caller after the results of the tasks that have ended.
        When a task fails, those that are being done are done to their end, no other is begun, and
        the error of the first in order that failed is raised: its own, or E402 when its process
        died.
        """
        waiting = deque(enumerate(tasks))
        busy: dict[Future[Done], tuple[int, Process]] = {}
        failed: dict[int, BaseException] = {}
        try:
            while busy or (waiting and not failed):
                while waiting and self.free and not failed:
                    (number, task), process = waiting.popleft(), self.free.pop()
                    busy[_begun(process, do, task)] = number, process
                for future in wait(busy, return_when=FIRST_COMPLETED).done:
                    number, process = busy.pop(future)
                    error = future.exception()
                    self.free.append(self._next(process, error))
                    if error is None:
                        yield future.result()
                    else:
                        failed[number] = error
        except KeyboardInterrupt:
            for future in tuple(busy):
                if future.done() and future.exception() is None:
                    yield future.result()
            raise
        finally:
            self.free += [process for _, process in busy.values()]
        if failed:
            number, error = min(failed.items())
            if isinstance(error, BrokenProcessPool):
                raise died(str(tasks[number]), "process") from error
            raise error

    def _next(self, process: Process, error: BaseException | None) -> Process:
        """Return the process, or another one in its place if it died or is used once."""
        if not self.fresh and not isinstance(error, BrokenProcessPool):
            return process
        process.shutdown(wait=True, kill_workers=True)
        return _process()


def _process() -> Process:
    """Return an executor of one process, which starts when it has something to do."""
    return process_pool(1, {**dict.fromkeys(ONE_THREAD, "1"), **MUCH_MEMORY})


def _begun(process: Process, do: Callable[[Task], Done], task: Task) -> Future[Done]:
    """Give a task to a process; it fails at once if that died when it had nothing to do."""
    future: Future[Done] = Future()
    try:
        future = process.submit(do, task)
    except BrokenProcessPool as error:
        future.set_exception(error)
    return future


@contextmanager
def work_of(jobs: int | None, dask_address: str | None) -> Iterator[RunWorker]:
    """Have runs done by whom the options say, as long as the block lasts.

    Whoever works, outcomes differ in their times alone.

    >>> from drystone_lab.runs.spec import generated
    >>> from drystone_lab.runs.spec import RunSpec
    >>> bricks = generated("brick", 1, count=6, height_px=10, aspect=2)
    >>> with work_of(1, None) as work:
    ...     (outcome,) = work([RunSpec(source=bricks, width=60, height=20)], None)
    >>> outcome.figures["placed"]
    6
    """
    if jobs is not None and dask_address is not None:
        what = "processes here and a Dask cluster are asked for, and only one of them can work."
        cure = "Give one of the two; a cluster's workers are its own."
        raise UsageError("E138", what, where="--jobs, --dask", cure=cure)
    if dask_address is not None:
        with cluster_at_work(dask_address) as work:
            yield work
    elif jobs in (None, 1):
        yield one_by_one
    else:
        with Crew(jobs) as crew:
            yield lambda specs, data: crew.work(partial(execute, data=data), specs)
