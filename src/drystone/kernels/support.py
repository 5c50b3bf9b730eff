"""Where a mask stands on a landscape: the ends of its support, and the row where it rests.

The functions take about a microsecond, less than passing the interpreter from thread to thread:
they keep it.
"""

from __future__ import annotations

from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if cython.compiled:
    from cython.cimports.drystone.kernels.memory import pixels, stride
else:
    from drystone.kernels.lists import pixels, stride

Ends = tuple[int, int, int, int]


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
    pair.rows = len(occupied)
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
