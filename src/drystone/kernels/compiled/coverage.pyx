# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.coverage`.

The functions take a few microseconds, less than passing the interpreter from thread to thread:
they keep it.
"""

from libc.math cimport INFINITY, ceil, floor, isfinite

import numpy as np

ctypedef unsigned char byte

cdef double ROUNDING = 1e-12
cdef double FILLED = 0.5 - ROUNDING


def coverage(const double[:, ::1] corners):
    """Return what `coverage_numpy` returns."""
    cdef Py_ssize_t count = corners.shape[0], at, width, height
    cdef double left = INFINITY, bottom = INFINITY, right = -INFINITY, top = -INFINITY
    cdef double x0, y0, x1, y1
    cdef double[:, ::1] out
    for at in range(count):
        x0, y0 = corners[at, 0], corners[at, 1]
        if not (isfinite(x0) and isfinite(y0)):
            raise ValueError("a corner is not a finite number")
        left, right = min(left, x0), max(right, x0)
        bottom, top = min(bottom, y0), max(top, y0)
    left, bottom = floor(left), floor(bottom)
    width = max(<Py_ssize_t>(ceil(right) - left), 1)
    height = max(<Py_ssize_t>(ceil(top) - bottom), 1)
    shares = np.zeros((height, width))
    out = shares
    for at in range(count):
        x0, y0 = corners[at, 0] - left, corners[at, 1] - bottom
        if at + 1 < count:
            x1, y1 = corners[at + 1, 0] - left, corners[at + 1, 1] - bottom
        else:
            x1, y1 = corners[0, 0] - left, corners[0, 1] - bottom
        if y1 < y0:
            cut_at_rows(x1, y1, x0, y0, 1.0, out)
        elif y0 < y1:
            cut_at_rows(x0, y0, x1, y1, -1.0, out)
    add_up(out)
    return shares, int(left), int(bottom)


cdef void cut_at_rows(
    double foot_x, double foot_y, double head_x, double head_y, double sign, double[:, ::1] out
) noexcept nogil:
    """Note an edge, from its lower to its upper end, in every row of cells that it crosses."""
    cdef double first = floor(foot_y), row, start, stop, start_x, stop_x
    cdef double rises = head_y - foot_y, run = head_x - foot_x
    cdef Py_ssize_t count = <Py_ssize_t>(ceil(head_y) - first), step, bottom = out.shape[0] - 1
    for step in range(count):
        row = first + step
        start, stop = max(foot_y, row), min(head_y, row + 1.0)
        start_x = foot_x + run * ((start - foot_y) / rises)
        stop_x = foot_x + run * ((stop - foot_y) / rises)
        cut_at_columns(
            min(start_x, stop_x),
            max(start_x, stop_x),
            sign * (stop - start),
            &out[bottom - <Py_ssize_t>row, 0],
            out.shape[1],
        )


cdef void cut_at_columns(
    double low, double high, double drop, double *sums, Py_ssize_t width
) noexcept nogil:
    """Note a piece of an edge in every cell of its row that it crosses, and in the next one."""
    cdef double column = floor(low), start, stop, middle, share
    cdef Py_ssize_t at = <Py_ssize_t>column, count = max(<Py_ssize_t>(ceil(high) - column), 1)
    cdef Py_ssize_t step
    for step in range(count):
        start, stop = max(low, column), min(high, column + 1.0)
        share = drop * ((stop - start) / (high - low)) if count > 1 else drop
        middle = (start + stop) * 0.5 - column
        if at < width:
            sums[at] += share * (1.0 - middle)
        if at + 1 < width:
            sums[at + 1] += share * middle
        column += 1.0
        at += 1


cdef void add_up(double[:, ::1] shares) noexcept nogil:
    """Sum along the rows, and leave no rounding near 0 and 1."""
    cdef Py_ssize_t row, col
    cdef double share
    for row in range(shares.shape[0]):
        share = 0.0
        for col in range(shares.shape[1]):
            share += shares[row, col]
            if share < ROUNDING:
                shares[row, col] = 0.0
            elif share > 1.0 - ROUNDING:
                shares[row, col] = 1.0
            else:
                shares[row, col] = share


def newly_filled(
    const double[:, :] total, const double[:, :] shares, Py_ssize_t row, Py_ssize_t col
):
    """Return what `newly_filled_numpy` returns."""
    cdef Py_ssize_t height = shares.shape[0], width = shares.shape[1], i, j
    cdef Py_ssize_t top = height, left = width, bottom = -1, right = -1
    cdef byte[:, ::1] out
    for i in range(height):
        for j in range(width):
            if fills(total, shares, row, col, i, j):
                top, bottom = min(top, i), i
                left, right = min(left, j), max(right, j)
    if bottom < 0:
        return None
    if row + top < 0 or row + bottom >= total.shape[0]:
        return None
    if col + left < 0 or col + right >= total.shape[1]:
        return None
    mask = np.empty((bottom - top + 1, right - left + 1), np.bool_)
    out = mask.view(np.uint8)
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[i, j] = fills(total, shares, row, col, top + i, left + j)
    return mask, row + top, col + left


cdef inline bint fills(
    const double[:, :] total,
    const double[:, :] shares,
    Py_ssize_t row,
    Py_ssize_t col,
    Py_ssize_t i,
    Py_ssize_t j,
) noexcept nogil:
    """Say whether a cell was filled to less than half and is to at least half now."""
    cdef double before = 0.0
    if 0 <= row + i and row + i < total.shape[0] and 0 <= col + j and col + j < total.shape[1]:
        before = total[row + i, col + j]
    return before < FILLED and before + shares[i, j] >= FILLED
