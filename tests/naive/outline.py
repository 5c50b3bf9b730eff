"""Slow twins of drystone.kernels.outline and of what stones are made of."""

import numpy as np
import shapely


def inside_by_floats(corners, x, y):
    """Say whether a point is inside any polygon, even one that crosses itself: even-odd rule."""
    inside = False
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        if min(y0, y1) <= y < max(y0, y1) and x0 + (y - y0) * (x1 - x0) / (y1 - y0) <= x:
            inside = not inside
    return inside


def filled(mask):
    """Pixels with their holes filled: what no way over edges leads out of."""
    free = {tuple(place) for place in np.argwhere(~np.pad(mask, 1)).tolist()}
    outside, left = {(0, 0)}, [(0, 0)]
    while left:
        row, col = left.pop()
        beside = {(row + 1, col), (row - 1, col), (row, col + 1), (row, col - 1)} & free - outside
        outside |= beside
        left += beside
    holes = free - outside
    found = mask.copy()
    for row, col in holes:
        found[row - 1, col - 1] = True
    return found


def rim(mask):
    """Middles of the pixel edges around a stone, from the mask's bottom-left corner, y up."""
    inside = np.pad(filled(mask), 1)
    height, points = len(mask), []
    for row, col in np.argwhere(inside).tolist():
        x, y = col - 0.5, height - row + 0.5  # of its centre
        for down, right in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            if not inside[row + down, col + right]:
                points.append(shapely.Point(x + right / 2, y - down / 2))
    return points
