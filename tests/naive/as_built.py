"""A wall as it is built, whose loads are found from its top for each block alone."""

import math
from dataclasses import replace
from typing import NamedTuple

from drystone.kernels.as_built import moved_with
from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import no_polygons, polygon_edges, turn
from drystone.kernels.settling import Status, settle
from tests.naive.putting import put_down


class Bearing(NamedTuple):
    x: float
    y: float
    below: int


class Bed(NamedTuple):
    points: list  # that it bears on
    faced: list  # the same, with upright faces where its weight acts beside those
    below: frozenset  # whose the points are; without points, those that hold it


HELD = Bed([Bearing(-math.inf, 0.0, -1), Bearing(math.inf, 0.0, -1)], [], frozenset())


class SlowWall:
    """Blocks as they lie, with their beds where these are known."""

    def __init__(self, mu, how, laid=(), beds=()):
        self.mu, self.how, self.laid, self.beds = mu, how, dict(laid), dict(beds)

    def polygons(self, without=()):
        return no_polygons().added(b.corners for i, b in self.laid.items() if i not in without)

    def rest_of(self, built):
        """Return where a block comes to rest, or None, and who is pushed; None without room."""
        outline, at = turn(built.outline, built.angle_deg), (built.x, built.y)
        edges, how = polygon_edges(outline), self.how(built.size)
        found, pushed = put_down(outline, edges, at, self.polygons(), *how)
        if found is None:
            return None, pushed
        angle_deg = built.angle_deg + math.degrees(found.angle)
        return replace(built, x=found.x, y=found.y, angle_deg=angle_deg), pushed

    def put(self, pieces):
        wall = SlowWall(self.mu, self.how, self.laid, self.beds)
        for block, built in pieces:
            rest, pushed = (None, {}) if block in wall.laid else wall.rest_of(built)
            if rest is None:
                continue
            moved = {list(wall.laid)[place]: shift for place, shift in pushed.items()}
            for i, shift in moved.items():
                wall.laid[i] = replace(wall.laid[i], x=wall.laid[i].x + shift)
            for i, bed in list(wall.beds.items()):
                if bed is not HELD and (i in moved or bed.below & set(moved)):
                    del wall.beds[i]
            wall.laid[block] = rest
        return wall

    def find_beds(self):
        ids = [*self.laid, -1]
        for place, block in enumerate(self.laid):
            if block in self.beds:
                continue
            built, around = self.laid[block], self.polygons().leading(place)
            found = meetings(built.corners, around, self.how(built.size).rules.tolerance)
            touched = sorted(
                (Bearing(x, y, ids[other]), up)
                for other, count, points, (_, up) in zip(*found, strict=True)
                for x, y in points[:count]
            )
            points = faced = [point for point, up in touched if up >= 0.3]
            if not points or not points[0].x <= built.x <= points[-1].x:
                faced = [point for point, up in touched if up > -0.3]
            below = {p.below for p in points} or {ids[other] for other in found.others}
            self.beds[block] = Bed(points, faced, frozenset(below - {-1}))

    def burden(self, blocks):
        some = set(blocks)
        for one in self.laid:
            some |= {one} if self.beds[one].below & some else set()
        return some

    def loaded(self, block):
        wall = SlowWall(self.mu, self.how, self.laid, self.beds)
        beneath = {block, *(i for i in wall.laid if i not in wall.beds)}
        wall.find_beds()
        for one in reversed(wall.laid):
            beneath |= wall.beds[one].below if one in beneath else set()
        for one in [i for i in wall.laid if i in beneath and i != block]:
            if one not in wall.laid or wall.stays(one, wall.beds):
                continue
            faced = {i: bed._replace(points=bed.faced) for i, bed in wall.beds.items()}
            held = {i: HELD for i, bed in wall.beds.items() if bed is HELD}
            if not wall.stays(one, {**faced, **held, one: wall.beds[one]}):
                wall = wall.rolled(one)
        return wall

    def stays(self, block, beds):
        near = self.how(self.laid[block].size).rules.tolerance
        return stays(block, self.laid, beds, self.burden([block]), self.mu, near)

    def rolled(self, block):
        """Let a block go under its load, and put down again what lies on it."""
        built, out = self.laid[block], self.burden([block])
        _, x, y = load(block, self.laid, self.beds, out)
        corners, below = built.corners - (x, y), self.polygons(out)
        edges, rules = polygon_edges(corners), self.how(built.size).rules
        for sticks in (True, False):
            found = settle(corners, edges, (x, y, 0.0), below, 0.0, rules._replace(sticks=sticks))
            if found.status is Status.RESTS:
                break
        if found.status is Status.RESTS and found[1:4] == (x, y, 0.0):
            return self
        left = {i: b for i, b in self.laid.items() if i not in out}
        left = SlowWall(self.mu, self.how, left, {i: self.beds[i] for i in left})
        again = {i: b for i, b in self.laid.items() if i in out}
        if found.status is Status.RESTS:
            del again[block]
            turn_deg = math.degrees(found.angle)
            left.laid[block] = moved_with(built, (x, y), (found.x, found.y), turn_deg)
        elif found.status is not Status.OVERLAPS:
            del again[block]
        after, rest = left.put(again.items()), left.laid.get(block)
        if block not in again and rest is None:
            at = (x, y, 0.0)
            if left.gives_way(built, after, again) or left.comes_back(block, built, at, again):
                return self
        if rest is not None and not again.keys() <= after.laid.keys():
            for i in again.keys() - after.laid.keys():
                way = (built.x, built.y), (rest.x, rest.y), rest.angle_deg - built.angle_deg
                again[i] = moved_with(again[i], *way)
            after = left.put(again.items())
        if rest is not None or block in again:
            lost = [b for i, b in again.items() if i not in after.laid]
            if any(after.rest_of(one)[1] is None for one in lost):
                return self
        after.find_beds()
        return after

    def gives_way(self, built, after, again):
        """Say whether a block rests alone, and what lies on it stays without it."""
        corners, rules = built.corners - (built.x, built.y), self.how(built.size).rules
        pose = (built.x, built.y, 0.0)
        edges, around = polygon_edges(corners), self.polygons()
        alone = settle(corners, edges, pose, around, 0.0, rules).status is Status.RESTS
        return alone and all(is_near(after.laid.get(i), one) for i, one in again.items())

    def comes_back(self, block, built, at, again):
        """Say whether its load acts over the edge again once a block has tipped about it."""
        corners, rules = built.corners - at[:2], self.how(built.size).rules
        half = rules._replace(turn=rules.turn / 2, shift=rules.shift / 2)
        end = settle(corners, polygon_edges(corners), at, self.polygons(), 0.0, half)
        tipped = moved_with(built, at[:2], (end.x, end.y), math.degrees(end.angle))
        wall = SlowWall(self.mu, self.how, {**self.laid, block: tipped}, self.beds)
        wall = wall.put(again.items())
        if not all(is_near(wall.laid.get(i), one) for i, one in again.items()):
            return False
        wall.find_beds()
        _, x, _ = load(block, wall.laid, wall.beds, wall.burden([block]))
        on = wall.beds[block].points
        over = any(one.x <= x if end.angle > 0.0 else one.x >= x for one in on)
        return over or wall.stays(block, wall.beds)


def is_near(one, other):
    """Less than half of a fall from each other; not so where one is gone."""
    if one is None:
        return False
    way = math.hypot(one.x - other.x, one.y - other.y) / one.size
    return way <= 0.125 and abs(one.angle_deg - other.angle_deg) <= 6.0


def load(block, laid, beds, burden):
    """Return the weight of a block with its share of all that lies on it, and where that acts."""
    size = laid[block].size
    parts = [(size**2, laid[block].x, laid[block].y)]
    for one in burden:
        on = beds[one].points
        if all(bearing.below != block for bearing in on):
            continue
        weight, x, _ = load(one, laid, beds, burden)
        left, right = beside(on, x)
        share = (right.x - x) / (right.x - left.x) if left.x <= x < right.x else 1.0
        shares = [(left, share), (right, 1.0 - share)]
        parts += [(weight * part, b.x, b.y) for b, part in shares if b.below == block]
    whole = sum(weight for weight, _, _ in parts)
    return whole, sum(w * x for w, x, _ in parts) / whole, sum(w * y for w, _, y in parts) / whole


def beside(points, x):
    """Return the points next to a load on both sides, beyond an end the same one twice."""
    left = max((b for b in points if b.x <= x), key=lambda b: b.x, default=points[0])
    right = min((b for b in points if b.x > x), key=lambda b: b.x, default=points[-1])
    return left, right


def stays(block, laid, beds, burden, mu, near):
    """Say whether a block bears its load, by what would hold it were it to roll about its edge."""
    on = beds[block].points
    if not on:
        return False
    whole, x, _ = load(block, laid, beds, burden)
    if on[0].x - near <= x <= on[-1].x + near:
        return True
    edge, way = (on[0], 1.0) if x < on[0].x else (on[-1], -1.0)
    torque = way * (edge.x - laid[block].x) * laid[block].size ** 2
    for other in burden:
        points = beds[other].points
        here = [one for one in points if one.below == block]
        if not here:
            continue
        weight, at, _ = load(other, laid, beds, burden)
        left, right = beside(points, at)
        for bears, held in ((left, right), (right, left)):
            if bears.below != block:
                continue
            point = bears
            share = (at - held.x) / (bears.x - held.x) if bears.x != held.x else 0.5
            share = share if left.x <= at <= right.x else 0.5
            if held.below != block and bears.x != held.x:
                # Of all points on its side those that help: the ones towards the block's middle.
                side = [b for b in here if (b.x - held.x) * (bears.x - held.x) > 0]
                last = max(side, key=lambda b: way * b.x)
                if abs(last.x - held.x) > abs(bears.x - held.x):
                    point, share = last, (at - held.x) / (last.x - held.x)
                lesser = min(share, 1.0 - share)
                torque -= mu * weight * lesser * (point.y - edge.y)
            torque += way * (edge.x - point.x) * weight * share
    return torque <= near * whole
