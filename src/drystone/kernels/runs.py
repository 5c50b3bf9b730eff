"""Runs of empty pixels between labelled regions of an image, along rows and columns."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

ALONG = 2.0
"""A run this much longer than the one across it lies along a gap."""

FAR = 2**31
"""Further than any pixel."""


@dataclass(frozen=True, eq=False)
class _Runs:
    """Runs of empty pixels along rows: arrays like the image, with what each pixel's run is.

    `ends` and `away` have the blocks before and after it and the px to them, on a first axis.
    """

    length: NDArray[np.int64]
    between: Mask
    """Whether it ends at two different blocks."""
    ends: NDArray[np.int64]
    away: NDArray[np.int64]

    def turned(self) -> "_Runs":
        """Return runs along columns, of a transposed image."""
        ends, away = self.ends.transpose(0, 2, 1), self.away.transpose(0, 2, 1)
        return _Runs(self.length.T, self.between.T, ends, away)


def _runs_in_rows(cells: NDArray[np.int64]) -> _Runs:
    width = cells.shape[1]
    col = np.arange(width)[None, :]
    before = np.maximum.accumulate(np.where(cells > 0, col, -1), axis=1)
    after = np.minimum.accumulate(np.where(cells > 0, col, width)[:, ::-1], axis=1)[:, ::-1]
    ends = np.stack(
        [
            np.take_along_axis(cells, np.maximum(before, 0), axis=1),
            np.take_along_axis(cells, np.minimum(after, width - 1), axis=1),
        ]
    )
    between = (cells == 0) & (before >= 0) & (after < width) & (ends[0] != ends[1])
    return _Runs(after - before - 1, between, ends, np.stack([col - before, after - col]))


def narrow_gaps(
    cells: NDArray[np.int64], ground: int, reach_px: float
) -> tuple[Mask, NDArray[np.int64]]:
    """Find the pixels of gaps no wider than a reach, and the stone nearest to each (ids, 0: empty).

    In a gap are pixels that two different blocks bound in their row or column, across no more than
    the reach: the length of that run, or h v / sqrt(h^2 + v^2) when both are bounded.  Nearest is
    the nearest of the blocks that bound it, but never the ground.  Of two at one distance it is the
    upper or the left one, all along a joint: or the joint would have steps.
    """
    along, across = _runs_in_rows(cells.T).turned(), _runs_in_rows(cells)
    both = across.between & along.between
    tilted = across.length * along.length / np.maximum(np.hypot(across.length, along.length), 1.0)
    width = np.where(both, tilted, np.where(across.between, across.length, along.length))
    gap = (across.between | along.between) & (width <= reach_px)
    # Along a gap a run ends at what closes it, not at its sides.
    sides = (
        along.between & (~both | (along.length <= ALONG * across.length)),
        across.between & (~both | (across.length <= ALONG * along.length)),
    )
    ends = np.concatenate([along.ends, across.ends])
    away = np.concatenate(
        [np.where(side, runs.away, FAR) for side, runs in zip(sides, (along, across), strict=True)]
    )
    away[ends == ground] = FAR  # the ground does not grow
    nearest = np.take_along_axis(ends, away.argmin(axis=0)[None], axis=0)[0]
    return np.asarray(gap, bool), nearest
