"""An anytime search: first walls from many seeds, then chains that share their best; and again.

Once chains find nothing better for long, another round begins with other first walls.  Everything
that is drawn depends on the seed and on the number of a wall, and what chains share on how many
walls they have built: the same budget gives the same wall, however many processes work and whatever
the clock says.  The clock decides only how large the budget is.
"""

import itertools
import pickle
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TypeVar

from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.search_settings import SearchSettings
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

NOTABLE = 0.01
"""A round goes on for walls that are so much better, in units of merit, than at the last time."""

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
    until: Deadline = NEVER,
    executor: Executor | None = None,
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
    until : Deadline
        Ends the search, as far as the budget does not end it before.  A wall that is not whole by
        then is none.
    executor : concurrent.futures.Executor, optional
        Processes that build walls side by side; the walls do not depend on it.

    Yields
    ------
    Progress
        After the first wall, and whenever walls have been added.
    """
    tools = pickle.dumps((workshop.stones, workshop.site, settings))
    job = Job(tools, seed, until)
    with suppress(TimeIsUp):
        first = first.judged(workshop, settings, until=until)
    search, start = settings.search, Packed.of(first)
    yield Progress(1, start, start.solves, archived((), [start]))
    if search.budget == 1:
        return
    # Its wedges are told of with the next wall: a search that ends before that is repeated by the
    # budget 1, which is the wall without them.
    try:
        until.look()
        found = [Packed.of(wedged(first, workshop, settings, until))]
    except TimeIsUp:
        return
    before: Progress | None = None
    for number in itertools.count():
        one = _Round(number, before, job, settings, executor)
        kept = yield from one.first_walls(found)
        before = None if kept is None else (yield from one.chains(found, kept))
        if before is None:
            return
        found = []


@dataclass(frozen=True, eq=False)
class _Round:
    """First walls and chains until they find nothing better: what all of it goes by.

    Parameters
    ----------
    number : int
        Of the round, from 0.
    before : Progress or None
        What the rounds before it came to.
    job, settings, executor
        See :func:`searching`.
    """

    number: int
    before: Progress | None
    job: Job
    settings: PlannerSettings
    executor: Executor | None

    @property
    def search(self) -> SearchSettings:
        """Settings with the budget that is left to this round."""
        search = self.settings.search
        spent = self.before.walls if self.before else 0
        return replace(search, budget=search.budget - spent)

    def first_walls(
        self, found: list[Packed]
    ) -> Generator[Progress, None, tuple[Packed, ...] | None]:
        """Add first walls to those that are found; return which to keep, None where time is up."""
        search, geometry = self.search, self.settings.geometry
        kept = archived((), found)
        while (batch := next_batch(found, search, geometry)) is not None:
            numbers, share = batch
            tasks = [(self.job, self.number * search.passes + k, share) for k in numbers]
            for wall in _mapped(self.executor, one_pass, tasks):
                if wall is None:
                    return None
                found.append(wall)
                kept = archived(kept, [wall])
                yield self._after(len(found), _best(found), _all_solves(found), kept)
        return kept

    def chains(
        self, found: Sequence[Packed], kept: tuple[Packed, ...]
    ) -> Generator[Progress, None, Progress | None]:
        """Improve the first walls; return where another round begins, None where it is the end."""
        search = self.search
        links = _links(found, self.number, search.chains)
        walls, before, best = len(found), _all_solves(found), _best(found)
        better, goal = walls, best.merit + NOTABLE
        while walls < search.budget:
            counts = _shares(search.budget - walls, search.chains, search.share_every)
            tasks = [(self.job, link, n) for link, n in zip(links, counts, strict=True) if n]
            for k, link in enumerate(_mapped(self.executor, more_links, tasks)):
                if link is None:
                    return None
                built = link.done - links[k].done
                links[k] = link
                walls += built
                best = _best([best, link.best])
                kept = archived(kept, link.kept)
                progress = self._after(walls, best, before + _all_solves(links), kept)
                yield progress
                if built < counts[k]:
                    # It became too late; what later chains have built is not in the budget.
                    return None
            if best.merit >= goal:
                better, goal = walls, best.merit + NOTABLE
            if walls - better >= search.patience * len(best.groups) and walls < search.budget:
                return progress
            links = _shared(_knowing(links))
        return None

    def _after(
        self, walls: int, best: Packed, solves: Solves, kept: tuple[Packed, ...]
    ) -> Progress:
        """Say how far the search is, from what this round has come to."""
        if self.before is None:
            return Progress(walls, best, solves, kept)
        return Progress(
            self.before.walls + walls,
            _best([self.before.best, best]),
            self.before.solves + solves,
            archived(self.before.kept, kept),
        )


def _best(walls: Sequence[Packed]) -> Packed:
    """Return the best wall; of equal ones the first."""
    return max(walls, key=lambda wall: wall.merit)


def _all_solves(walls: Sequence[Packed] | Sequence[PackedLink]) -> Solves:
    return sum((wall.solves for wall in walls), Solves())


def _links(found: Sequence[Packed], number: int, chains: int) -> list[PackedLink]:
    """Begin a round's chains from the most promising; from the first again where there are few."""
    order = sorted(range(len(found)), key=lambda k: (-promised(found[k]), k))
    starts = [found[order[k] if k < len(order) else order[0]] for k in range(chains)]
    first = number * chains
    return [PackedLink(first + k, 0, start, start, Solves()) for k, start in enumerate(starts)]


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
