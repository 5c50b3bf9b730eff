"""Height profiles of polygons, column by column: of what is built, and of a stone over it.

Columns are half open, [j c, (j + 1) c) for a column width c, and conservative: whatever part of a
column a polygon is over, the whole column counts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import ceil, floor

    from drystone.kernels.lists import doubles, doubles_out

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

EDGE = 1e-9
"""What reaches into a column by less than this share of its width is not over it."""

OVER = 0.25
"""A polygon is not over its outermost columns if it reaches into them by less than this share.

Otherwise a gap would have to be two columns wider than a stone that fits into it; whoever lets a
stone go moves it aside by what it may overlap.
"""

GROUND = -1
"""Owner of a column over which there is nothing."""

SHARE = cython.declare(cython.double, EDGE)
INFINITY = cython.declare(cython.double, np.inf)


class HeightProfile(NamedTuple):
    """How high a wall is over each column."""

    tops: Floats  # (columns,) the highest y of anything over the column; 0 for bare ground
    # (columns,) index of the polygon that is highest there, of equals the one that came
    # first; -1 for the ground
    owners: Ints
    # (k, 4) left, bottom, right and top of the polygons, by their index; zeros where there is
    # none
    boxes: Floats


class StoneProfile(NamedTuple):
    """A polygon over columns that start at its left end; y from the origin, a stone's centroid."""

    bottoms: Floats  # (n,) the lowest y over each column
    tops: Floats  # (n,) the highest
    left: float
    bottom: float
    right: float
    top: float


class StoneProfiles(NamedTuple):
    """Stone profiles in a row."""

    bottoms: Floats  # (n,)
    # (k + 1,) stone i has the bottoms from first[i] to before first[i + 1]
    first: NDArray[np.int64]
    boxes: Floats  # (k, 4) left, bottom, right and top


def in_a_row(stones: Sequence[StoneProfile]) -> StoneProfiles:
    """Put stone profiles in a row."""
    first = np.zeros(len(stones) + 1, np.int64)
    np.cumsum([len(stone.bottoms) for stone in stones], out=first[1:])
    bottoms = np.concatenate([np.zeros(0), *(stone.bottoms for stone in stones)])
    boxes = np.array([stone[2:] for stone in stones], np.float64).reshape(-1, 4)
    return StoneProfiles(bottoms, first, boxes)


def bare(columns: int) -> HeightProfile:
    """Return the profile of the ground."""
    return HeightProfile(np.zeros(columns), np.full(columns, GROUND, np.int32), np.zeros((0, 4)))


def raised(profile: HeightProfile, corners: Floats, index: int, cell_px: float) -> HeightProfile:
    """Return a profile with one more polygon (n, 2), source px, of an index that no other has.

    What is beside the profile is ignored.
    """
    if index < 0:
        raise ValueError(f"polygon {index}")
    tops = extremes(corners, 0.0, cell_px, profile.tops.size)[1]
    left, right = float(corners[:, 0].min()) / cell_px, float(corners[:, 0].max()) / cell_px
    first, last = math.floor(left + OVER), math.ceil(right - OVER)
    tops[: max(0, first)] = tops[max(0, last) :] = -np.inf
    higher = tops > profile.tops
    boxes = np.zeros((max(len(profile.boxes), index + 1), 4))
    boxes[: len(profile.boxes)] = profile.boxes
    boxes[index, :2], boxes[index, 2:] = corners.min(axis=0), corners.max(axis=0)
    return HeightProfile(
        np.where(higher, tops, profile.tops),
        np.where(higher, np.int32(index), profile.owners),
        boxes,
    )


def hanging(corners: Floats, cell_px: float) -> StoneProfile:
    """Return the profile of a polygon that is moved so that its left end lies on a column edge.

    The last column is left out if the polygon reaches into it by less than `OVER`.
    """
    left, bottom = corners.min(axis=0).tolist()
    right, top = corners.max(axis=0).tolist()
    if not right > left:
        raise ValueError("a polygon without width has no profile")
    columns = max(1, math.ceil((right - left) / cell_px - OVER))
    bottoms, tops = extremes(corners, left, cell_px, columns)
    return StoneProfile(bottoms, tops, left, bottom, right, top)


def extremes(
    corners: Floats, left_px: float, cell_px: float, columns: int
) -> tuple[Floats, Floats]:
    """Return the lowest and the highest y of a polygon over each of some columns from `left_px` on.

    +inf and -inf where the polygon is not over a column.
    """
    if not cell_px > 0:
        raise ValueError(f"columns {cell_px} px wide")
    if corners.ndim != 2 or corners.shape[1] != 2:
        raise ValueError(f"corners of shape {corners.shape}")
    corners = np.ascontiguousarray(corners, np.float64)
    lowest, highest = np.empty(columns), np.empty(columns)
    at: cython.p_double = doubles(corners)
    size: cython.Py_ssize_t = len(corners)
    count: cython.Py_ssize_t = columns
    left: cython.double = left_px
    cell: cython.double = cell_px
    bottoms: cython.p_double = doubles_out(lowest)
    tops: cython.p_double = doubles_out(highest)
    with cython.nogil:
        sweep_all(at, size, left, cell, bottoms, tops, count)
    return lowest, highest


def sweep_all(at, size, left, cell, bottoms, tops, columns):
    """Take in all edges of a polygon."""
    for j in range(columns):
        bottoms[j], tops[j] = INFINITY, -INFINITY
    for i in range(0, 2 * size, 2):
        j = i + 2 if i + 2 < 2 * size else 0
        if at[i] - left <= at[j] - left:
            sweep(at[i] - left, at[i + 1], at[j] - left, at[j + 1], cell, bottoms, tops, columns)
        else:
            sweep(at[j] - left, at[j + 1], at[i] - left, at[i + 1], cell, bottoms, tops, columns)
    # Zeros have no sign: minima of +0 and -0 depend on the order.
    for j in range(columns):
        bottoms[j], tops[j] = bottoms[j] + 0.0, tops[j] + 0.0


def sweep(start_x, start_y, end_x, end_y, cell, bottoms, tops, columns):
    """Take in the edge from one corner to another that is not left of it."""
    run: cython.double = end_x - start_x
    slope: cython.double = (end_y - start_y) / run if run > 0.0 else 0.0
    # Compared as floats: what is far away does not fit into an integer.
    first: cython.double = floor(start_x / cell + SHARE)
    last: cython.double = ceil(end_x / cell - SHARE) - 1.0
    most: cython.double = columns - 1
    if last < 0.0 or first > most or not first <= last:
        return
    for j in range(
        cython.cast(cython.Py_ssize_t, max(first, 0.0)),
        cython.cast(cython.Py_ssize_t, min(last, most)) + 1,
    ):
        left, right = j * cell, (j + 1) * cell
        # An edge is highest and lowest at the ends of its piece over a column.
        one = start_y if start_x >= left else start_y + (left - start_x) * slope
        two = end_y if end_x <= right else start_y + (right - start_x) * slope
        bottoms[j] = min(bottoms[j], min(one, two))  # noqa: PLW3301 - the order of zeros
        tops[j] = max(tops[j], max(one, two))  # noqa: PLW3301
