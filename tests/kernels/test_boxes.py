"""Neighbours among many boxes: against plain loops (Eq. 6-9)."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from drystone.kernels.boxes import left_neighbour, nearest_joints
from tests.strategies import repeatable

Box = tuple[int, int, int, int]
coordinates = st.integers(0, 12)
box = st.builds(
    lambda x, w, y, h: (x, x + w, y, y + h), coordinates, st.integers(1, 6), coordinates,
    st.integers(1, 6),
)  # fmt: skip
tables = st.lists(box, max_size=7)


def table(boxes: list[Box]) -> NDArray[np.int64]:
    return np.array(boxes, np.int64).reshape(-1, 4)


@repeatable(300)
@given(tables, box, st.floats(0, 6), st.floats(6, 18))
def test_the_joints_are_those_of_a_loop(
    boxes: list[Box], above: Box, leftmost: float, rightmost: float
) -> None:
    left, right, bottom, top = above

    def nearest(places: list[int], corner: int, x: int) -> int:
        return min(
            places,
            key=lambda k: (boxes[k][corner] - x) ** 2 + (boxes[k][3] - bottom) ** 2,
            default=-1,
        )

    below = [k for k, b in enumerate(boxes) if 2 * b[3] <= top + bottom]
    one = nearest([k for k in below if boxes[k][1] < rightmost], 1, left)
    two = nearest([k for k in below if boxes[k][0] > leftmost], 0, right)
    assert nearest_joints(table(boxes), above, leftmost, rightmost) == (one, two)


@repeatable(300)
@given(tables, box)
def test_the_neighbour_is_that_of_a_loop(boxes: list[Box], beside: Box) -> None:
    left, right, bottom, top = beside
    level = [
        k
        for k, (_, end, low, high) in enumerate(boxes)
        if 2 * end <= left + right
        and 2 * (min(high, top) - max(low, bottom)) >= min(high - low, top - bottom)
    ]
    expected = max(level, key=lambda k: (boxes[k][1], boxes[k][3]), default=-1)
    assert left_neighbour(table(boxes), beside) == expected
