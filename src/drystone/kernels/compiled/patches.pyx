# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of the NumPy functions of :mod:`drystone.kernels.patches`."""

from libc.stdint cimport int64_t, uint8_t, uint32_t

cdef int64_t EMPTY = -1
cdef int64_t GROUND = 0


def cut_out(const uint32_t[:, :] labels, int64_t[:, ::1] cells, Py_ssize_t top, Py_ssize_t left):
    """Fill cells with what is in an image from a row and column on, and around the image."""
    cdef Py_ssize_t height = labels.shape[0], width = labels.shape[1], count = cells.shape[1]
    cdef Py_ssize_t first = min(max(-left, 0), count), last = max(min(width - left, count), first)
    cdef Py_ssize_t row, col
    cdef uint32_t label
    with nogil:
        for row in range(cells.shape[0]):
            if row + top < 0 or row + top >= height:
                for col in range(count):
                    cells[row, col] = EMPTY if row + top < 0 else GROUND
                continue
            for col in range(first):
                cells[row, col] = EMPTY
            for col in range(first, last):
                label = labels[row + top, col + left]
                cells[row, col] = EMPTY if label == 0 else <int64_t>label
            for col in range(last, count):
                cells[row, col] = EMPTY


def paint(
    const uint8_t[:, :] mask,
    int64_t label,
    Py_ssize_t top,
    Py_ssize_t left,
    int64_t[:, ::1] cells,
    uint8_t[:, ::1] fresh,
):
    """Paint a mask into cells; return its pixels, and the sums of their columns and rows."""
    cdef Py_ssize_t row, col
    cdef int64_t area = 0, cols = 0, rows = 0
    with nogil:
        for row in range(mask.shape[0]):
            for col in range(mask.shape[1]):
                if mask[row, col]:
                    cells[top + row, left + col] = label
                    fresh[top + row, left + col] = 1
                    area += 1
                    cols += col
                    rows += row
    return area, cols, rows
