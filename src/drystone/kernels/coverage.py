"""How much of each cell of a grid a polygon covers, exactly, and which cells that fills.

The area to the right of an edge, in the cells of one row, is a trapezoid in the cells that the
edge crosses and its height in all cells behind them.  So every edge is noted where it crosses
cells only, and a sum along each row does the rest, as rasterisers of fonts do.
"""

import math

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask

Grid = NDArray[np.float64]

ROUNDING = 1e-12
"""Shares nearer to 0 or 1 than this are 0 or 1; shares that differ by less are equal."""

FILLED = 0.5 - ROUNDING
"""A cell is filled when at least half of it is covered (DESIGN 4.9)."""

_fast = compiled("coverage")


def coverage(corners: Points) -> tuple[Grid, int, int]:
    """Return the exact share of every cell that a polygon covers.

    Parameters
    ----------
    corners : (n, 2) float array
        A simple polygon, counter-clockwise, in cells; x to the right, y up.

    Returns
    -------
    shares : (h, w) float array
        From 0 to 1, row 0 at the top: the cells that the polygon's box meets, at least one.
    left, bottom : int
        The cell corner of its bottom-left corner.

    Raises
    ------
    ValueError
        When a corner is not a finite number, or there are less than three.

    Examples
    --------
    >>> shares, left, bottom = coverage(np.array([[0.5, 1.0], [2.0, 1.0], [0.5, 1.5]]))
    >>> shares.round(3).tolist(), left, bottom
    ([[0.208, 0.167]], 0, 1)
    """
    corners = np.ascontiguousarray(corners, np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise ValueError(f"a polygon has three corners (x, y) or more, not {corners.shape}")
    kernel = coverage_numpy if _fast is None else _fast.coverage
    found: tuple[Grid, int, int] = kernel(corners)
    return found


def coverage_numpy(corners: Points) -> tuple[Grid, int, int]:
    """Return what :func:`coverage` returns, by NumPy."""
    if not np.isfinite(corners).all():
        raise ValueError("a corner is not a finite number")
    left, bottom = (math.floor(value) for value in corners.min(axis=0).tolist())
    right, top = (math.ceil(value) for value in corners.max(axis=0).tolist())
    width, height = max(right - left, 1), max(top - bottom, 1)
    # An edge that ends at the right side may be a rounding beyond it: two columns to spare.
    x, y = (corners - np.array([left, bottom], np.float64)).T
    row, drop, low, high = _row_pieces(x, y)
    at, drop, middle = _cell_pieces(row * (width + 2), drop, low, high)
    # What lies to the right of a piece in its cell, and in those behind it: in this order.
    sums = np.bincount(
        np.column_stack([at, at + 1]).ravel(),
        np.column_stack([drop * (1.0 - middle), drop * middle]).ravel(),
        minlength=height * (width + 2),
    ).reshape(height, width + 2)
    shares: Grid = np.cumsum(sums[::-1, :width], axis=1)
    shares[shares < ROUNDING] = 0.0
    shares[shares > 1.0 - ROUNDING] = 1.0
    return shares, left, bottom


def _row_pieces(x: Grid, y: Grid) -> tuple[NDArray[np.int64], Grid, Grid, Grid]:
    """Cut the edges of a polygon at the lines between rows of cells.

    Returns
    -------
    row : (m,) int array
        Of each piece, counted from the bottom; edge by edge, from the lower end of each.
    drop : (m,) float array
        How far the polygon falls along it: below 0 where it rises.
    low, high : (m,) float array
        x of its left and its right end.
    """
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    falls = y1 < y
    foot, head = np.where(falls, [x1, y1], [x, y]), np.where(falls, [x, y], [x1, y1])
    first = np.floor(foot[1])
    counts = np.where(foot[1] < head[1], np.ceil(head[1]) - first, 0.0).astype(np.int64)
    edge = np.repeat(np.arange(len(x)), counts)
    step = np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts)
    (foot_x, foot_y), (head_x, head_y) = foot[:, edge], head[:, edge]
    row = first[edge] + step
    start, stop = np.maximum(foot_y, row), np.minimum(head_y, row + 1.0)
    rises, run = head_y - foot_y, head_x - foot_x
    start_x = foot_x + run * ((start - foot_y) / rises)
    stop_x = foot_x + run * ((stop - foot_y) / rises)
    drop = np.where(falls[edge], stop - start, start - stop)
    return row.astype(np.int64), drop, np.minimum(start_x, stop_x), np.maximum(start_x, stop_x)


def _cell_pieces(
    base: NDArray[np.int64], drop: Grid, low: Grid, high: Grid
) -> tuple[NDArray[np.int64], Grid, Grid]:
    """Cut pieces of edges at the lines between columns of cells.

    Returns
    -------
    at : (k,) int array
        The base of each smaller piece plus its column; piece by piece, from the left.
    drop : (k,) float array
        Its share of the drop.
    middle : (k,) float array
        x of its middle, from the left side of its cell.
    """
    first = np.floor(low)
    counts = np.maximum(np.ceil(high) - first, 1.0).astype(np.int64)
    piece = np.repeat(np.arange(len(low)), counts)
    step = np.arange(len(piece)) - np.repeat(np.cumsum(counts) - counts, counts)
    low, high, several = low[piece], high[piece], counts[piece] > 1
    column = first[piece] + step
    start, stop = np.maximum(low, column), np.minimum(high, column + 1.0)
    share = np.where(several, stop - start, 1.0) / np.where(several, high - low, 1.0)
    return (
        base[piece] + column.astype(np.int64),
        drop[piece] * share,
        (start + stop) * 0.5 - column,
    )


def newly_filled(total: Grid, shares: Grid, row: int, col: int) -> tuple[Mask, int, int] | None:
    """Return the cells of a grid that a new block fills: before less than half, then at least.

    Parameters
    ----------
    total : (h, w) float array
        What is covered of each cell already, row 0 at the top.
    shares : (h', w') float array
        What the new block covers; it may reach over the edges of the grid, where nothing is
        covered yet.
    row, col : int
        Where its top-left corner is in the grid.

    Returns
    -------
    mask : (h'', w'') bool array
        Cropped to the cells that are filled.
    row, col : int
        Its top-left corner in the grid.

    None when there is none, or one is outside of the grid.

    Examples
    --------
    >>> total = np.array([[0.0, 0.6, 0.2]])
    >>> newly_filled(total, np.array([[0.1, 0.3, 0.4]]), 0, 0)
    (array([[ True]]), 0, 2)
    """
    kernel = newly_filled_numpy if _fast is None else _fast.newly_filled
    found: tuple[Mask, int, int] | None = kernel(total, shares, row, col)
    return found


def newly_filled_numpy(
    total: Grid, shares: Grid, row: int, col: int
) -> tuple[Mask, int, int] | None:
    """Return what :func:`newly_filled` returns, by NumPy."""
    inside, part = windows(total.shape, shares.shape, row, col)
    before = np.zeros(shares.shape)
    before[part] = total[inside]
    filled = (before < FILLED) & (before + shares >= FILLED)
    rows, cols = np.flatnonzero(filled.any(axis=1)), np.flatnonzero(filled.any(axis=0))
    if not rows.size:
        return None
    box = slice(int(rows[0]), int(rows[-1]) + 1), slice(int(cols[0]), int(cols[-1]) + 1)
    for cut, held in zip(box, part, strict=True):
        if cut.start < held.start or cut.stop > held.stop:
            return None
    return filled[box].copy(), row + box[0].start, col + box[1].start


def windows(
    grid: tuple[int, ...], shape: tuple[int, ...], row: int, col: int
) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Return what a window and a grid have in common.

    Parameters
    ----------
    grid, shape : (int, int)
        Sizes of the grid and of the window.
    row, col : int
        Top-left corner of the window in the grid; it may be outside.

    Returns
    -------
    inside, part : (slice, slice)
        Rows and columns of the grid, and the same of the window; empty when there is nothing.

    Examples
    --------
    >>> windows((4, 5), (2, 3), -1, 3)
    ((slice(0, 1, None), slice(3, 5, None)), (slice(1, 2, None), slice(0, 2, None)))
    """
    top, left = (min(max(at, 0), size) for at, size in zip((row, col), grid, strict=True))
    bottom = min(max(row + shape[0], top), grid[0])
    right = min(max(col + shape[1], left), grid[1])
    inside = slice(top, bottom), slice(left, right)
    return inside, (slice(top - row, bottom - row), slice(left - col, right - col))
