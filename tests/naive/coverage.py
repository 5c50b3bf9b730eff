"""Slow twins of drystone.kernels.coverage: one cell after the other."""

import math

import numpy as np
import shapely


def coverage(corners):
    """The area that a polygon and each cell of its box have in common."""
    shape = shapely.Polygon(corners)
    left, bottom = (math.floor(value) for value in shape.bounds[:2])
    right, top = (math.ceil(value) for value in shape.bounds[2:])
    y, x = np.mgrid[bottom : max(top, bottom + 1), left : max(right, left + 1)]
    shares = shapely.area(shapely.intersection(shapely.box(x, y, x + 1, y + 1), shape))
    return shares[::-1], left, bottom


def newly_filled(total, shares):
    """The cells (row, col) of the grid that change from less than half to at least half."""
    return {
        at
        for at in np.ndindex(total.shape)
        if total[at] < 0.5 - 1e-12 <= float(total[at]) + float(shares[at])
    }
