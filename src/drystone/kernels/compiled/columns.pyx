# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.columns`.

The functions take about a microsecond, less than passing the interpreter from thread to thread:
they keep it.
"""

from libc.string cimport memcpy

import numpy as np

ctypedef unsigned char byte


def free_below(
    const byte[:, :] occupied, const Py_ssize_t[:] bottom, Py_ssize_t row, Py_ssize_t col
):
    """Return what `free_below_numpy` returns; the columns must be inside."""
    cdef Py_ssize_t at, first
    heights = np.empty(bottom.shape[0], np.intp)
    cdef Py_ssize_t[::1] out = heights
    for at in range(bottom.shape[0]):
        first = row + bottom[at] + 1
        out[at] = free_height(occupied, first, col + at, occupied.shape[0] - first)
    return heights


cdef inline Py_ssize_t free_height(
    const byte[:, :] occupied, Py_ssize_t row, Py_ssize_t col, Py_ssize_t most
) noexcept nogil:
    """Count free pixels from a row downwards, as far as is wanted; the ground ends them, too."""
    cdef Py_ssize_t end = min(occupied.shape[0], row + most), at = row
    while at < end and not occupied[at, col]:
        at += 1
    return at - row


def free_beside(
    const byte[:, :] occupied, const byte[:, :] mask, Py_ssize_t row, Py_ssize_t col
):
    """Return what `free_beside_numpy` returns; the mask must be inside."""
    cdef Py_ssize_t i, at, first, area = 0, narrowest = occupied.shape[1]
    for i in range(mask.shape[0]):
        at = 0
        while at < mask.shape[1] - 1 and not mask[i, at]:
            at += 1
        first = col + at
        area += free_before(&occupied[row + i, 0], occupied.strides[1], first)
        at = mask.shape[1]
        while at > 1 and not mask[i, at - 1]:
            at -= 1
        first = at = col + at
        while at < occupied.shape[1] and at - first < narrowest and not occupied[row + i, at]:
            at += 1
        narrowest = min(narrowest, at - first)
    return area, narrowest


cdef inline Py_ssize_t free_before(
    const byte *line, Py_ssize_t stride, Py_ssize_t end
) noexcept nogil:
    """Count free pixels from one on to the left, where there can be eight at a time."""
    cdef Py_ssize_t at = end
    cdef unsigned long long eight
    while stride == 1 and at >= 8:
        memcpy(&eight, line + at - 8, 8)
        if eight:
            break
        at -= 8
    while at > 0 and not line[(at - 1) * stride]:
        at -= 1
    return end - at


def gap_filling(
    const byte[:, :] occupied,
    const byte[:, :] mask,
    Py_ssize_t row,
    Py_ssize_t col,
    (Py_ssize_t, Py_ssize_t) columns,
    (Py_ssize_t, Py_ssize_t) sizes,
):
    """Return what `gap_filling_numpy` returns; the mask must be inside."""
    cdef Py_ssize_t start = columns[0], stop, at, i, top, bottom
    if start >= columns[1]:
        return None
    cdef Py_ssize_t[:, ::1] gaps = np.empty((2, columns[1] - start), np.intp)
    for at in range(gaps.shape[1]):
        i = mask.shape[0]
        while i > 0 and not mask[i - 1, start + at]:
            i -= 1
        gaps[0, at] = row + i
        gaps[1, at] = free_height(occupied, row + i, col + start + at, sizes[1] + 1)
    start, stop = touching_run(gaps[1], sizes[0], sizes[1])
    if start >= stop:
        return None
    top, bottom = gaps[0, start], gaps[0, start] + gaps[1, start]
    for at in range(start + 1, stop):
        if max(gaps[0, at - 1], gaps[0, at]) >= min(
            gaps[0, at - 1] + gaps[1, at - 1], gaps[0, at] + gaps[1, at]
        ):
            return None
        top, bottom = min(top, gaps[0, at]), max(bottom, gaps[0, at] + gaps[1, at])
    filling = np.zeros((bottom - top, stop - start), np.bool_)
    cdef byte[:, ::1] out = filling.view(np.uint8)
    for at in range(start, stop):
        for i in range(gaps[0, at], gaps[0, at] + gaps[1, at]):
            out[i - top, at - start] = 1
    return filling, top, col + columns[0] + start


cdef (Py_ssize_t, Py_ssize_t) touching_run(
    Py_ssize_t[::1] gap, Py_ssize_t smallest, Py_ssize_t largest
) noexcept nogil:
    """Return the columns of the run of `touching_run_numpy`; an empty one when there is none."""
    cdef Py_ssize_t size = gap.shape[0], least = largest + 1, most = 0, slack, at, start, stop
    for at in range(size):
        if smallest <= gap[at] <= largest:
            least, most = min(least, gap[at]), max(most, gap[at])
    for slack in range(1, most + 1):
        for at in range(size):
            if gap[at] != least:
                continue
            start, stop = at, at + 1
            while start > 0 and least <= gap[start - 1] <= min(largest, least + slack):
                start -= 1
            while stop < size and least <= gap[stop] <= min(largest, least + slack):
                stop += 1
            if stop - start >= smallest:
                return start, stop
    return 0, 0
