"""An anytime search: first walls from many seeds, then chains that share their best.

Everything that is drawn depends on the seed and on the number of a wall, and what chains share on
how many walls they have built: the same budget gives the same wall, however many processes work
and whatever the clock says.  The clock decides only how large the budget is.
"""

import math
import pickle
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import TypeVar

from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.planner.workshop import Workshop
from drystone.search.archive import archived
from drystone.search.chain import wedged
from drystone.search.first_walls import next_batch, promised
from drystone.search.found import Found
from drystone.search.operators import Credits
from drystone.search.packed import Packed
from drystone.search.work import Job, PackedLink, more_links, one_pass

PROMISING = 32
"""Walls of a chain after which planned walls are worth no more than their merit."""

Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class Progress:
    """How far a search is.

    Parameters
    ----------
    walls : int
        How many walls it has built that count: the budget that repeats it.
    best : Packed
        The best of them.
    solves : Solves
        What trouble there was with all of them.
    kept : tuple of Packed
        Those that none beats in every figure of merit (:mod:`drystone.search.archive`).
    """

    walls: int
    best: Packed
    solves: Solves
    kept: tuple[Packed, ...]


def searching(
    first: Found,
    workshop: Workshop,
    settings: PlannerSettings,
    seed: int,
    *,
    seconds: float = math.inf,
    executor: Executor | None = None,
    clock: Callable[[], float] = time.time,
) -> Iterator[Progress]:
    """Look for better walls than a first one.

    Parameters
    ----------
    first : Found
        The wall of the seed itself.
    workshop : Workshop
        Stones and site.
    settings : PlannerSettings
        All parameters; those of the search say how many walls are built at most.
    seed : int
        Of everything that is drawn.
    seconds : float
        Time after which no further wall is begun, as far as the budget does not end before.
    executor : concurrent.futures.Executor, optional
        Processes that build walls side by side; the walls do not depend on it.
    clock : callable
        Gives the seconds, in every process the same.

    Yields
    ------
    Progress
        After the first wall, and whenever walls have been added.
    """
    tools = pickle.dumps((workshop.stones, workshop.site, settings))
    job = Job(tools, seed, clock() + seconds, clock)
    search, start = settings.search, Packed.of(first)
    yield Progress(1, start, start.solves, archived((), [start]))
    if search.budget == 1 or job.late():
        return
    # Its wedges are told of with the next wall: a search that ends before that is repeated by the
    # budget 1, which is the wall without them.
    found = [Packed.of(wedged(first, workshop, settings))]
    kept = archived((), found)
    while (batch := next_batch(found, search, settings.geometry)) is not None:
        numbers, share = batch
        for wall in _mapped(executor, one_pass, [(job, number, share) for number in numbers]):
            if wall is None:
                return
            found.append(wall)
            kept = archived(kept, [wall])
            yield Progress(len(found), _best(found), _all_solves(found), kept)
    links = _links(found, search.chains)
    walls, before, best = len(found), _all_solves(found), _best(found)
    while walls < search.budget:
        counts = _shares(search.budget - walls, search.chains, search.share_every)
        tasks = [(job, link, count) for link, count in zip(links, counts, strict=True) if count]
        for k, link in enumerate(_mapped(executor, more_links, tasks)):
            if link is None:
                return
            built = link.done - links[k].done
            links[k] = link
            walls += built
            best = _best([best, link.best])
            kept = archived(kept, link.kept)
            yield Progress(walls, best, before + _all_solves(links), kept)
            if built < counts[k]:
                return  # it became too late; what later chains have built is not in the budget
        links = _shared(_knowing(links))


def _best(walls: Sequence[Packed]) -> Packed:
    """Return the best wall; of equal ones the first."""
    return max(walls, key=lambda wall: wall.merit)


def _all_solves(walls: Sequence[Packed] | Sequence[PackedLink]) -> Solves:
    return sum((wall.solves for wall in walls), Solves())


def _links(found: Sequence[Packed], chains: int) -> list[PackedLink]:
    """Begin a chain from each of the most promising; from the first again where there are few."""
    order = sorted(range(len(found)), key=lambda k: (-promised(found[k]), k))
    starts = [found[order[k] if k < len(order) else order[0]] for k in range(chains)]
    return [PackedLink(k, 0, start, start, Solves()) for k, start in enumerate(starts)]


def _shares(left: int, chains: int, each: int) -> list[int]:
    """Say how many walls each chain builds next: all the same, but for the end of the budget."""
    return [min(each, max(0, left - k * each)) for k in range(chains)]


def _knowing(links: list[PackedLink]) -> list[PackedLink]:
    """Let all chains know which changes have helped in each."""
    known = sum((link.learnt for link in links), links[0].known)
    return [replace(link, known=known, learnt=Credits()) for link in links]


def _shared(links: list[PackedLink]) -> list[PackedLink]:
    """Let the chain that is furthest behind go on from the wall that is best or promises most."""
    worth = [promised(link.best, max(0.0, 1.0 - link.done / PROMISING)) for link in links]
    first, last = worth.index(max(worth)), worth.index(min(worth))
    if worth[last] < worth[first]:
        best = links[first].best
        links[last] = replace(links[last], now=best, best=best)
    return links


def _mapped(
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
