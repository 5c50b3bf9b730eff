"""Which of many boxes are next to one: joints below a stone, its neighbour in the course."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled

BoxTable = NDArray[np.int64]
"""(n, 4): left, right, bottom and top of n boxes, y up."""

_fast = compiled("boxes")


def nearest_joints(
    boxes: BoxTable, box: tuple[int, int, int, int], leftmost: float, rightmost: float
) -> tuple[int, int]:
    """Return the boxes whose top corners are closest to the bottom corners of a box above (Eq. 9).

    Parameters
    ----------
    boxes : (n, 4) int array
        Left, right, bottom, top.  Only those whose top is not above the vertical centre of the
        box count.
    box : (int, int, int, int)
        Left, right, bottom, top of the box above.
    leftmost, rightmost : float
        Of the top left corners only those right of `leftmost` count, of the top right corners
        only those left of `rightmost`.

    Returns
    -------
    below1, below2 : int
        Place of the box whose top right corner is closest to the bottom left corner, and of the
        one whose top left corner is closest to the bottom right corner; the first of equals; -1
        where there is none.

    Examples
    --------
    >>> nearest_joints(np.array([[0, 5, 0, 4], [5, 9, 0, 4]]), (2, 8, 4, 6), 1, 8)
    (0, 1)
    """
    if _fast is None:
        return nearest_joints_numpy(boxes, box, leftmost, rightmost)
    found: tuple[int, int] = _fast.nearest_joints(boxes, *box, leftmost, rightmost)
    return found


def nearest_joints_numpy(
    boxes: BoxTable, box: tuple[int, int, int, int], leftmost: float, rightmost: float
) -> tuple[int, int]:
    """Twin of :func:`nearest_joints`."""
    left, right, bottom, top = box
    lefts, rights, tops = boxes[:, 0], boxes[:, 1], boxes[:, 3]
    below = 2 * tops <= top + bottom
    rise2 = (tops - bottom) ** 2
    return (
        _first_least((rights - left) ** 2 + rise2, below & (rights < rightmost)),
        _first_least((lefts - right) ** 2 + rise2, below & (lefts > leftmost)),
    )


def left_neighbour(boxes: BoxTable, box: tuple[int, int, int, int]) -> int:
    """Return the nearest box to the left in the same course; -1 when there is none (Eq. 6-7).

    In the same course are boxes whose rows overlap those of the box by at least half the smaller
    of the two heights; to the left are those that end left of its middle.  Of boxes that end at
    the same place the higher one is taken, then the first.

    Parameters
    ----------
    boxes : (n, 4) int array
        Left, right, bottom, top.
    box : (int, int, int, int)
        The same of one box.

    Examples
    --------
    >>> left_neighbour(np.array([[0, 5, 0, 4], [0, 6, 4, 8]]), (6, 9, 0, 4))
    0
    """
    if _fast is None:
        return left_neighbour_numpy(boxes, box)
    return int(_fast.left_neighbour(boxes, *box))


def left_neighbour_numpy(boxes: BoxTable, box: tuple[int, int, int, int]) -> int:
    """Twin of :func:`left_neighbour`."""
    left, right, bottom, top = box
    lowest, highest = np.maximum(boxes[:, 2], bottom), np.minimum(boxes[:, 3], top)
    level = 2 * (highest - lowest) >= np.minimum(boxes[:, 3] - boxes[:, 2], top - bottom)
    beside = np.flatnonzero(level & (2 * boxes[:, 1] <= left + right))
    if not beside.size:
        return -1
    ends = boxes[beside, 1]
    last = beside[ends == ends.max()]
    return int(last[np.argmax(boxes[last, 3])])


def _first_least(distance: NDArray[np.int64], counts: NDArray[np.bool_]) -> int:
    places = np.flatnonzero(counts)
    return int(places[np.argmin(distance[places])]) if places.size else -1
