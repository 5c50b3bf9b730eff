"""Slow and obvious twins of what the plotting room computes."""

import numpy as np

from tests.naive.outline import inside


def covered(loops, shape):
    """Fill loops pixel by pixel: a pixel is inside of an odd number of them."""
    height, width = shape
    found = [
        sum(inside(loop.tolist(), col + 0.5, height - row - 0.5) for loop in loops) % 2
        for row in range(height)
        for col in range(width)
    ]
    return np.array(found, bool).reshape(shape)


def signed_area(loop):
    """Shoelace formula; positive for counter-clockwise loops."""
    total = 0.0
    for (x0, y0), (x1, y1) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
        total += (x0 * y1 - x1 * y0) / 2
    return total
