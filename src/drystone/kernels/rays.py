"""What the rays meet that leave a mask to the left and downwards (Eq. 4)."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, Silhouette

Longs = NDArray[np.int64]


class RaySums:
    """Sums of a landscape from which any swept region is counted in a few look-ups.

    Tables have a column more than the landscape, and are read as one long row.
    """

    def __init__(self, occupied: Mask) -> None:
        self.height, self.width = occupied.shape
        self._occupied = occupied
        # First row with a pixel: above it tables need no sums.
        self._top = int(np.argmax(occupied.any(axis=1))) if occupied.any() else self.height

    @cached_property
    def _along(self) -> Ints:
        """Pixels left of each column, in each row."""
        along, top = self._table(), self._top
        np.cumsum(self._occupied[top:], axis=1, dtype=np.int32, out=along[top:, 1:])
        return along

    @cached_property
    def _below(self) -> Ints:
        """Pixels left of each column, in each row and all under it; in the end none."""
        below = np.zeros((self.height + 1, self.width + 1), np.int32)
        for row in range(self.height - 1, self._top - 1, -1):
            np.add(below[row + 1], self._along[row], out=below[row])
        below[: self._top] = below[self._top]
        return below

    @cached_property
    def _ends(self) -> Ints:
        """Column after the last pixel left of each column, in each row."""
        columns = np.arange(1, self.width + 1, dtype=np.int32)
        ends, top = self._table(), self._top
        last = self._occupied[top:] * columns
        np.maximum.accumulate(last, axis=1, out=ends[top:, 1:])
        return ends

    def _table(self) -> Ints:
        return np.zeros((self.height, self.width + 1), np.int32)

    def _at(self, positions: Positions) -> Longs:
        """Return where positions are in the tables."""
        return np.asarray(positions[:, 0] * (self.width + 1) + positions[:, 1])

    def filled_share(self, mask: Silhouette, positions: Positions) -> NDArray[np.float64]:
        """Return the filled share of the swept pixels for positions (n, 2) of one mask (Eq. 4).

        Rows and columns are those of its top-left corner.  1 where nothing is swept.
        """
        begins, ends = mask.rays.looks(self.width + 1)
        at = self._at(positions)
        under = at + mask.height * (self.width + 1)
        filled = (
            self._along.take(at[:, None] + ends).sum(axis=1)
            - self._along.take(at[:, None] + begins).sum(axis=1)
            + self._below.take(under + mask.width)
            - self._below.take(under)
        )
        down = self.height - mask.height - positions[:, 0]
        swept = mask.height * positions[:, 1] + mask.width * down + mask.rays.area
        return np.where(swept > 0, filled / np.maximum(swept, 1), 1.0)

    def empty_beside(self, mask: Silhouette, positions: Positions) -> Longs:
        """Return the pixels between a mask and the next ones to its left, for many positions."""
        left = mask.rays.left
        looks = np.arange(mask.height) * (self.width + 1) + left
        last = self._ends.take(self._at(positions)[:, None] + looks).sum(axis=1)
        return np.asarray(mask.height * positions[:, 1] + int(left.sum()) - last)
