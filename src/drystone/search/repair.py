"""Repairs of the best wall of a search: what is weak in it is laid elsewhere, wedged or left open.

A search chooses among many walls by few rehearsals, so its best one owes much to luck with them.
Repairs are chosen by other rehearsals in every turn, and those asked for by others once more.
"""

import pickle
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.planner import Planner
from drystone.planner.vary import REPAIR_DRAWS
from drystone.search.chain import Job, without
from drystone.search.goal import (
    LAST_RUNS,
    THOROUGH,
    FoundWall,
    Rehearsals,
    is_high,
    stays_at_every_step,
)
from drystone.search.packed import PackedWall, found_again
from drystone.search.processes import mapped
from drystone.search.ruin import around
from drystone.search.wedging import one_more_wedge
from drystone.search.yard import Yard
from drystone.statics.flow.flow_search import NonassociativeSettings

TURNS, MISSES = 16, 3
"""So often repairs are looked for at most; after so many turns in vain there is an end."""

WORTH, LOWER = 0.1, 0.5
"""Merit that a repair gains at least, and one that makes a complete wall too low."""

LOOK_RUNS = 24
"""So often repairs are rehearsed until it is known which could be better."""

WEDGED = 4
"""So many of the stones that fall first get one more wedge in turn, wherever there is room."""

AROUND = 2
"""So many stones around one that falls first are taken out together, at first."""


class Change(NamedTuple):
    """What is tried with a wall."""

    stones: frozenset[int]
    wedged: bool  # one more wedge under the only one; else they are taken out together


Repair = tuple[PackedWall, tuple[int, ...]]
"""A wall, and the stones that move when it fails."""


def repairs(
    planner: Planner,
    best: FoundWall,
    until: Deadline = NEVER,
    turns: int = TURNS,
    executor: Executor | None = None,
) -> Iterator[FoundWall]:
    """Yield after every turn a wall without what is weak in it, where that is better.

    Weak are the stones that fall first in its rehearsals, that are laid when falls begin, and that
    move when it fails.  The weakest one is taken out, or all are, or some around it; what they
    leave is built up again or stays open.  Or one of the first that fall gets one more wedge.
    What is better is rehearsed again with other errors, for the best of many has luck with those
    that chose it; the best goes on.  TimeIsUp: before a turn was at its end.
    """
    yard = Yard.of(planner, until)
    job = Job.of(yard, planner.seed)
    (_, first, begins), misses = best.falls, 0
    try:
        for turn in range(turns):
            now = best.judged(yard, rehearsals=Rehearsals(yard, LOOK_RUNS, 2 + 2 * turn))
            first, begins = first + now.falls.first, begins + now.falls.begins
            asked = job, pickle.dumps(PackedWall.of(best)), turn
            changes = _changes(best, first, begins, misses)
            tasks = [(*asked, number, change) for number, change in enumerate(changes)]
            found: dict[object, Repair] = {}
            for walls in mapped(executor, changed, tasks):
                if walls is None:
                    raise TimeIsUp
                found |= {one.groups: (one, movers) for one, movers in walls}
            better = _surely_better(best, list(found.values()), yard, 3 + 2 * turn)
            if better is not None:
                best, (_, first, begins), misses = better, better.falls, -1
            yield best
            misses += 1
            if misses == MISSES:
                return
    finally:
        _begun.cache_clear()


def _changes(
    wall: FoundWall, first: Counter[int], begins: Counter[int], misses: int
) -> list[Change]:
    """List what is tried with a wall: after turns without a repair, other stones."""
    fall, laid = ([stone for stone, _ in one.most_common()] for one in (first, begins))
    weak: list[Collection[int]] = [one[misses:][:1] for one in (fall, laid, wall.movers)]
    if not misses:
        weak += [fall, wall.movers]
    weak += [around(wall.build, one, AROUND + misses) for one in fall[misses:][:1]]
    sets = dict.fromkeys(frozenset(some) for some in weak if some)
    wedged = fall[WEDGED * misses :][:WEDGED]
    changes = [Change(some, wedged=False) for some in sets]
    return changes + [Change(frozenset([stone]), wedged=True) for stone in wedged]


def changed(job: Job, packed: bytes, turn: int, number: int, change: Change) -> list[Repair] | None:
    """Return walls with a change that could be better; None when time is up."""
    try:
        yard = job.yard
        wall, look = _begun(job, packed, turn)
        if change.wedged:
            (stone,) = change.stones
            wedged = one_more_wedge(wall.build, stone, yard)
            walls = [FoundWall.measured(build, yard, solves) for build, solves in wedged]
        else:
            build, _, solves = without(wall.build, change.stones, yard)
            rng = np.random.default_rng([job.seed, REPAIR_DRAWS, turn, number])
            again = [yard.jointed(joints).built_up(build, rng) for joints in (0, 1)]
            walls = [FoundWall.measured(build, yard, solves)]
            walls += [FoundWall.of(planner, before=solves) for planner in again]
        better = _better(wall, walls, THOROUGH, look, yard)
        return [(PackedWall.of(one), one.movers) for one in better]
    except TimeIsUp:
        return None


def _better(
    best: FoundWall, walls: Sequence[FoundWall], flow: NonassociativeSettings | None,
    rehearsals: Rehearsals, yard: Yard,
) -> list[FoundWall]:  # fmt: skip
    """Judge some walls by rehearsals of the best one, and return those that gain enough."""
    high, found = is_high(best.build.wall), []
    for wall in walls:
        asked = LOWER if high and not is_high(wall.build.wall) else WORTH
        judged = wall.judged(yard, flow, best.merit + asked, rehearsals)
        if judged.merit > best.merit + asked:
            found.append(judged)
    return found


@lru_cache(maxsize=1)
def _begun(job: Job, packed: bytes, turn: int) -> tuple[FoundWall, Rehearsals]:
    """Return the wall that a turn begins with, and its rehearsals, once in each process."""
    yard = job.yard
    wall = found_again(pickle.loads(packed), yard)  # noqa: S301 - packed by the same program
    look = Rehearsals(yard, LOOK_RUNS, 2 + 2 * turn)
    return wall.judged(yard, rehearsals=look), look


def _surely_better(
    best: FoundWall, found: list[Repair], yard: Yard, draws: int
) -> FoundWall | None:
    """Return the best of some walls where it is better by other rehearsals, too."""
    if not found:
        return None
    again = Rehearsals(yard, LAST_RUNS, draws)
    now = best.judged(yard, rehearsals=again)
    walls = [replace(found_again(one, yard), movers=movers) for one, movers in found]
    better = max(_better(now, walls, None, again, yard), key=lambda w: w.merit, default=None)
    stays = better is not None and stays_at_every_step(better.build, yard.until)
    return better if stays else None
