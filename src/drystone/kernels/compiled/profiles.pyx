# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.profiles`."""

from libc.math cimport INFINITY, ceil, floor

import numpy as np

cdef double EDGE = 1e-9


def extremes(const double[:, :] corners, double left_px, double cell_px, Py_ssize_t columns):
    """Return what `extremes_numpy` returns."""
    lowest = np.empty(columns)
    highest = np.empty(columns)
    cdef double[::1] bottoms = lowest
    cdef double[::1] tops = highest
    cdef Py_ssize_t i, j, following, size = corners.shape[0]
    with nogil:
        for j in range(columns):
            bottoms[j] = INFINITY
            tops[j] = -INFINITY
        for i in range(size):
            following = i + 1 if i + 1 < size else 0
            if corners[i, 0] - left_px <= corners[following, 0] - left_px:
                sweep(corners, i, following, left_px, cell_px, bottoms, tops)
            else:
                sweep(corners, following, i, left_px, cell_px, bottoms, tops)
        # Zeros have no sign: minima of +0 and -0 depend on the order.
        for j in range(columns):
            bottoms[j] = bottoms[j] + 0.0
            tops[j] = tops[j] + 0.0
    return lowest, highest


cdef inline void sweep(
    const double[:, :] corners,
    Py_ssize_t start,
    Py_ssize_t end,
    double left_px,
    double cell_px,
    double[::1] bottoms,
    double[::1] tops,
) noexcept nogil:
    """Take in the edge from one corner to another that is not left of it."""
    cdef double start_x = corners[start, 0] - left_px, start_y = corners[start, 1]
    cdef double end_x = corners[end, 0] - left_px, end_y = corners[end, 1]
    cdef double run = end_x - start_x, slope = 0.0, one, two, left, right
    if run > 0.0:
        slope = (end_y - start_y) / run
    # Compared as floats: what is far away does not fit into an integer.
    cdef double first = floor(start_x / cell_px + EDGE), last = ceil(end_x / cell_px - EDGE) - 1.0
    cdef Py_ssize_t j, low, high
    if last < 0.0 or first > bottoms.shape[0] - 1 or not first <= last:
        return
    low = <Py_ssize_t> max(first, 0.0)
    high = <Py_ssize_t> min(last, <double> (bottoms.shape[0] - 1))
    for j in range(low, high + 1):
        left, right = j * cell_px, (j + 1) * cell_px
        one = start_y if start_x >= left else start_y + (left - start_x) * slope
        two = end_y if end_x <= right else start_y + (right - start_x) * slope
        bottoms[j] = min(bottoms[j], min(one, two))
        tops[j] = max(tops[j], max(one, two))
