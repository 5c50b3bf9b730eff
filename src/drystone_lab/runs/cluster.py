"""Runs done by the workers of a Dask cluster."""

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from drystone.errors import DrystoneError, UsageError
from drystone_lab.runs.outcome import RunOutcome, RunWorker, died, execute
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
    try:
        distributed = import_module("distributed")
    except ImportError as error:
        what = "Dask is not installed, and a cluster is asked for."
        cure = "Install it with `pip install 'drystone[dask]'`, or use --jobs."
        raise UsageError("E403", what, where=OPTION, cure=cure) from error
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
    """Do runs."""
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
