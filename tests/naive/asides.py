"""How far polygons go aside to clear one, line by line with shapely."""

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
    deepest = 0.0
    for j in range(32):
        low, high = (start + (end - start) * k / 32 for k in (j, j + 1))
        box = shapely.box(-1e4, low, 1e4, high) if axis == 0 else shapely.box(low, -1e4, high, 1e4)
        ours, theirs = box.intersection(one), box.intersection(other)
        if not (ours.is_empty or theirs.is_empty):
            near, far = (ours, theirs) if sign > 0 else (theirs, ours)
            deepest = max(deepest, near.bounds[2 + axis] - far.bounds[axis])
    return deepest
