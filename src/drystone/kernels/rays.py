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

    @cached_property
    def _along(self) -> Ints:
        """Pixels left of each column, in each row."""
        return self._table(np.cumsum(self._occupied, axis=1, dtype=np.int32))

    @cached_property
    def _below(self) -> Ints:
        """Pixels left of each column, in each row and all under it; in the end none."""
        below = np.zeros((self.height + 1, self.width + 1), np.int32)
        np.cumsum(self._along[::-1], axis=0, out=below[-2::-1])
        return below

    @cached_property
    def _ends(self) -> Ints:
        """Column after the last pixel left of each column, in each row."""
        columns = np.arange(1, self.width + 1, dtype=np.int32)
        return self._table(np.maximum.accumulate(self._occupied * columns, axis=1))

    def _table(self, numbers: Ints) -> Ints:
        table = np.zeros((self.height, self.width + 1), np.int32)
        table[:, 1:] = numbers
        return table

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
