"""Small walls as hypothesis draws them and as people draw them."""

import itertools

import numpy as np
from hypothesis import strategies as st


def bricks(rows, cols, height, width):
    """Running bond of touching bricks with half a brick's shift in every other course."""
    labels = np.zeros((rows * height, cols * width), np.uint32)
    stone = 0
    for course in range(rows):
        shift = (course % 2) * width // 2
        edges = sorted({0, cols * width, *range(shift, cols * width, width)})
        for left, right in itertools.pairwise(edges):
            stone += 1
            top = (rows - 1 - course) * height
            labels[top : top + height, left:right] = stone
    return labels


@st.composite
def walls(draw, max_px=30):
    """Rectangles of different labels painted over each other, with at least one stone."""
    height, width = draw(st.integers(3, max_px)), draw(st.integers(3, max_px))
    labels = np.zeros((height, width), np.uint32)
    for stone in draw(st.lists(st.integers(1, 2**32 - 1), min_size=1, max_size=12, unique=True)):
        top, left = draw(st.integers(0, height - 1)), draw(st.integers(0, width - 1))
        down, right = draw(st.integers(1, 12)), draw(st.integers(1, 12))
        labels[top : top + down, left : left + right] = stone
    return labels
