"""Where a mask stands on a landscape, where it rests, and the free space around it.

The functions take about a microsecond, less than passing the interpreter from thread to thread:
they keep it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import longs, longs_out, pixels, stride

Ends = tuple[int, int, int, int]
Longs = NDArray[np.int64]


def support_ends(occupied: Mask, mask: Mask, row: int, col: int) -> Ends | None:
    """Return the outermost pixels on which a mask, cropped, stands where it overlaps nothing.

    A pixel stands where the mask moved down by one would overlap something or the ground.  Left and
    right edge of the outermost ones, then the rows of the edges on which they stand: of a column's
    pixels the lowest counts.  None when it stands on nothing.
    """
    check_inside(occupied, mask, row, col)
    return ends_at(pair_of(occupied, mask), row, col)


def resting_place(
    occupied: Mask, mask: Mask, row: int, col: int, reach_px: int
) -> tuple[int, Ends] | None:
    """Return the row nearest to a given one at which a mask rests in its column, and its support.

    There it overlaps nothing, and would one row lower or stands on the ground.  Of two rows equally
    far the lower one is taken.  None when there is none within reach.
    """
    if col < 0 or col + mask.shape[1] > occupied.shape[1]:
        return None
    pair: Pair = pair_of(occupied, mask)
    first: cython.Py_ssize_t = row
    column: cython.Py_ssize_t = col
    reach: cython.Py_ssize_t = reach_px
    above: cython.bint = fits(pair, first, column)
    below: cython.bint = fits(pair, first + 1, column)
    if above and not below:
        return row, ends_at(pair, first, column)
    for shift in range(1, reach + 1):
        further: cython.bint = fits(pair, first + shift + 1, column)
        if below and not further:
            return first + shift, ends_at(pair, first + shift, column)
        below = further
        further = fits(pair, first - shift, column)
        if further and not above:
            return first - shift, ends_at(pair, first - shift, column)
        above = further
    return None


def free_below(occupied: Mask, bottom: Longs, row: int, col: int) -> Longs:
    """Return the free height under each column of a mask, down to what is below or the ground.

    `bottom` is the row of the lowest pixel of each of its columns.
    """
    if min(row, col) < 0 or col + bottom.size > occupied.shape[1]:
        raise ValueError(f"{bottom.size} columns at ({row}, {col}) leave the landscape")
    pair: Pair = pair_of(occupied, occupied)
    bottoms, heights = np.ascontiguousarray(bottom, np.int64), np.empty(bottom.size, np.int64)
    lowest: cython.p_longlong = longs(bottoms)
    out: cython.p_longlong = longs_out(heights)
    count: cython.Py_ssize_t = bottom.size
    below: cython.Py_ssize_t = row + 1
    left: cython.Py_ssize_t = col
    for at in range(count):
        out[at] = free_height(pair, below + lowest[at], left + at, pair.rows)
    return heights


def free_beside(occupied: Mask, mask: Mask, row: int, col: int) -> tuple[int, int]:
    """Return the free pixels left of a mask, and the narrowest free width right of it.

    In the rows of the mask, each of which has a pixel, up to the next occupied pixel or the end.
    """
    check_inside(occupied, mask, row, col)
    pair: Pair = pair_of(occupied, mask)
    top: cython.Py_ssize_t = row
    left: cython.Py_ssize_t = col
    area: cython.Py_ssize_t = 0
    narrowest: cython.Py_ssize_t = pair.columns
    for i in range(pair.height):
        line = (top + i) * pair.down
        own = i * pair.stone_down
        at = 0
        while at < pair.width - 1 and not pair.stone[own + at * pair.stone_across]:
            at += 1
        first = at = left + at
        while at > 0 and not pair.wall[line + (at - 1) * pair.across]:
            at -= 1
        area += first - at
        at = pair.width
        while at > 1 and not pair.stone[own + (at - 1) * pair.stone_across]:
            at -= 1
        first = at = left + at
        while at < pair.columns and at - first < narrowest:
            if pair.wall[line + at * pair.across]:
                break
            at += 1
        narrowest = min(narrowest, at - first)
    return area, narrowest


def gap_filling(
    occupied: Mask, mask: Mask, row: int, col: int, columns: tuple[int, int], sizes: tuple[int, int]
) -> tuple[Mask, int, int] | None:
    """Return the gap under a mask where it is lowest, as a piece that fills it (§3.7, Fig. 9c).

    `columns` are the first one of the mask, each of which has a pixel, that may be filled and the
    one after the last; `sizes` the smallest height and width, and the largest height, of a column
    of the piece.

    The piece is connected by edges: the columns that touch first when the mask is lowered in
    thought, with those beside them whose gap is a pixel higher, or more while they are fewer than
    the smallest width.  Returned with its top-left corner; None when there is none of these sizes,
    or it would fall apart.
    """
    check_inside(occupied, mask, row, col)
    if min(columns) < 0 or columns[1] > mask.shape[1]:
        raise ValueError(f"columns {columns} of a mask that has {mask.shape[1]}")
    pair: Pair = pair_of(occupied, mask)
    smallest: cython.Py_ssize_t = sizes[0]
    largest: cython.Py_ssize_t = sizes[1]
    first: cython.Py_ssize_t = columns[0]
    down: cython.Py_ssize_t = row
    left: cython.Py_ssize_t = col + columns[0]
    count: cython.Py_ssize_t = max(0, columns[1] - columns[0])
    tops, heights = np.empty(count, np.int64), np.empty(count, np.int64)
    top: cython.p_longlong = longs_out(tops)
    gap: cython.p_longlong = longs_out(heights)
    for at in range(count):
        i: cython.Py_ssize_t = pair.height
        own = (first + at) * pair.stone_across
        while i > 0 and not pair.stone[(i - 1) * pair.stone_down + own]:
            i -= 1
        top[at] = down + i
        # No further down than it may be filled.
        gap[at] = free_height(pair, down + i, left + at, largest + 1)
    run = touching_run(gap, count, smallest, largest)
    if run[0] >= run[1]:
        return None
    for at in range(run[0] + 1, run[1]):
        # Each column is one run of pixels: neighbours must share a row.
        if max(top[at - 1], top[at]) >= min(top[at - 1] + gap[at - 1], top[at] + gap[at]):
            return None
    tops, heights = tops[run[0] : run[1]], heights[run[0] : run[1]]
    ends, highest = tops + heights, int(tops.min())
    rows = np.arange(highest, int(ends.max()))[:, None]
    return (rows >= tops) & (rows < ends), highest, left + run[0]


def free_height(pair, row, col, most):
    """Count free pixels of the landscape from a row downwards, so many at most, to the ground."""
    end = min(pair.rows, row + most)
    at: cython.Py_ssize_t = row
    while at < end and not pair.wall[at * pair.down + col * pair.across]:
        at += 1
    return at - row


def touching_run(gap, size, smallest, largest):
    """Return the columns that touch first when a mask is lowered, at least the smallest number.

    The run starts from the smallest gap and takes in neighbours whose gap is a pixel larger, or
    more as long as it is narrower than wanted.  It is empty when there is none.
    """
    least: cython.Py_ssize_t = largest + 1
    most: cython.Py_ssize_t = 0
    for at in range(size):
        if smallest <= gap[at] <= largest:
            least, most = min(least, gap[at]), max(most, gap[at])
    for slack in range(1, most + 1):
        highest = min(largest, least + slack)
        for at in range(size):
            if gap[at] != least:
                continue
            start: cython.Py_ssize_t = at
            stop: cython.Py_ssize_t = at + 1
            while start > 0 and least <= gap[start - 1] <= highest:
                start -= 1
            while stop < size and least <= gap[stop] <= highest:
                stop += 1
            if stop - start >= smallest:
                return start, stop
    return 0, 0


def check_inside(occupied: Mask, mask: Mask, row: int, col: int) -> None:
    """Raise ValueError when a mask at a position leaves the landscape."""
    height, width = mask.shape
    if min(row, col) < 0 or row + height > len(occupied) or col + width > occupied.shape[1]:
        raise ValueError(f"a mask of {height} x {width} px at ({row}, {col}) leaves the landscape")


@cython.cclass
class Pair:
    """A landscape and a mask, and how far the pixels of each are apart."""


def pair_of(occupied, mask):
    """Return a landscape and a mask, which have to outlive it."""
    pair: Pair = Pair()
    pair.wall, pair.stone = pixels(occupied), pixels(mask)
    pair.down, pair.across = stride(occupied, 0), stride(occupied, 1)
    pair.stone_down, pair.stone_across = stride(mask, 0), stride(mask, 1)
    pair.rows, pair.columns = occupied.shape
    pair.height, pair.width = mask.shape
    return pair


def ends_at(pair, row, col):
    """Return the ends of the support of a mask at a position where it is inside."""
    left: cython.Py_ssize_t = pair.width
    right: cython.Py_ssize_t = -1
    left_row: cython.Py_ssize_t = 0
    right_row: cython.Py_ssize_t = 0
    # From the bottom up: of the pixels of a column the lowest is found first.
    for i in range(pair.height - 1, -1, -1):
        below = row + i + 1
        for at in range(left):
            if stands(pair, i, at, below, col):
                left, left_row = at, below
                break
        for at in range(pair.width - 1, right, -1):
            if stands(pair, i, at, below, col):
                right, right_row = at, below
                break
    if right < 0:
        return None
    return col + left, col + right + 1, left_row, right_row


def stands(pair, i, at, below, col):
    """Say whether a pixel of a mask is on the ground or on a pixel of the row below."""
    if not pair.stone[i * pair.stone_down + at * pair.stone_across]:
        return False
    return below == pair.rows or pair.wall[below * pair.down + (col + at) * pair.across] != 0


def fits(pair, row, col):
    """Say whether a mask is inside and overlaps nothing; its lowest rows are looked at first."""
    if row < 0 or row + pair.height > pair.rows:
        return False
    for i in range(pair.height - 1, -1, -1):
        there: cython.Py_ssize_t = (row + i) * pair.down + col * pair.across
        here: cython.Py_ssize_t = i * pair.stone_down
        for _ in range(pair.width):
            if pair.wall[there] & pair.stone[here]:
                return False
            there += pair.across
            here += pair.stone_across
    return True
