# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.hull`."""

from libc.stdint cimport int64_t, uint8_t


cdef Py_ssize_t put(
    int64_t[:, ::1] corners, Py_ssize_t count, int64_t x, int64_t y
) noexcept nogil:
    """Add a point to the chain of corners; return how many there are then."""
    cdef int64_t x0, y0, x1, y1
    while count > 1:
        x0, y0 = corners[count - 2, 0], corners[count - 2, 1]
        x1, y1 = corners[count - 1, 0], corners[count - 1, 1]
        if (x1 - x0) * (y - y1) > (y1 - y0) * (x - x1):
            break
        count -= 1
    corners[count, 0], corners[count, 1] = x, y
    return count + 1


def pixel_hull(const uint8_t[:, ::1] mask, int64_t[:, ::1] corners):
    """Write the corners of the hull and return how many there are.

    Parameters
    ----------
    mask : (h, w) uint8 array
        At least one pixel that is not 0.
    corners : (2 h + 2, 2) int array
        As many as there could ever be on the way: two a row on one side, then on the other.
    """
    cdef Py_ssize_t height = mask.shape[0], width = mask.shape[1], row, col, count = 0
    with nogil:
        for row in range(height - 1, -1, -1):
            col = width
            while col > 0 and not mask[row, col - 1]:
                col -= 1
            if col:
                count = put(corners, count, col, height - row - 1)
                count = put(corners, count, col, height - row)
        for row in range(height):
            col = 0
            while col < width and not mask[row, col]:
                col += 1
            if col < width:
                count = put(corners, count, col, height - row)
                count = put(corners, count, col, height - row - 1)
    return count
