"""Images of large, sparse ids as images of small numbers."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

BLOCK_PX = 1 << 20
"""Pixels that are counted at once: counting takes copies of 8 bytes each."""
_CACHED_PX = 1 << 16


def counted(index: NDArray[Any], most: int) -> NDArray[np.int64]:
    """Return how often each of the numbers 0 ... `most` is in an image."""
    flat = index.ravel()
    counts = np.zeros(most + 1, np.int64)
    for start in range(0, flat.size, BLOCK_PX):
        counts += np.bincount(flat[start : start + BLOCK_PX], minlength=most + 1)
    return counts


def looked_up(
    table: NDArray[Any], index: NDArray[Any], out: NDArray[Any] | None = None
) -> NDArray[Any]:
    """Return ``table[index]`` of an image of positions; nothing but the answer takes memory."""
    found = np.empty(index.shape, table.dtype) if out is None else out
    flat, places = found.ravel(), index.ravel()
    for start in range(0, flat.size, _CACHED_PX):
        some = slice(start, start + _CACHED_PX)
        np.take(table, places[some].astype(np.intp), out=flat[some], mode="clip")
    return found


def numbered(ids: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Return an image with 1 + the place of each id among its different ids, and these, ascending.

    At least one pixel, no id below 0.  The image has the smallest integers that hold its numbers.
    """
    top = int(ids.max())
    if top < max(1 << 16, 4 * ids.size):
        present = np.zeros(top + 1, bool)
        present[ids.ravel()] = True
        table = np.cumsum(present)
        return looked_up(table.astype(_least(table[-1])), ids), np.flatnonzero(present)
    # Ids come in runs: only the first pixel of each run is sorted.
    flat = ids.ravel()
    starts = np.concatenate(([0], np.flatnonzero(flat[1:] != flat[:-1]) + 1))
    values, position = np.unique(flat[starts], return_inverse=True)
    lengths = np.diff(starts, append=flat.size)
    index = np.repeat((position + 1).astype(_least(len(values))), lengths).reshape(ids.shape)
    return index, values.astype(np.int64)


def _least(most: int) -> type[Any]:
    return next((kind for kind in (np.uint8, np.uint16) if most <= np.iinfo(kind).max), np.int32)
