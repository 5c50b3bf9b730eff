"""Free space around a mask, column by column and row by row."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask
from drystone.kernels.support import check_inside

Ints = NDArray[np.intp]
Filling = tuple[Mask, int, int]

_fast = compiled("columns")


def free_below(occupied: Mask, bottom: Ints, row: int, col: int) -> Ints:
    """Return the free height under each column of a mask, down to what is below or the ground.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the mask.
    bottom : (w',) int array
        Row of the lowest pixel of each column of the mask.
    row, col : int
        Top-left corner of the mask.

    Raises
    ------
    ValueError
        When the mask leaves the landscape at a side or above.
    """
    if min(row, col) < 0 or col + bottom.size > occupied.shape[1]:
        raise ValueError(f"{bottom.size} columns at ({row}, {col}) leave the landscape")
    kernel = free_below_numpy if _fast is None else _fast.free_below
    heights: Ints = kernel(occupied, bottom, row, col)
    return heights


def free_below_numpy(occupied: Mask, bottom: Ints, row: int, col: int) -> Ints:
    """Return what :func:`free_below` returns, by NumPy."""
    height = occupied.shape[0]
    start = row + bottom + 1
    columns = occupied[:, col : col + bottom.size]
    below = columns & (np.arange(height)[:, None] >= start)
    first = np.where(below.any(axis=0), np.argmax(below, axis=0), height)
    return np.asarray(first - start)


def free_beside(occupied: Mask, mask: Mask, row: int, col: int) -> tuple[int, int]:
    """Return the free pixels left of a mask, and the narrowest free width right of it.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the mask.
    mask : (h', w') bool array
        Every row has a pixel.
    row, col : int
        Its top-left corner.

    Returns
    -------
    left_area : int
        Free pixels in the mask's rows between it and the next occupied pixel or the end.
    right_width : int
        The smallest number of free pixels in a row to the right.

    Raises
    ------
    ValueError
        When the mask leaves the landscape.
    """
    check_inside(occupied, mask, row, col)
    kernel = free_beside_numpy if _fast is None else _fast.free_beside
    beside: tuple[int, int] = kernel(occupied, mask, row, col)
    return beside


def free_beside_numpy(occupied: Mask, mask: Mask, row: int, col: int) -> tuple[int, int]:
    """Return what :func:`free_beside` returns, by NumPy."""
    height, width = mask.shape
    band = occupied[row : row + height]
    x = np.arange(occupied.shape[1])
    first = col + np.argmax(mask, axis=1)
    last = col + width - np.argmax(mask[:, ::-1], axis=1)
    before = np.where(band & (x < first[:, None]), x + 1, 0).max(axis=1)
    after = np.where(band & (x >= last[:, None]), x, occupied.shape[1]).min(axis=1)
    return int((first - before).sum()), int((after - last).min())


def gap_filling(
    occupied: Mask,
    mask: Mask,
    row: int,
    col: int,
    columns: tuple[int, int],
    sizes: tuple[int, int],
) -> Filling | None:
    """Return the gap under a mask where it is lowest, as a piece that fills it (§3.7, Fig. 9c).

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the mask; the ground is below its last row.
    mask : (h', w') bool array
        Every column has a pixel.
    row, col : int
        Its top-left corner.
    columns : (int, int)
        First column of the mask that may be filled, and the one after the last.
    sizes : (int, int)
        Smallest height and width, and largest height, of a column of the piece.

    Returns
    -------
    filling : (n, m) bool array
        The piece, which is connected by edges: the columns that touch first when the mask is
        lowered in thought, with those beside them whose gap is a pixel higher, or more while they
        are fewer than the smallest width.
    top, left : int
        Its top-left corner in the landscape.

    None when there is none of these sizes, or it would fall apart.

    Raises
    ------
    ValueError
        When the mask leaves the landscape, or columns are not its own.
    """
    check_inside(occupied, mask, row, col)
    if min(columns) < 0 or columns[1] > mask.shape[1]:
        raise ValueError(f"columns {columns} of a mask that has {mask.shape[1]}")
    kernel = gap_filling_numpy if _fast is None else _fast.gap_filling
    filling: Filling | None = kernel(occupied, mask, row, col, columns, sizes)
    return filling


def gap_filling_numpy(
    occupied: Mask,
    mask: Mask,
    row: int,
    col: int,
    columns: tuple[int, int],
    sizes: tuple[int, int],
) -> Filling | None:
    """Return what :func:`gap_filling` returns, by NumPy."""
    part = mask[:, columns[0] : columns[1]]
    if not part.size:
        return None
    bottom = part.shape[0] - 1 - np.argmax(part[::-1], axis=0)
    # No further down than it may be filled.
    scene = occupied[: row + part.shape[0] + sizes[1] + 1]
    gap = free_below_numpy(scene, bottom, row, col + columns[0])
    run = _touching_run(gap, *sizes)
    if run is None:
        return None
    tops = row + bottom[slice(*run)] + 1
    ends = tops + gap[slice(*run)]
    # Each column is one run of pixels: neighbours must share a row.
    if (np.maximum(tops[1:], tops[:-1]) >= np.minimum(ends[1:], ends[:-1])).any():
        return None
    top = int(tops.min())
    rows = np.arange(top, int(ends.max()))[:, None]
    return (rows >= tops) & (rows < ends), top, col + columns[0] + run[0]


def _touching_run(gap: Ints, smallest: int, largest: int) -> tuple[int, int] | None:
    """Return the columns that touch first when a mask is lowered, at least the smallest number.

    The run starts from the smallest gap and takes in neighbours whose gap is a pixel larger, or
    more as long as it is narrower than wanted.
    """
    fits = (gap >= smallest) & (gap <= largest)
    if not fits.any():
        return None
    least = gap[fits].min()
    for slack in range(1, int(gap[fits].max()) + 1):
        touches = fits & (gap <= least + slack)
        for at in np.flatnonzero(fits & (gap == least)):
            start = stop = int(at)
            while start > 0 and touches[start - 1]:
                start -= 1
            while stop + 1 < gap.size and touches[stop + 1]:
                stop += 1
            if stop + 1 - start >= smallest:
                return start, stop + 1
    return None
