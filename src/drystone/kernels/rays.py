"""What the rays meet that leave a mask to the left and downwards (Eq. 4)."""

from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, Silhouette

Longs = NDArray[np.int64]
Number = TypeVar("Number", int, Longs)

_fast = compiled("rays")


def ray_sums(occupied: Mask, first: int) -> "RaySums":
    """Sum up a landscape; there is nothing above the first row."""
    sums: RaySums = (RaySums if _fast is None else _fast.RaySums)(occupied, first)
    return sums


class RaySums:
    """Sums of a landscape from which any swept region is counted in a few look-ups."""

    def __init__(self, occupied: Mask, first: int) -> None:
        self.height, self.width = occupied.shape
        self._first = first
        self._occupied = occupied

    @cached_property
    def _along(self) -> Ints:
        """Pixels left of each column, in each row from the first on."""
        along = np.zeros((self.height - self._first, self.width + 1), np.int32)
        np.cumsum(self._occupied[self._first :], axis=1, out=along[:, 1:])
        return along

    @cached_property
    def _above(self) -> Ints:
        """Pixels left of each column, in all rows above each row from the first on."""
        above = np.zeros((self.height - self._first + 1, self.width + 1), np.int32)
        np.cumsum(self._along, axis=0, out=above[1:])
        return above

    @cached_property
    def _ends(self) -> Ints:
        """Column after the last pixel left of each column, in each row from the first on."""
        ends = np.zeros((self.height - self._first, self.width + 1), np.int32)
        columns = np.arange(1, self.width + 1)
        ends[:, 1:] = np.where(self._occupied[self._first :], columns, 0)
        return np.maximum.accumulate(ends, axis=1)

    def filled_share(self, mask: Silhouette, positions: Positions) -> NDArray[np.float64]:
        """Return the filled share of the swept pixels for positions (n, 2) of one mask (Eq. 4).

        Rows and columns are those of its top-left corner.  1 where nothing is swept.
        """
        rows, cols = positions[:, :1] - self._first, positions[:, 1:]
        at, starts, stops = mask.rays.runs.T
        under = np.maximum(rows + mask.height, 0)
        filled = (
            _sum(self._along, rows + np.arange(mask.height), cols + mask.rays.left)
            + _sum(self._along, rows + at, cols + stops)
            - _sum(self._along, rows + at, cols + starts)
            + (self._above[-1, cols + mask.width] - self._above[-1, cols])[:, 0]
            - (self._above[under, cols + mask.width] - self._above[under, cols])[:, 0]
        )
        swept = swept_area(mask, self.height, positions[:, 0], positions[:, 1])
        return np.where(swept > 0, filled / np.maximum(swept, 1), 1.0)

    def filled_share_at(self, mask: Silhouette, row: int, col: int) -> float:
        """Return the same for one position, without the sums."""
        below = row + mask.height
        filled = int(np.count_nonzero(self._occupied[below:, col : col + mask.width]))
        for line, left in zip(self._occupied[row:below], mask.rays.left.tolist(), strict=True):
            filled += int(np.count_nonzero(line[: col + left]))
        for at, start, stop in mask.rays.runs.tolist():
            filled += int(np.count_nonzero(self._occupied[row + at, col + start : col + stop]))
        swept = swept_area(mask, self.height, row, col)
        return filled / swept if swept > 0 else 1.0

    def empty_beside(self, mask: Silhouette, positions: Positions) -> Longs:
        """Return the pixels between a mask and the next ones to its left, for many positions."""
        rows = positions[:, :1] - self._first + np.arange(mask.height)
        cols = positions[:, 1:] + mask.rays.left
        return np.asarray(cols.sum(axis=1) - _sum(self._ends, rows, cols))


def _sum(table: Ints, rows: Longs, cols: Longs) -> Longs:
    """Sum values of a table along the last axis; above its first row there is nothing."""
    if not table.size:
        return np.zeros(len(rows), np.int64)
    values = np.where(rows >= 0, table[np.maximum(rows, 0), cols], 0)
    return np.asarray(values.sum(axis=1, dtype=np.int64))


def swept_area(mask: Silhouette, height: int, row: Number, col: Number) -> Number:
    """Return how many pixels of an image so high the rays of a mask sweep."""
    return mask.height * col + mask.width * (height - row - mask.height) + mask.rays.area
