"""An anytime search: first walls from many seeds, then chains that share their best; and again.

Once chains find nothing better for long, another round begins with other first walls.  Everything
that is drawn depends on the seed and on the number of a wall, and what chains share on how many
walls they have built: the same budget gives the same wall, however many processes work and whatever
the clock says.  The clock decides only how large the budget is.  So a search that was cut off goes
on from where it stood (:mod:`drystone.search.state`) to the same walls.
"""

from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass, replace

from drystone.planner.build import Solves
from drystone.planner.deadline import TimeIsUp
from drystone.planner.search_settings import SearchSettings
from drystone.search.chain import Job, more_links, one_pass, wedged
from drystone.search.goal import FoundWall
from drystone.search.operators import Credits
from drystone.search.packed import PackedWall
from drystone.search.processes import mapped
from drystone.search.state import Chains, Link, Progress, Reached, SearchState, made_of
from drystone.search.yard import Yard

NOTABLE = 0.01
"""A round goes on for walls that are so much better, in units of merit, than at the last time."""

PROMISING = 32
"""Walls of a chain after which planned walls are worth no more than their merit."""

BATCH = 4
"""Walls after which it is looked how the planned ones do: however many processes there are."""

SHARE = 0.75
"""The share of the first walls that are planned before anything is known."""

WEIGHT = 2.0
"""For how many walls that counts."""

STALE = 8
"""After so many first walls that are not better than one that was not planned there are no more."""

PROMISE = 0.6
"""So much more than others, in units of merit, planned walls win by the changes of chains."""


def searching(
    start: FoundWall | SearchState, yard: Yard, seed: int, executor: Executor | None = None
) -> Iterator[Progress]:
    """Look for better walls than that of the seed itself, or go on from where a search was cut off.

    Yields what it has come to after the first wall, or when it goes on, and whenever walls have
    been added.  It ends with the budget or with the time of the yard; a wall that is not whole by
    then is none.  The walls do not depend on the processes that build them.
    """
    job = Job.of(yard, seed)
    if isinstance(start, SearchState):
        at = start
        yield Progress(**vars(at.reached), state=at)
    else:
        with suppress(TimeIsUp):
            start = start.judged(yard)
        yield Progress(**vars(Reached.of([PackedWall.of(start)])))
        # Its wedges are told of with the next wall: a search that ends before that is repeated by
        # the budget 1, which is the wall without them.
        try:
            yard.until.look()
            at = SearchState(made_of(yard, seed), 0, None, (PackedWall.of(wedged(start, yard)),))
        except TimeIsUp:
            return
    while True:
        one = _Round(at, job, yard.settings.search, executor)
        chains = at.chains or (yield from one.first_walls())
        before = None if chains is None else (yield from one.improved(chains))
        if before is None:
            return
        at = SearchState(at.made_of, at.number + 1, before, ())


@dataclass(frozen=True, eq=False)
class _Round:
    """First walls and chains until they find nothing better: what all of it goes by."""

    start: SearchState  # where it goes on from
    job: Job
    search: SearchSettings
    executor: Executor | None

    @property
    def budget(self) -> int:
        """What is left to this round.

        A search may go on with a smaller budget than it had, which ends it.
        """
        before = self.start.before
        return max(1, self.search.budget - (before.walls if before else 0))

    def first_walls(self) -> Generator[Progress, None, Chains | None]:
        """Add first walls to those that are found; return what chains begin with.

        None where time is up.
        """
        found, round_number = self.start.found, self.start.number
        search = replace(self.search, budget=self.budget)
        while (batch := next_batch(found, search)) is not None:
            numbers, share = batch
            tasks = [(self.job, round_number * search.passes + k, share) for k in numbers]
            for wall in mapped(self.executor, one_pass, tasks):
                if wall is None:
                    return None
                found = (*found, wall)
                state = replace(self.start, found=found)
                yield Progress(**vars(state.reached), state=state)
        reached = Reached.of(found)
        links = tuple(_links(found, round_number, search.chains))
        return Chains(reached, links, 0, reached.walls, reached.best.merit + NOTABLE)

    def improved(self, at: Chains) -> Generator[Progress, None, Reached | None]:
        """Improve the first walls; return what another round begins after, None at the end."""
        search, budget = self.search, self.budget
        each = search.share_every
        while at.reached.walls < budget:
            left = budget - at.reached.walls + at.turn * each
            # All chains build as many walls, but for the end of the budget.
            counts = [min(each, max(0, left - k * each)) for k in range(search.chains)]
            asked = range(at.turn, sum(count > 0 for count in counts))
            tasks = [(self.job, at.links[k], counts[k]) for k in asked]
            for link, k in zip(mapped(self.executor, more_links, tasks), asked, strict=True):
                if link is None:
                    return None
                built = link.done - at.links[k].done
                more = Reached(built, link.best, link.solves - at.links[k].solves, link.kept)
                links = (*at.links[:k], replace(link, kept=()), *at.links[k + 1 :])
                at = replace(at, reached=at.reached + more, links=links, turn=k + 1)
                state = replace(self.start, found=(), chains=at)
                yield Progress(**vars(state.reached), state=state if built == each else None)
                if built < counts[k]:
                    # It became too late; what later chains have built is not in the budget.
                    return None
            best, walls = at.reached.best, at.reached.walls
            if best.merit >= at.goal:
                at = replace(at, better=walls, goal=best.merit + NOTABLE)
            if walls - at.better >= search.patience * len(best.groups) and walls < budget:
                return replace(self.start, found=(), chains=at).reached
            # All chains know then which changes have helped in each.
            known = sum((link.learnt for link in at.links), at.links[0].known)
            again = [replace(link, known=known, learnt=Credits()) for link in at.links]
            at = replace(at, links=tuple(_shared(again)), turn=0)
        return None


def _links(found: Sequence[PackedWall], number: int, chains: int) -> list[Link]:
    """Begin a round's chains from the most promising; from the first again where there are few."""
    order = sorted(found, key=promised, reverse=True)
    starts = [order[k] if k < len(order) else order[0] for k in range(chains)]
    first = number * chains
    return [Link(first + k, 0, start, start, Solves()) for k, start in enumerate(starts)]


def _shared(links: list[Link]) -> list[Link]:
    """Let the chain that is furthest behind go on from the wall that is best or promises most."""
    worth = [promised(link.best, max(0.0, 1.0 - link.done / PROMISING)) for link in links]
    first, last = worth.index(max(worth)), worth.index(min(worth))
    if worth[last] < worth[first]:
        best = links[first].best
        links[last] = replace(links[last], now=best, best=best)
    return links


def promised(wall: PackedWall, share: float = 1.0) -> float:
    """Return what a wall is worth as a start.

    A planned one promises something beyond its merit; the share of it is what is still to come.
    """
    return wall.merit + (0.0 if wall.courses is None else share * PROMISE)


def next_batch(found: Sequence[PackedWall], search: SearchSettings) -> tuple[range, float] | None:
    """Return the numbers of the next first walls of a round, and which share of them is planned.

    None when there are enough, and it is time to improve the best of them.
    """
    done = len(found)
    # Of a batch that is begun all is as when it began; the very first wall is of the first batch.
    before = found[: done - done % BATCH]
    if done >= search.passes or (before and stale(before)):
        return None
    end = min(len(before) + BATCH, search.passes, search.budget)
    return (range(done, end), planned_share(before)) if end > done else None


def stale(found: Sequence[PackedWall]) -> bool:
    """Say whether it is time to improve the best wall, as the last were none better.

    Never of a planned wall: improving it wins less than another plan may.
    """
    best = max(range(len(found)), key=lambda k: promised(found[k]))
    return found[best].courses is None and len(found) - 1 - best >= STALE


def planned_share(found: Sequence[PackedWall]) -> float:
    """Return the share of the next walls that are planned: that of the better half so far.

    On stones of masons plans win; stones with many corners are laid too unlike their plans.
    """
    order = sorted(found, key=promised, reverse=True)
    better = order[: (len(found) + 1) // 2] if len(found) > 1 else []
    planned = sum(wall.courses is not None for wall in better)
    return (planned + SHARE * WEIGHT) / (len(better) + WEIGHT)
