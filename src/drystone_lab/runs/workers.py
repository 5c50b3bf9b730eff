"""Who does runs, as the command line names it."""

from collections.abc import Iterator
from contextlib import contextmanager

from drystone.errors import UsageError
from drystone_lab.runs.cluster import cluster_at_work
from drystone_lab.runs.processes import processes_at_work
from drystone_lab.runs.runner import Work


@contextmanager
def work_of(jobs: int | None, dask_address: str | None) -> Iterator[Work]:
    """Have runs done by whom the options say, as long as the block lasts.

    Whoever works, outcomes differ in their times alone.

    Parameters
    ----------
    jobs : int or None
        Processes on this machine, 1 or more (``--jobs``); None when the option is not given,
        which is 1.
    dask_address : str or None
        Of the scheduler of a Dask cluster (``--dask``); None when the option is not given.

    Raises
    ------
    UsageError
        E138: both are given, or `jobs` is below 1; E403, E404, E405 of
        :func:`~drystone_lab.runs.cluster.cluster_at_work`.

    Examples
    --------
    >>> from drystone_lab.runs.source import generated
    >>> from drystone_lab.runs.spec import RunSpec
    >>> bricks = generated("brick", 1, count=6, height_px=10, aspect=2)
    >>> with work_of(1, None) as work:
    ...     (outcome,) = work([RunSpec(source=bricks, width=60, height=20)], None)
    >>> outcome.figures["placed"]
    6
    """
    if jobs is not None and dask_address is not None:
        raise UsageError(
            "E138",
            "processes here and a Dask cluster are asked for, and only one of them can work.",
            where="--jobs, --dask",
            cure="Give one of the two; a cluster's workers are its own.",
        )
    if jobs is not None and jobs < 1:
        raise UsageError(
            "E138", f"{jobs} processes can do nothing.", where="--jobs", cure="Give 1 or more."
        )
    at_work = (
        processes_at_work(jobs or 1) if dask_address is None else cluster_at_work(dask_address)
    )
    with at_work as work:
        yield work
