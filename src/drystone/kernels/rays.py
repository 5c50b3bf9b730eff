"""Filled share of the rays that leave a mask to the left and downwards (Eq. 4)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.bits import row_runs
from drystone.kernels.raster import Mask

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RayPattern:
    """What the rays of a mask sweep inside its bounding box, as horizontal runs.

    Parameters
    ----------
    rows, starts, stops : (n,) int arrays
        Runs of swept pixels in the mask's own rows and columns.
    area : int
        Number of swept pixels inside the bounding box.
    """

    rows: Ints
    starts: Ints
    stops: Ints
    area: int


def ray_pattern(mask: Mask) -> RayPattern:
    """Return the pixels of the bounding box outside the mask that its rays sweep.

    A pixel is swept when some pixel of the mask lies to the right of it in its row, or above it
    in its column; rays pass through stones.
    """
    left_of = np.logical_or.accumulate(mask[:, ::-1], axis=1)[:, ::-1]
    below = np.logical_or.accumulate(mask, axis=0)
    swept = (left_of | below) & ~mask
    runs = [
        (row, start, start + length)
        for row, row_list in enumerate(row_runs(swept))
        for start, length in row_list
    ]
    table = np.array(runs, np.int64).reshape(-1, 3)
    return RayPattern(table[:, 0], table[:, 1], table[:, 2], int(swept.sum()))


class RaySums:
    """Prefix sums of a landscape, from which any swept region is counted in a few look-ups.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape, row 0 at the top.
    """

    def __init__(self, occupied: Mask) -> None:
        self.height, self.width = occupied.shape
        self._area = np.zeros((self.height + 1, self.width + 1), np.int64)
        np.cumsum(np.cumsum(occupied, axis=0), axis=1, out=self._area[1:, 1:])
        self._row = np.zeros((self.height, self.width + 1), np.int64)
        np.cumsum(occupied, axis=1, out=self._row[:, 1:])

    def filled_share(
        self, pattern: RayPattern, shape: tuple[int, int], rows: Ints, cols: Ints
    ) -> NDArray[np.float64]:
        """Return the filled share of the swept pixels for many positions of one mask (Eq. 4).

        Parameters
        ----------
        pattern : RayPattern
            Of the mask.
        shape : (int, int)
            Height and width of the mask.
        rows, cols : (n,) int arrays
            Positions of its top-left corner.

        Returns
        -------
        share : (n,) float array
            In [0, 1]; 1 where nothing is swept.
        """
        h, w = shape
        area = self._area
        left = area[rows + h, cols] - area[rows, cols]
        below = (
            area[self.height, cols + w]
            - area[self.height, cols]
            - area[rows + h, cols + w]
            + area[rows + h, cols]
        )
        at = rows[:, None] + pattern.rows
        inner = self._row[at, cols[:, None] + pattern.stops]
        inner = inner - self._row[at, cols[:, None] + pattern.starts]
        filled = left + below + inner.sum(axis=1)
        swept = h * cols + w * (self.height - rows - h) + pattern.area
        return np.where(swept > 0, filled / np.maximum(swept, 1), 1.0)
