"""Who does runs: processes of this machine, or a Dask cluster, as the command line names it."""

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TypeVar

from drystone.errors import DrystoneError, UsageError, extra
from drystone.search.processes import MUCH_MEMORY, process_pool
from drystone_lab.runs.outcome import RunOutcome, RunWorker, died, execute, one_by_one
from drystone_lab.runs.spec import RunSpec

OPTION = "--dask"


@contextmanager
def cluster_at_work(address: str, *, patience_s: float = 5.0) -> Iterator[RunWorker]:
    """Have runs done by a Dask cluster, as long as the block lasts; it has a time to answer.

    The runs of a worker that dies are done by others; one at which so many workers died that the
    scheduler gives it up (``distributed.scheduler.allowed-failures``, 3 unless it is set there)
    is E402.  Workers may come and go, and should have one thread each (``dask worker --nthreads
    1``): threads of one process wait for each other.  Those that a nanny starts, which is Dask's
    custom, have one thread in BLAS, as they should.

    Published stones are read by the workers: from the folder that is given here if it is there on
    the worker's machine, else from the folder that ``DRYSTONE_DATA`` names there.  A file of
    one's own is read here, and its stones are sent.
    """
    cure = ", or use --jobs"
    distributed = extra("distributed", "is what asks a cluster", OPTION, "dask", "E403", cure)
    client = _client(distributed, address, patience_s)
    try:
        check_versions(client)
        yield partial(_outcomes, distributed, client)
    finally:
        client.close()


def check_versions(client: Any) -> None:
    """Compare the versions of this package on a cluster."""
    found = dict(client.run(version, "drystone", on_error="return"))
    try:
        found["scheduler"] = client.run_on_scheduler(version, "drystone")
    except PackageNotFoundError as error:
        found["scheduler"] = error
    here = version("drystone")
    others = {
        name: "none" if isinstance(one, PackageNotFoundError) else one
        for name, one in sorted(found.items())
        if one != here
    }
    if others:
        listed = ", ".join(f"{one} at {name}" for name, one in others.items())
        raise _other_version(f"drystone is {here} here, and {listed}.")


def execute_there(spec: RunSpec, data: Path | None) -> RunOutcome:
    """Plan the wall of a run, on a worker.

    `data` is the folder here; if it is not there on this machine, that of ``DRYSTONE_DATA``.
    """
    if data is not None and not data.is_dir():
        data = Path(os.environ.get("DRYSTONE_DATA", data))
    return execute(spec, data)


def _client(distributed: Any, address: str, patience_s: float) -> Any:
    """Return a client of a cluster that has a worker."""
    cure = "Start `dask scheduler` and `dask worker`, and give the address that they name."
    what = f"no Dask scheduler answers at {address}."
    client = None
    try:
        client = distributed.Client(address, timeout=patience_s, set_as_default=False)
        what = f"the Dask cluster at {address} has no workers."
        client.wait_for_workers(1, timeout=patience_s)
    except (OSError, ValueError, AssertionError) as error:
        # A timeout is an OSError; Dask asserts that its own loop began within ten seconds.
        if client is not None:
            client.close()
        raise UsageError("E404", what, where=OPTION, cure=cure) from error
    return client


def _outcomes(
    distributed: Any, client: Any, specs: Sequence[RunSpec], data: Path | None
) -> Iterator[RunOutcome]:
    if not specs:
        return
    # pure: another client of the cluster may ask for the same run with another folder of data.
    futures = client.map(execute_there, specs, [data] * len(specs), pure=False)
    spec_of = {future.key: spec for future, spec in zip(futures, specs, strict=True)}
    asked = {future.key: future for future in futures}
    ended = distributed.as_completed(futures, loop=client.loop)
    del futures
    try:
        for future in ended:
            spec = spec_of[future.key]
            try:
                outcome: RunOutcome = future.result()
            except distributed.KilledWorker as error:
                raise died(spec, "workers, one after the other,") from error
            except CancelledError as error:
                what = "the connection to the Dask cluster was lost."
                cure = "Give the same command again when it is back: the runs that ended are kept."
                raise DrystoneError("E404", what, where=OPTION, cure=cure) from error
            if outcome.key != spec.key:
                raise _other_version("a worker that joined the Dask cluster has another drystone.")
            # The cluster would do it again if it lost what somebody still holds.
            asked.pop(future.key).release()
            yield outcome
    except (KeyboardInterrupt, Exception):
        for key, future in asked.items():
            if future.status == "finished" and future.result().key == spec_of[key].key:
                yield future.result()
        raise
    finally:
        client.cancel(list(asked.values()))


def _other_version(what: str) -> UsageError:
    return UsageError(
        "E405", what, where=OPTION, cure="Install the same version everywhere; outcomes would mix."
    )


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


class Crew(AbstractContextManager["Crew"]):
    """Processes with one worker each, so that it is known at which task one died.

    They end with the block, whatever they do then.  With `fresh` each task has a new process: what
    one remembers takes no time from another.
    """

    def __init__(self, jobs: int, *, fresh: bool = False) -> None:
        self.free = [_process() for _ in range(jobs)]
        self.fresh = fresh

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
                    if self.fresh or isinstance(error, BrokenProcessPool):
                        process.shutdown(wait=True, kill_workers=True)
                        process = _process()
                    self.free.append(process)
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
