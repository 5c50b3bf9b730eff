"""Slow and obvious twins of what the plotting room computes."""

import numpy as np


def covered(loops, shape):
    """Fill loops pixel by pixel: a pixel is inside when a ray to its right crosses an odd number
    of edges."""
    height, width = shape
    mask = np.zeros(shape, bool)
    for row in range(height):
        for col in range(width):
            x, y = col + 0.5, height - row - 0.5
            crossings = 0
            for loop in loops:
                for (x0, y0), (x1, y1) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
                    if x0 == x1 and x0 > x and min(y0, y1) < y < max(y0, y1):
                        crossings += 1
            mask[row, col] = crossings % 2 == 1
    return mask


def signed_area(loop):
    """Shoelace formula; positive for counter-clockwise loops."""
    total = 0.0
    for (x0, y0), (x1, y1) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
        total += (x0 * y1 - x1 * y0) / 2
    return total
