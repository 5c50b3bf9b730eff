"""Hand-drawn walls whose findings are known."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from drystone.craft import RULES, Finding, Masonry

Loops = dict[int, NDArray[np.float64]]
PX = 24
"""Pixels of a unit in label images."""


def box(x: float, y: float, width: float, height: float) -> NDArray[np.float64]:
    return np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]], float)


def find(rule: str, wall: Masonry) -> Finding:
    return RULES[rule].find(wall)


def courses(widths: Sequence[Sequence[float]], height: float = 1.0) -> Loops:
    """Courses of bricks from the foot up, numbered from 1 along each course."""
    loops: Loops = {}
    for level, course in enumerate(widths):
        x = 0.0
        for width in course:
            loops[len(loops) + 1] = box(x, level * height, width, height)
            x += width
    return loops


def stack_bond(columns: int = 4, rows: int = 5) -> Loops:
    return courses([[2.0] * columns] * rows)


def running_bond(rows: int = 5) -> Loops:
    """8 wide: four bricks, or a half, three bricks and a half."""
    return courses(
        [[2.0] * 4 if row % 2 == 0 else [1.0, 2.0, 2.0, 2.0, 1.0] for row in range(rows)]
    )


def open_joints(loops: Mapping[int, NDArray[np.float64]], gap: float) -> Loops:
    """Shrink every stone, as in a tracing."""
    shrunk = {}
    for i, loop in loops.items():
        middle = 0.5 * (loop.min(axis=0) + loop.max(axis=0))
        size = np.ptp(loop, axis=0)
        shrunk[i] = middle + (loop - middle) * (1.0 - gap / size)
    return shrunk


def mirrored(loops: Mapping[int, NDArray[np.float64]]) -> Loops:
    return {i: loop * [-1.0, 1.0] for i, loop in loops.items()}


def painted(loops: Mapping[int, NDArray[np.float64]]) -> NDArray[np.uint32]:
    """Paint upright rectangles into a label image with some air around."""
    points = np.concatenate(list(loops.values()))
    width, height = np.rint(points.max(axis=0) * PX).astype(int).tolist()
    image = np.zeros((height + 7, width + 9), np.uint32)
    for i, loop in loops.items():
        x0, y0 = np.rint(loop.min(axis=0) * PX).astype(int).tolist()
        x1, y1 = np.rint(loop.max(axis=0) * PX).astype(int).tolist()
        image[height - y1 + 3 : height - y0 + 3, x0 + 5 : x1 + 5] = i
    return image


def both(loops: Mapping[int, NDArray[np.float64]]) -> tuple[Masonry, Masonry]:
    """The same wall from polygons and from pixels."""
    return Masonry(loops), Masonry.from_labels(painted(loops))
