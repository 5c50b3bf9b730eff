"""Hand-drawn walls whose findings are known."""

import numpy as np

from drystone.craft import RULES, Masonry
from tests.polygons import box_of as box

PX = 24
"""Pixels of a unit in label images."""


def find(rule, wall):
    return RULES[rule].find(wall)


def courses(widths, height=1.0):
    """Courses of bricks from the foot up, numbered from 1 along each course."""
    loops = {}
    for level, course in enumerate(widths):
        x = 0.0
        for width in course:
            loops[len(loops) + 1] = box(x, level * height, width, height)
            x += width
    return loops


def stack_bond(columns=4, rows=5):
    return courses([[2.0] * columns] * rows)


def running_bond(rows=5):
    """8 wide: four bricks, or a half, three bricks and a half."""
    return courses(
        [[2.0] * 4 if row % 2 == 0 else [1.0, 2.0, 2.0, 2.0, 1.0] for row in range(rows)]
    )


def open_joints(loops, gap):
    """Shrink every stone, as in a tracing."""
    shrunk = {}
    for i, loop in loops.items():
        middle = 0.5 * (loop.min(axis=0) + loop.max(axis=0))
        size = np.ptp(loop, axis=0)
        shrunk[i] = middle + (loop - middle) * (1.0 - gap / size)
    return shrunk


def mirrored(loops):
    return {i: loop * [-1.0, 1.0] for i, loop in loops.items()}


def painted(loops):
    """Paint upright rectangles into a label image with some air around."""
    points = np.concatenate(list(loops.values()))
    width, height = np.rint(points.max(axis=0) * PX).astype(int).tolist()
    image = np.zeros((height + 7, width + 9), np.uint32)
    for i, loop in loops.items():
        x0, y0 = np.rint(loop.min(axis=0) * PX).astype(int).tolist()
        x1, y1 = np.rint(loop.max(axis=0) * PX).astype(int).tolist()
        image[height - y1 + 3 : height - y0 + 3, x0 + 5 : x1 + 5] = i
    return image


def both(loops):
    """The same wall from polygons and from pixels."""
    return Masonry(loops), Masonry.from_labels(painted(loops))
