"""A block that is put down, lift by lift, with shapely for what overlaps beside it."""

import math

import numpy as np
import shapely

from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import no_polygons, turn
from drystone.kernels.settling import Status, settle

ALONG = np.array((1.0, 0.0))


def put_down(outline, edges, at, around, rules, lifts, last, most, gap):
    """Return how it rests, or None, and by how much others are pushed; None without room."""
    room, others = False, [around.polygon(i) for i in range(len(around))]
    wide = rules._replace(turn=2.0 * rules.turn, shift=2.0 * rules.shift)
    for sticks, some, by in ((True, lifts, rules), (False, lifts, rules), (True, last, wide)):
        for lift in some:
            x, y = at[0], at[1] + lift
            shift, moved, pushed = squeezed_in(outline + np.array((x, y)), others, most, gap)
            pose, heap = (x + shift, y, 0.0), no_polygons().added(moved)
            found = settle(outline, edges, pose, heap, 0.0, by._replace(sticks=sticks))
            if found.status is Status.RESTS:
                if leans(outline, found, heap, rules.tolerance):
                    down = settle(
                        outline, edges, found[1:4], heap, 0.0,
                        by._replace(sticks=sticks, steep=0.3, turn=by.turn / 5, shift=by.shift / 5),
                    )  # fmt: skip
                    near = down.status is Status.RESTS and found.y - down.y <= by.shift / 5
                    if near and not leans(outline, down, heap, rules.tolerance):
                        found = down
                return found, pushed
            room = room or found.status is not Status.OVERLAPS
    return None, {} if room else None


def leans(outline, rest, around, tolerance):
    """Say whether a block has its centroid beside all that it bears on."""
    corners = turn(outline, math.degrees(rest.angle)) + np.array((rest.x, rest.y))
    found = meetings(corners, around, tolerance)
    xs = [
        x
        for count, points, (_, up) in zip(found.counts, found.points, found.normals, strict=True)
        for x, _ in points[:count]
        if up >= 0.3
    ]
    return not xs or not min(xs) <= rest.x <= max(xs)


def squeezed_in(corners, others, most, gap):
    """Return how far a block goes aside, where all others lie then, and who is pushed how far."""
    others, (bottom, top) = list(others), (corners[:, 1].min(), corners[:, 1].max())

    def beside(one, sign):
        found = asides(one, others, gap, sign)
        return {
            i: way
            for i, way in found.items()
            if others[i][:, 1].min() < top and others[i][:, 1].max() > bottom
        }

    def deepest(shift, sign):
        return max(beside(corners + shift * ALONG, sign).values(), default=0.0)

    left, right = deepest(0.0, -1.0), deepest(0.0, 1.0)
    shift, pushed = (left - right) / 2, {}
    if bool(left) != bool(right):
        sign = math.copysign(1.0, shift)
        shift = 2 * shift - sign * deepest(2 * shift, sign) / 2
    if not left + right or abs(shift) > most:
        return 0.0, others, pushed
    for sign in (-1.0, 1.0):
        todo = [corners + shift * ALONG]
        while todo:
            for i, way in beside(todo.pop(), sign).items():
                if way < most:
                    others[i] = others[i] + sign * way * ALONG
                    pushed[i] = pushed.get(i, 0.0) + sign * way
                    todo.append(others[i])
    return shift, others, pushed


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
    near, far = (
        shapely.bounds(shapely.intersection(boxes, shape)) for shape in (one, other)[:: int(sign)]
    )
    # Nothing has no bounds.
    return float(np.nanmax(near[:, 2 + axis] - far[:, axis], initial=0.0))
