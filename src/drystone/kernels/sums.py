"""How much of a length stones can fill, side by side or on top of each other."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray


def unfillable(lengths: Iterable[tuple[int, ...]], limit: int) -> NDArray[np.int64]:
    """Return for every length up to a limit what is left over at best.

    Parameters
    ----------
    lengths : iterable of tuples of int
        The lengths of each stone, of which one may be used, once; positive.
    limit : int
        Largest length asked for.

    Returns
    -------
    rest : (limit + 1,) int array
        rest[f] is f minus the largest sum of lengths that is at most f.

    Examples
    --------
    >>> unfillable([(3,), (4, 5)], 8).tolist()
    [0, 1, 2, 0, 0, 0, 1, 0, 0]
    """
    reached = 1  # bit s: the sum s can be reached
    keep = (1 << (limit + 1)) - 1
    for choices in lengths:
        for sums in [reached << length for length in choices]:
            reached |= sums & keep
    bits = np.array([reached >> s & 1 for s in range(limit + 1)], bool)
    lengths_px = np.arange(limit + 1)
    return np.asarray(lengths_px - np.maximum.accumulate(np.where(bits, lengths_px, 0)))
