"""How far polygons go aside to clear one, strip by strip with shapely."""

import numpy as np
import shapely


def asides(corners, others, gap, sign):
    """Return how far others must go to a side, by their number."""
    one, found = shapely.Polygon(corners), {}
    for i, other in enumerate(map(shapely.Polygon, others)):
        (x0, y0, x1, y1), (u0, v0, u1, v1) = one.bounds, other.bounds
        low, high = max(y0, v0), min(y1, v1)
        beside = high - low >= 0.3 * min(y1 - y0, v1 - v0)
        if beside and sign * (u0 + u1 - x0 - x1) > 0 and one.intersects(other):
            across = depth(one, other, low, high, sign, 0)
            above = 1 if v0 + v1 >= y0 + y1 else -1
            if across < depth(one, other, max(x0, u0), min(x1, u1), above, 1):
                found[i] = across + gap
    return found


def depth(one, other, start, end, sign, axis):
    """Return how far along x (axis 0) or y another polygon must go to clear one."""
    lines = np.linspace(start, end, 33)
    if axis == 0:
        boxes = shapely.box(-1e4, lines[:-1], 1e4, lines[1:])
    else:
        boxes = shapely.box(lines[:-1], -1e4, lines[1:], 1e4)
    near, far = (boxes_of(boxes, shape) for shape in ((one, other)[:: int(sign)]))
    # Nothing has no bounds.
    return float(np.nanmax(near[:, 2 + axis] - far[:, axis], initial=0.0))


def boxes_of(boxes, shape):
    """Return the bounds of what a shape has in each of some boxes."""
    return shapely.bounds(shapely.intersection(boxes, shape))
