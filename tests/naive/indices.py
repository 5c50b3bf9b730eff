"""Slow, obvious twins of the indices, from label images and from the formulas of §3.5."""

import math
from types import SimpleNamespace

import numpy as np
from shapely import affinity

from tests.naive.raster import polygon_of


def extent_of(pixels):
    """Extent of the set pixels of a wall image, in the wall frame, y up."""
    rows, cols = np.nonzero(pixels[::-1])
    x0, x1, y0, y1 = (int(end) for one in (cols, rows) for end in (one.min(), one.max() + 1))
    return SimpleNamespace(x0=x0, x1=x1, y0=y0, y1=y1)


def painted(shape, mask, row, col):
    """The wall image with one stone in it."""
    image = np.zeros(shape, bool)
    image[row : row + mask.shape[0], col : col + mask.shape[1]] = mask
    return image


def shape_factor(mask, angle_deg):
    """Eq. 3: pixels over the box of all of them, turned."""
    left, low, right, high = affinity.rotate(polygon_of(mask), angle_deg).bounds
    return mask.sum() / ((right - left) * (high - low))


def dice_score(occupied, stone):
    """Eq. 5 on whole images: the box B is painted."""
    if not occupied.any():
        return 0.0
    box = np.zeros_like(occupied)
    box[np.flatnonzero(occupied.any(axis=1))[0] :] = True
    inside = np.count_nonzero(stone & box) / np.count_nonzero(stone)
    return float(inside * np.count_nonzero(box) / np.count_nonzero(stone | box))


def left_neighbour(labels, stone):
    """Id of the nearest stone to the left with half the smaller height in common rows."""
    me = extent_of(stone)
    nearest = None
    for value in np.unique(labels[labels > 0]):
        other = extent_of(labels == value)
        common = sum(other.y0 <= y < other.y1 for y in range(me.y0, me.y1))
        smaller = min(me.y1 - me.y0, other.y1 - other.y0)
        if common >= smaller / 2 and other.x1 <= (me.x0 + me.x1) / 2:
            key = (other.x1, other.y1, int(value))
            nearest = key if nearest is None or key[:2] > nearest[:2] else nearest
    return None if nearest is None else nearest[2]


def neighbour_height_ratio(labels, stone, other_heights):
    """Eq. 6-8."""
    me = extent_of(stone)
    height = me.y1 - me.y0
    neighbour = left_neighbour(labels, stone)
    if neighbour is not None:
        return abs(me.y1 - extent_of(labels == neighbour).y1) / height
    if not other_heights:
        return 0.0
    return abs(height - sum(other_heights) / len(other_heights)) / height


def interlocking(labels, stone, end_px):
    """Eq. 9 as DESIGN 4.5 mends it; corners up to end_px from an end of the wall are none."""
    me = extent_of(stone)
    if me.y0 == 0:
        return 0.5
    ones, twos = [], []
    for value in np.unique(labels[labels > 0]):
        other = extent_of(labels == value)
        if other.y1 > (me.y0 + me.y1) / 2:
            continue
        width = other.x1 - other.x0
        if labels.shape[1] - other.x1 > end_px:
            distance = math.dist((other.x1, other.y1), (me.x0, me.y0))
            ones.append((distance, abs(me.x0 - other.x1) / width))
        if other.x0 > end_px:
            distance = math.dist((other.x0, other.y1), (me.x1, me.y0))
            twos.append((distance, abs(me.x1 - other.x0) / width))
    # Several equally near corners: the stone placed first (ids rise in the walls drawn here).
    terms = [min(1.0, min(found, key=lambda f: f[0])[1]) for found in (ones, twos) if found]
    return sum(terms) / len(terms) if terms else 0.5


def inward_slope(stone, x_c):
    """Eq. 10 on the wall image."""
    height, width = stone.shape
    tops = {
        col + 0.5: height - int(np.flatnonzero(stone[:, col])[0])
        for col in range(width)
        if stone[:, col].any()
    }
    left = {x: y for x, y in tops.items() if x <= x_c}
    right = {x: y for x, y in tops.items() if x >= x_c}
    if not left or not right:
        return 0.0
    x_l = min(x for x, y in left.items() if y == max(left.values()))
    x_r = max(x for x, y in right.items() if y == max(right.values()))
    if x_l == x_r:
        return 0.0
    slope = (left[x_l] - right[x_r]) / (x_l - x_r)
    sign = (x_c > width / 2) - (x_c < width / 2)
    return max(-1.0, min(1.0, float(slope * sign)))
