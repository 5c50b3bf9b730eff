"""An anytime search: first walls from many seeds, then chains that share their best; and again.

Once chains find nothing better for long, another round begins with other first walls.  Everything
that is drawn depends on the seed and on the number of a wall, and what chains share on how many
walls they have built: the same budget gives the same wall, however many processes work and whatever
the clock says.  The clock decides only how large the budget is.  So a search that was cut off goes
on from where it stood (:mod:`drystone.search.standing`) to the same walls.
"""

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
from drystone.search.standing import Chains, PackedLink, Progress, Reached, Standing
from drystone.search.work import Job, more_links, one_pass

NOTABLE = 0.01
"""A round goes on for walls that are so much better, in units of merit, than at the last time."""

PROMISING = 32
"""Walls of a chain after which planned walls are worth no more than their merit."""

Result = TypeVar("Result")


def searching(
    start: Found | Standing,
    workshop: Workshop,
    settings: PlannerSettings,
    seed: int,
    *,
    until: Deadline = NEVER,
    executor: Executor | None = None,
) -> Iterator[Progress]:
    """Look for better walls than a first one."""
    tools = pickle.dumps((workshop.stones, workshop.site, settings))
    job = Job(tools, seed, until)
    if isinstance(start, Standing):
        at = start
        yield _Round(at.number, at.before, job, settings, executor).again(at)
    else:
        with suppress(TimeIsUp):
            start = start.judged(workshop, settings, until=until)
        first = Packed.of(start)
        yield Progress(1, first, first.solves, archived((), [first]))
        if settings.search.budget == 1:
            return
        # Its wedges are told of with the next wall: a search that ends before that is repeated by
        # the budget 1, which is the wall without them.
        try:
            until.look()
            at = Standing(0, None, (Packed.of(wedged(start, workshop, settings, until)),))
        except TimeIsUp:
            return
    while True:
        one = _Round(at.number, at.before, job, settings, executor)
        chains = at.chains or (yield from one.first_walls(at.found))
        before = None if chains is None else (yield from one.improved(chains))
        if before is None:
            return
        at = Standing(at.number + 1, before, ())


@dataclass(frozen=True, eq=False)
class _Round:
    """First walls and chains until they find nothing better: what all of it goes by."""

    number: int  # Of the round, from 0
    before: Reached | None  # What the rounds before it came to
    job: Job  # See `searching`
    settings: PlannerSettings
    executor: Executor | None

    @property
    def search(self) -> SearchSettings:
        """Settings with the budget that is left to this round.

        A search may go on with a smaller budget than it had, which ends it.
        """
        search = self.settings.search
        spent = self.before.walls if self.before else 0
        return replace(search, budget=max(1, search.budget - spent))

    def again(self, at: Standing) -> Progress:
        """Say what a search had come to that goes on from where it stood."""
        reached = at.chains.reached if at.chains else _together(at.found)
        return self._after(reached, at)

    def first_walls(self, found: Sequence[Packed]) -> Generator[Progress, None, Chains | None]:
        """Add first walls to those that are found; return what chains begin with.

        None where time is up.
        """
        search = self.search
        reached = _together(found) if found else None
        while (batch := next_batch(found, search)) is not None:
            numbers, share = batch
            tasks = [(self.job, self.number * search.passes + k, share) for k in numbers]
            for wall in _mapped(self.executor, one_pass, tasks):
                if wall is None:
                    return None
                found = (*found, wall)
                reached = _together([wall], reached)
                yield self._after(reached, Standing(self.number, self.before, found))
        assert reached is not None  # noqa: S101 - a round has at least one first wall
        links = tuple(_links(found, self.number, search.chains))
        return Chains(reached, links, 0, reached.walls, reached.best.merit + NOTABLE)

    def improved(self, at: Chains) -> Generator[Progress, None, Reached | None]:
        """Improve the first walls; return what another round begins after, None at the end."""
        search = self.search
        while at.reached.walls < search.budget:
            left = search.budget - at.reached.walls + at.turn * search.share_every
            counts = _shares(left, search.chains, search.share_every)
            asked = range(at.turn, sum(count > 0 for count in counts))
            tasks = [(self.job, at.links[k], counts[k]) for k in asked]
            for link, k in zip(_mapped(self.executor, more_links, tasks), asked, strict=True):
                if link is None:
                    return None
                built = link.done - at.links[k].done
                at = _lengthened(at, link, built)
                whole = built == search.share_every
                standing = Standing(self.number, self.before, (), at) if whole else None
                yield self._after(at.reached, standing)
                if built < counts[k]:
                    # It became too late; what later chains have built is not in the budget.
                    return None
            best, walls = at.reached.best, at.reached.walls
            if best.merit >= at.goal:
                at = replace(at, better=walls, goal=best.merit + NOTABLE)
            if walls - at.better >= search.patience * len(best.groups) and walls < search.budget:
                return self._in_all(at.reached)
            at = replace(at, links=tuple(_shared(_knowing(at.links))), turn=0)
        return None

    def _after(self, reached: Reached, standing: Standing | None) -> Progress:
        """Say how far the search is, from what this round has come to."""
        whole = self._in_all(reached)
        return Progress(whole.walls, whole.best, whole.solves, whole.kept, standing)

    def _in_all(self, reached: Reached) -> Reached:
        """Add what the rounds before have come to."""
        before = self.before
        if before is None:
            return reached
        return Reached(
            before.walls + reached.walls,
            _best([before.best, reached.best]),
            before.solves + reached.solves,
            archived(before.kept, reached.kept),
        )


def _together(walls: Sequence[Packed], before: Reached | None = None) -> Reached:
    """Add first walls to what a round has come to, one after the other."""
    for wall in walls:
        before = (
            Reached(1, wall, wall.solves, archived((), [wall]))
            if before is None
            else Reached(
                before.walls + 1,
                _best([before.best, wall]),
                before.solves + wall.solves,
                archived(before.kept, [wall]),
            )
        )
    assert before is not None  # noqa: S101 - there is at least one
    return before


def _lengthened(at: Chains, link: PackedLink, built: int) -> Chains:
    """Add the walls of the chain whose turn it is."""
    reached, last = at.reached, at.links[at.turn]
    reached = Reached(
        reached.walls + built,
        _best([reached.best, link.best]),
        reached.solves + link.solves - last.solves,
        archived(reached.kept, link.kept),
    )
    links = (*at.links[: at.turn], replace(link, kept=()), *at.links[at.turn + 1 :])
    return replace(at, reached=reached, links=links, turn=at.turn + 1)


def _best(walls: Sequence[Packed]) -> Packed:
    """Return the best wall; of equal ones the first."""
    return max(walls, key=lambda wall: wall.merit)


def _links(found: Sequence[Packed], number: int, chains: int) -> list[PackedLink]:
    """Begin a round's chains from the most promising; from the first again where there are few."""
    order = sorted(range(len(found)), key=lambda k: (-promised(found[k]), k))
    starts = [found[order[k] if k < len(order) else order[0]] for k in range(chains)]
    first = number * chains
    return [PackedLink(first + k, 0, start, start, Solves()) for k, start in enumerate(starts)]


def _shares(left: int, chains: int, each: int) -> list[int]:
    """Say how many walls each chain builds next: all the same, but for the end of the budget."""
    return [min(each, max(0, left - k * each)) for k in range(chains)]


def _knowing(links: Sequence[PackedLink]) -> list[PackedLink]:
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
