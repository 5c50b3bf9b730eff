"""The first walls of a search: how many, and which of them are planned course by course."""

from collections.abc import Iterator, Sequence

from drystone.search.packed import Packed

BATCH = 4
"""Walls after which it is looked how the planned ones do: however many processes there are."""

SHARE = {"exact": 0.5, "raster": 0.9}
"""The share of the first walls that are planned before anything is known, on each geometry: a pass
on pixels takes up to twice as long as a plan."""

WEIGHT = 2.0
"""For how many walls that counts."""

STALE = 8
"""After so many first walls that are not better than one that was not planned there are no more."""


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
    """Say whether it is time to improve the best wall, as the last were none better.

    Asked after each batch.  Never of a planned wall: improving it wins less than another plan may.
    """
    best = max(range(len(found)), key=lambda k: (found[k].merit, -k))
    return found[best].courses is None and len(found) - 1 - best >= STALE


def planned_share(found: Sequence[Packed], geometry: str) -> float:
    """Return the share of the next walls that are planned: that of the better half so far.

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
    order = sorted(range(len(found)), key=lambda k: (-found[k].merit, k))
    better = [found[k] for k in order[: (len(found) + 1) // 2]] if len(found) > 1 else []
    planned = sum(wall.courses is not None for wall in better)
    return (planned + SHARE[geometry] * WEIGHT) / (len(better) + WEIGHT)
