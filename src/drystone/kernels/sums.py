"""How much of a length stones can fill, side by side or on top of each other."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray


def unfillable(counts: Mapping[tuple[int, ...], int], limit: int) -> NDArray[np.int64]:
    """Return for every length f up to a limit f minus the largest sum of lengths that is at most f.

    `counts` is how many stones there are of each kind, a kind being the lengths of a stone, of
    which one may be used, once.
    """
    reached = 1  # bit s: the sum s can be reached
    keep = (1 << (limit + 1)) - 1
    for lengths, count in counts.items():
        for _ in range(count):
            more = reached
            for length in lengths:
                more |= reached << length & keep
            if more == reached:
                break  # nor would any other stone of this kind add a sum
            reached = more
    packed = np.frombuffer(reached.to_bytes(limit // 8 + 1, "little"), np.uint8)
    bits = np.unpackbits(packed, count=limit + 1, bitorder="little")
    lengths_px = np.arange(limit + 1)
    return np.asarray(lengths_px - np.maximum.accumulate(bits * lengths_px))
