"""The first walls of a search: how many, and which of them are planned course by course."""

from collections.abc import Sequence

from drystone.planner.search_settings import SearchSettings
from drystone.search.packed import Packed

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


def promised(wall: Packed, share: float = 1.0) -> float:
    """Return what a wall is worth as a start."""
    return wall.merit + (0.0 if wall.courses is None else share * PROMISE)


def next_batch(found: Sequence[Packed], search: SearchSettings) -> tuple[range, float] | None:
    """Return the numbers of the next first walls, and which share of them is planned."""
    done = len(found)
    # Of a batch that is begun all is as when it began; the very first wall is of the first batch.
    before = found[: done - done % BATCH]
    if done >= search.passes or (before and stale(before)):
        return None
    end = min(len(before) + BATCH, search.passes, search.budget)
    return (range(done, end), planned_share(before)) if end > done else None


def stale(found: Sequence[Packed]) -> bool:
    """Say whether it is time to improve the best wall, as the last were none better.

    Never of a planned wall: improving it wins less than another plan may.
    """
    best = max(range(len(found)), key=lambda k: (promised(found[k]), -k))
    return found[best].courses is None and len(found) - 1 - best >= STALE


def planned_share(found: Sequence[Packed]) -> float:
    """Return the share of the next walls that are planned: that of the better half so far.

    On stones of masons plans win; stones with many corners are laid too unlike their plans.
    """
    order = sorted(range(len(found)), key=lambda k: (-promised(found[k]), k))
    better = [found[k] for k in order[: (len(found) + 1) // 2]] if len(found) > 1 else []
    planned = sum(wall.courses is not None for wall in better)
    return (planned + SHARE * WEIGHT) / (len(better) + WEIGHT)
