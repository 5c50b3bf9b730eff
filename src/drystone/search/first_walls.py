"""Which of the first walls of a search are planned course by course: more, the better they do."""

from collections.abc import Iterator, Sequence

from drystone.search.packed import Packed

BATCH = 4
"""Walls after which it is looked how the planned ones do: however many processes there are."""

SHARE, WEIGHT = 0.75, 2.0
"""The share of the first walls that are planned before anything is known, and for how many walls
that counts."""


def batches(count: int) -> Iterator[range]:
    """List the numbers of the walls after the very first one, batch by batch.

    Examples
    --------
    >>> [list(batch) for batch in batches(7)]
    [[1, 2, 3], [4, 5, 6]]
    """
    for start in range(0, count, BATCH):
        yield range(max(1, start), min(start + BATCH, count))


def planned_share(found: Sequence[Packed]) -> float:
    """Return the share of the next walls that are planned: that of the better half so far.

    On stones of masons plans win; stones with many corners are laid too unlike their plans.

    Parameters
    ----------
    found : sequence of Packed
        All first walls so far.

    Returns
    -------
    float
        In (0, 1).
    """
    order = sorted(range(len(found)), key=lambda k: (-found[k].merit, k))
    better = [found[k] for k in order[: (len(found) + 1) // 2]] if len(found) > 1 else []
    planned = sum(wall.courses is not None for wall in better)
    return (planned + SHARE * WEIGHT) / (len(better) + WEIGHT)
