"""Slow twins of drystone.kernels.outline and of what stones are made of."""

import numpy as np
import shapely

from tests.naive.io import holes


def inside(corners, x, y):
    """Say whether a point is inside any polygon, even one that crosses itself: even-odd rule."""
    within = False
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        if min(y0, y1) <= y < max(y0, y1) and x0 + (y - y0) * (x1 - x0) / (y1 - y0) <= x:
            within = not within
    return within


def filled(mask):
    """Pixels with their holes filled."""
    return mask | holes(mask)


def rim(mask):
    """Middles of the pixel edges around a stone, from the mask's bottom-left corner, y up."""
    solid = np.pad(filled(mask), 1)
    height, points = len(mask), []
    for row, col in np.argwhere(solid).tolist():
        x, y = col - 0.5, height - row + 0.5  # of its centre
        for down, right in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            if not solid[row + down, col + right]:
                points.append(shapely.Point(x + right / 2, y - down / 2))
    return points
