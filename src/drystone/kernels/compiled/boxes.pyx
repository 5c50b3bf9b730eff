# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.boxes`."""

from libc.stdint cimport int64_t


def nearest_joints(
    const int64_t[:, :] boxes,
    int64_t left,
    int64_t right,
    int64_t bottom,
    int64_t top,
    double leftmost,
    double rightmost,
):
    """Return the places of below1 and below2 of Eq. 9; -1 where there is none."""
    cdef Py_ssize_t i, one = -1, two = -1
    cdef int64_t rise, x, distance, least_one = 0, least_two = 0
    with nogil:
        for i in range(boxes.shape[0]):
            if 2 * boxes[i, 3] > top + bottom:
                continue
            rise = boxes[i, 3] - bottom
            if boxes[i, 1] < rightmost:
                x = boxes[i, 1] - left
                distance = x * x + rise * rise
                if one < 0 or distance < least_one:
                    one, least_one = i, distance
            if boxes[i, 0] > leftmost:
                x = boxes[i, 0] - right
                distance = x * x + rise * rise
                if two < 0 or distance < least_two:
                    two, least_two = i, distance
    return one, two


def left_neighbour(
    const int64_t[:, :] boxes, int64_t left, int64_t right, int64_t bottom, int64_t top
):
    """Return the place of the left neighbour of Eq. 6-7; -1 when there is none."""
    cdef Py_ssize_t i, best = -1
    cdef int64_t shared, smaller
    with nogil:
        for i in range(boxes.shape[0]):
            if 2 * boxes[i, 1] > left + right:
                continue
            shared = min(boxes[i, 3], top) - max(boxes[i, 2], bottom)
            smaller = min(boxes[i, 3] - boxes[i, 2], top - bottom)
            if 2 * shared < smaller:
                continue
            if best >= 0 and (
                boxes[i, 1] < boxes[best, 1]
                or (boxes[i, 1] == boxes[best, 1] and boxes[i, 3] <= boxes[best, 3])
            ):
                continue
            best = i
    return best
