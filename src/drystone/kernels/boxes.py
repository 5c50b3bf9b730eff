"""Which of many boxes are next to one: joints below a stone, its neighbour in the course."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import longs

BoxTable = NDArray[np.int64]
"""(n, 4): left, right, bottom and top of n boxes, y up."""

Box = tuple[int, int, int, int]
"""Left, right, bottom, top."""


def nearest_joints(boxes: BoxTable, box: Box, leftmost: float, rightmost: float) -> tuple[int, int]:
    """Return the boxes whose top corners are closest to the bottom corners of a box above (Eq. 9).

    First that whose top right corner, left of `rightmost`, is closest to the bottom left corner;
    then that whose top left corner, right of `leftmost`, is closest to the bottom right corner.
    Tops above the vertical centre of the box do not count.  Of equals the first; -1 where there is
    none.
    """
    boxes = np.ascontiguousarray(boxes)
    at: cython.p_longlong = longs(boxes)
    left: cython.longlong
    right: cython.longlong
    bottom: cython.longlong
    top: cython.longlong
    left, right, bottom, top = box
    low: cython.double = leftmost
    high: cython.double = rightmost
    one: cython.Py_ssize_t = -1
    two: cython.Py_ssize_t = -1
    rise: cython.longlong
    distance: cython.longlong
    least_one: cython.longlong = 0
    least_two: cython.longlong = 0
    for k in range(0, 4 * len(boxes), 4):
        if 2 * at[k + 3] > top + bottom:
            continue
        rise = (at[k + 3] - bottom) * (at[k + 3] - bottom)
        if at[k + 1] < high:
            distance = (at[k + 1] - left) * (at[k + 1] - left) + rise
            if one < 0 or distance < least_one:
                one, least_one = k // 4, distance
        if at[k] > low:
            distance = (at[k] - right) * (at[k] - right) + rise
            if two < 0 or distance < least_two:
                two, least_two = k // 4, distance
    return one, two


def left_neighbour(boxes: BoxTable, box: Box) -> int:
    """Return the nearest box to the left in the same course; -1 when there is none (Eq. 6-7).

    In the same course are boxes whose rows overlap those of the box by at least half the smaller of
    the two heights; to the left are those that end left of its middle.  Of boxes that end at the
    same place the higher one is taken, then the first.
    """
    boxes = np.ascontiguousarray(boxes)
    at: cython.p_longlong = longs(boxes)
    left: cython.longlong
    right: cython.longlong
    bottom: cython.longlong
    top: cython.longlong
    left, right, bottom, top = box
    best: cython.Py_ssize_t = -1
    shared: cython.longlong
    smaller: cython.longlong
    for k in range(0, 4 * len(boxes), 4):
        if 2 * at[k + 1] > left + right:
            continue
        shared = min(at[k + 3], top) - max(at[k + 2], bottom)
        smaller = min(at[k + 3] - at[k + 2], top - bottom)
        if 2 * shared < smaller:
            continue
        if best >= 0 and (
            at[k + 1] < at[best + 1] or (at[k + 1] == at[best + 1] and at[k + 3] <= at[best + 3])
        ):
            continue
        best = k
    return best // 4 if best >= 0 else -1
