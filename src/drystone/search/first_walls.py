"""The first walls of a search: how many, which are planned, and which of them are gone on from."""

import math
from collections.abc import Iterator, Sequence
from itertools import chain, zip_longest
from statistics import fmean, stdev

from drystone.search.packed import Packed

BATCH = 4
"""Walls after which it is looked how the planned ones do: however many processes there are."""

SHARE = {"exact": 0.5, "raster": 0.75}
"""The share of the first walls that are planned before anything is known, on each geometry: on
pixels a plan takes less time than a pass."""

FEW = 3
"""Of so few walls of a kind nothing is known yet."""

TAIL = 2.0
"""The best of some twenty walls is about so many standard deviations above their mean: what counts
is the best, and planned walls differ more from each other than single passes do."""

RARE = 0.2
"""The share of the kind of which no better wall can be expected."""

STALE = 8
"""After so many first walls that are not better than one that was not planned there are no more."""

NEAR = 0.3
"""A wall within so much merit of the best may become better than it: planned ones get better by
more than that while others hardly do."""


def batches(count: int) -> Iterator[range]:
    """List the numbers of the walls after the very first one, batch by batch.

    Examples
    --------
    >>> [list(batch) for batch in batches(7)]
    [[1, 2, 3], [4, 5, 6]]
    """
    for start in range(0, count, BATCH):
        yield range(max(1, start), min(start + BATCH, count))


def stale(found: Sequence[Packed]) -> bool:
    """Say whether it is time to improve the best walls, as the last were none better.

    Asked after each batch.  Not while planned walls may become the best: improving those wins less
    than another plan may.
    """
    best = max(range(len(found)), key=lambda k: (found[k].merit, -k))
    if len(found) - 1 - best < STALE or found[best].courses is not None:
        return False
    return _hopeless(found, planned=True)


def planned_share(found: Sequence[Packed], geometry: str) -> float:
    """Return the share of the next walls that are planned.

    On stones of masons plans win; stones with many corners are laid too unlike their plans.

    Parameters
    ----------
    found : sequence of Packed
        All first walls so far.
    geometry : {"exact", "raster"}
        Of their stones.

    Returns
    -------
    float
        In (0, 1).
    """
    planned, others = (_hopeless(found, planned=kind) for kind in (True, False))
    if planned == others:
        return SHARE[geometry]
    return RARE if planned else 1.0 - RARE


def _hopeless(found: Sequence[Packed], *, planned: bool) -> bool:
    """Say whether the best of some more walls of a kind is not expected to come near the best."""
    merits = [one.merit for one in found if (one.courses is not None) == planned]
    if len(merits) < FEW or -math.inf in merits:
        return False
    expected = fmean(merits) + TAIL * stdev(merits)
    return expected < max(one.merit for one in found) - NEAR


def starts(found: Sequence[Packed], count: int) -> list[Packed]:
    """Choose the walls that chains go on from: the best, by turns planned ones and others.

    Parameters
    ----------
    found : sequence of Packed
        All first walls.
    count : int
        How many chains there are.

    Returns
    -------
    list of Packed
        The best first; by turns as far as both kinds are near it, then the next best, and the
        best again where there are too few.
    """
    order = in_order(found)
    best = found[order[0]]
    near = [k for k in order if found[k].merit >= best.merit - NEAR]
    like = [k for k in near if (found[k].courses is None) == (best.courses is None)]
    unlike = [k for k in near if k not in like]
    turns = [k for k in chain(*zip_longest(like, unlike)) if k is not None]
    chosen = [*turns, *(k for k in order if k not in turns)][:count]
    return [found[k] for k in chosen] + [best] * (count - len(chosen))


def in_order(found: Sequence[Packed]) -> list[int]:
    """Return the positions of some walls, the best first."""
    return sorted(range(len(found)), key=lambda k: (-found[k].merit, k))
