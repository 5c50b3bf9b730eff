"""Overlap of a mask with a landscape at every position at once, on packed bits (§3.6).

The landscape is one long integer, a bit a pixel, row after row.  A run of L stone pixels hits
where the landscape, dilated by L, is set; dilations are built by doubling and shared by all
masks, so a pose costs a few shifts of the whole image per row of the stone.
"""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask


class BitLandscape:
    """A binary landscape packed into one integer, with its dilations.

    Parameters
    ----------
    occupied : (h, w) bool array
        True where something is.
    """

    def __init__(self, occupied: Mask) -> None:
        self.height, self.width = occupied.shape
        packed = np.packbits(occupied.ravel(), bitorder="little")
        bits = int.from_bytes(packed.tobytes(), "little")
        # doubled[k] has bit p set where any of the 2**k pixels from p to the right is occupied.
        # The last columns of a row look into the next row; no valid position reads them.
        doubled = [bits]
        while 2 ** len(doubled) <= self.width:
            last = doubled[-1]
            doubled.append(last | last >> 2 ** (len(doubled) - 1))
        # All made at once and never changed: threads may share the landscape.
        self._doubled = tuple(doubled)

    def _dilated(self, length: int) -> int:
        power = length.bit_length() - 1
        spread = self._doubled[power]
        return spread | spread >> (length - (1 << power)) if length > 1 << power else spread

    def overlap(self, mask: Mask) -> Mask:
        """Say for every position of a mask's top-left corner whether it would overlap.

        Parameters
        ----------
        mask : (h', w') bool array
            Not larger than the landscape.

        Returns
        -------
        overlap : (h - h' + 1, w - w' + 1) bool array
            True where some pixel of the mask meets an occupied one.

        Examples
        --------
        >>> BitLandscape(np.array([[0, 0, 1]], bool)).overlap(np.ones((1, 2), bool))
        array([[False,  True]])
        """
        rows, cols = mask.shape
        if rows > self.height or cols > self.width:
            return np.zeros((max(0, self.height - rows + 1), max(0, self.width - cols + 1)), bool)
        hit = 0
        for runs in reversed(row_runs(mask)):
            hit >>= self.width
            for start, length in runs:
                hit |= self._dilated(length) >> start
        size = self.height * self.width
        raw = np.frombuffer(hit.to_bytes((size + 7) // 8, "little"), np.uint8)
        flags = np.unpackbits(raw, count=size, bitorder="little").astype(bool)
        whole = flags.reshape(self.height, self.width)
        return whole[: self.height - rows + 1, : self.width - cols + 1]


def row_runs(mask: Mask) -> list[list[tuple[int, int]]]:
    """Return for each row of a mask its runs of set pixels as (start, length).

    Examples
    --------
    >>> row_runs(np.array([[1, 1, 0, 1]], bool))
    [[(0, 2), (3, 1)]]
    """
    edges = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    runs: list[list[tuple[int, int]]] = [[] for _ in range(mask.shape[0])]
    rows, starts = np.nonzero(edges == 1)
    ends = np.nonzero(edges == -1)[1]
    for row, start, end in zip(rows.tolist(), starts.tolist(), ends.tolist(), strict=True):
        runs[row].append((start, end - start))
    return runs


def drop_rows(top: NDArray[np.intp], bottom: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the row at which a mask lowered from above comes to rest, for every column.

    Parameters
    ----------
    top : (w,) int array
        Row of the highest occupied pixel of each column of the landscape; the number of rows
        where there is none.
    bottom : (w',) int array
        Row of the lowest pixel of each column of the mask.

    Returns
    -------
    rows : (w - w' + 1,) int array
        Row of the mask's top-left corner, negative when it would stand out above the image.

    Examples
    --------
    >>> drop_rows(np.array([5, 3, 5]), np.array([1, 1]))
    array([1, 1])
    """
    if bottom.size > top.size:
        return np.zeros(0, np.intp)
    windows = np.lib.stride_tricks.sliding_window_view(top, bottom.size)
    return np.asarray((windows - bottom).min(axis=1) - 1)
