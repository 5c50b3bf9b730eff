# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.silhouette`."""

from libc.stdint cimport int32_t

import numpy as np


def runs(const unsigned char[:, :] mask):
    """Return the runs, the underside and the areas of a `Silhouette`."""
    cdef Py_ssize_t height = mask.shape[0], width = mask.shape[1], row, col, start, n = 0
    cdef int32_t area = 0
    # No row has more runs than every second pixel.
    table = np.empty((height * (width // 2 + 1), 3), np.int32)
    lowest = np.full(width, -1, np.int32)
    areas = np.zeros(height + 1, np.int32)
    cdef int32_t[:, ::1] found = table
    cdef int32_t[::1] bottom = lowest
    cdef int32_t[::1] area_from = areas
    with nogil:
        for row in range(height - 1, -1, -1):
            col = 0
            while col < width:
                start = col
                while col < width and mask[row, col]:
                    if bottom[col] < 0:
                        bottom[col] = <int32_t> row
                    col += 1
                if col > start:
                    found[n, 0] = <int32_t> row
                    found[n, 1] = <int32_t> start
                    found[n, 2] = <int32_t> (col - start)
                    area += found[n, 2]
                    n += 1
                col += 1
            area_from[row] = area
    return table[:n].copy(), lowest, areas


def rays(const unsigned char[:, :] mask):
    """Return the fields of a `RayPattern`."""
    cdef Py_ssize_t height = mask.shape[0], width = mask.shape[1]
    cdef Py_ssize_t row, col, start, last, n = 0, area = 0
    table = np.empty((height * (width // 2 + 1), 3), np.int32)
    first = np.zeros(height, np.int32)
    above = np.zeros(width, np.uint8)
    cdef int32_t[:, ::1] runs = table
    cdef int32_t[::1] left = first
    cdef unsigned char[::1] under = above
    with nogil:
        for row in range(height):
            last = width - 1
            while last >= 0 and not mask[row, last]:
                last -= 1
            col = 0
            while col < width:
                start = col
                while col < width and not mask[row, col] and (col < last or under[col]):
                    col += 1
                if col > start:
                    area += col - start
                    if start == 0:
                        left[row] = <int32_t> col
                    else:
                        runs[n, 0] = <int32_t> row
                        runs[n, 1] = <int32_t> start
                        runs[n, 2] = <int32_t> col
                        n += 1
                while col < width and (mask[row, col] or not (col < last or under[col])):
                    under[col] |= mask[row, col]
                    col += 1
    return first, table[:n].copy(), area
