"""Slow, obvious twin of drystone.kernels.crevice: what one upright line meets; and lowering."""

import numpy as np


def met(polygon, x):
    """Heights at which an upright line crosses a polygon, from the lowest; x is at no corner."""
    found = []
    for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if (x0 < x) != (x1 < x):
            found.append(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
    return sorted(found)


def gap_at(stone, around, x):
    """Floor and lid on an upright line; equal where the stone stands in something."""
    lid = met(stone, x)[0]
    floor = 0.0 if lid >= 0.0 else lid
    for i in range(len(around)):
        heights = met(around.polygon(i), x)
        for low, high in zip(heights[::2], heights[1::2], strict=True):
            if low <= lid:
                floor = max(floor, min(high, lid))
    return floor, lid


def drop(stone, around):
    """How far a stone that is above everything else can go down until it touches."""
    least = float(stone[:, 1].min())
    for i in range(len(around)):
        other = around.polygon(i)
        for polygon, points, sign in ((other, stone, 1.0), (stone, other, -1.0)):
            for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
                for x, y in points:
                    if x0 != x1 and min(x0, x1) <= x <= max(x0, x1):
                        least = min(least, sign * (y - y0 - (y1 - y0) * (x - x0) / (x1 - x0)))
                    elif x0 == x1 == x:
                        least = min(least, sign * (y - y0), sign * (y - y1))
    return least
