"""How much of each cell of a grid a polygon covers, exactly, and which cells that fills.

The area to the right of an edge, in the cells of one row, is a trapezoid in the cells that the
edge crosses and its height in all cells behind them.  So every edge is noted where it crosses
cells only, and a sum along each row does the rest, as rasterisers of fonts do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import ceil, floor, isfinite

    from drystone.kernels.lists import doubles, doubles_out, flags_out

Grid = NDArray[np.float64]

ROUNDING = 1e-12
"""Shares nearer to 0 or 1 than this are 0 or 1; shares that differ by less are equal."""

FILLED = 0.5 - ROUNDING
"""A cell is filled when at least half of it is covered (DESIGN 4.9)."""

NOTHING = cython.declare(cython.double, ROUNDING)
ENOUGH = cython.declare(cython.double, FILLED)
INFINITY = cython.declare(cython.double, np.inf)


def coverage(corners: Points) -> tuple[Grid, int, int]:
    """Return the share of every cell that a counter-clockwise polygon (n, 2) covers, exactly.

    Shares (h, w), row 0 at the top, are those of the cells that its box meets, at least one.  Then
    left and bottom: the cell corner of their bottom-left corner.
    """
    corners = np.ascontiguousarray(corners, np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise ValueError(f"a polygon has three corners (x, y) or more, not {corners.shape}")
    at: cython.p_double = doubles(corners)
    end: cython.Py_ssize_t = 2 * len(corners)
    left: cython.double = INFINITY
    bottom: cython.double = INFINITY
    right: cython.double = -INFINITY
    top: cython.double = -INFINITY
    for i in range(0, end, 2):
        if not (isfinite(at[i]) and isfinite(at[i + 1])):
            raise ValueError("a corner is not a finite number")
        left, right = min(left, at[i]), max(right, at[i])
        bottom, top = min(bottom, at[i + 1]), max(top, at[i + 1])
    left, bottom = floor(left), floor(bottom)
    width: cython.Py_ssize_t = max(cython.cast(cython.Py_ssize_t, ceil(right) - left), 1)
    height: cython.Py_ssize_t = max(cython.cast(cython.Py_ssize_t, ceil(top) - bottom), 1)
    shares = np.zeros((height, width))
    out: cython.p_double = doubles_out(shares)
    for i in range(0, end, 2):
        j = i + 2 if i + 2 < end else 0
        x0, y0 = at[i] - left, at[i + 1] - bottom
        x1, y1 = at[j] - left, at[j + 1] - bottom
        if y1 < y0:
            cut_at_rows(x1, y1, x0, y0, 1.0, out, width, height)
        elif y0 < y1:
            cut_at_rows(x0, y0, x1, y1, -1.0, out, width, height)
    add_up(out, width, height)
    return shares, int(left), int(bottom)


def cut_at_rows(foot_x, foot_y, head_x, head_y, sign, out, width, height):
    """Note an edge, from its lower to its upper end, in every row of cells that it crosses."""
    first: cython.double = floor(foot_y)
    rises: cython.double = head_y - foot_y
    run: cython.double = head_x - foot_x
    count: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, ceil(head_y) - first)
    for step in range(count):
        row = first + step
        start, stop = max(foot_y, row), min(head_y, row + 1.0)
        start_x = foot_x + run * ((start - foot_y) / rises)
        stop_x = foot_x + run * ((stop - foot_y) / rises)
        at = width * (height - 1 - cython.cast(cython.Py_ssize_t, row))
        cut_at_columns(
            min(start_x, stop_x), max(start_x, stop_x), sign * (stop - start), out, at, width
        )


def cut_at_columns(low, high, drop, sums, row, width):
    """Note a piece of an edge in every cell of its row that it crosses, and in the next one."""
    column: cython.double = floor(low)
    at: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, column)
    count: cython.Py_ssize_t = max(cython.cast(cython.Py_ssize_t, ceil(high) - column), 1)
    for step in range(count):  # noqa: B007 - typed
        start, stop = max(low, column), min(high, column + 1.0)
        share = drop * ((stop - start) / (high - low)) if count > 1 else drop
        middle = (start + stop) * 0.5 - column
        if at < width:
            sums[row + at] += share * (1.0 - middle)
        if at + 1 < width:
            sums[row + at + 1] += share * middle
        column += 1.0
        at += 1


def add_up(shares, width, height):
    """Sum along the rows, and leave no rounding near 0 and 1."""
    for row in range(height):
        share = 0.0
        for at in range(row * width, (row + 1) * width):
            share += shares[at]
            if share < NOTHING:
                shares[at] = 0.0
            elif share > 1.0 - NOTHING:
                shares[at] = 1.0
            else:
                shares[at] = share


def newly_filled(total: Grid, shares: Grid) -> tuple[Mask, int, int] | None:
    """Return the cells that a new block fills: before less than half, then at least.

    `total` (h, w) is what is covered already, `shares` (h, w) what the block covers.  Returns the
    filled cells, cropped, and their top-left corner; None when there is none.
    """
    total, shares = np.ascontiguousarray(total), np.ascontiguousarray(shares)
    before: cython.p_double = doubles(total)
    new: cython.p_double = doubles(shares)
    height: cython.Py_ssize_t = shares.shape[0]
    width: cython.Py_ssize_t = shares.shape[1]
    top: cython.Py_ssize_t = height
    left: cython.Py_ssize_t = width
    bottom: cython.Py_ssize_t = -1
    right: cython.Py_ssize_t = -1
    all_filled = np.zeros((height, width), bool)
    filled: cython.p_uchar = flags_out(all_filled)
    for i in range(height):
        for j in range(width):
            at = i * width + j
            if before[at] < ENOUGH and before[at] + new[at] >= ENOUGH:
                filled[at] = True
                top, bottom = min(top, i), i
                left, right = min(left, j), max(right, j)
    if bottom < 0:
        return None
    return all_filled[top : bottom + 1, left : right + 1].copy(), top, left


def windows(
    grid: tuple[int, ...], shape: tuple[int, ...], row: int, col: int
) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Return what a grid and a window of a shape at (row, col) share, as slices of both."""
    top, left = (min(max(at, 0), size) for at, size in zip((row, col), grid, strict=True))
    bottom = min(max(row + shape[0], top), grid[0])
    right = min(max(col + shape[1], left), grid[1])
    inside = slice(top, bottom), slice(left, right)
    return inside, (slice(top - row, bottom - row), slice(left - col, right - col))
