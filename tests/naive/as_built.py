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
    normal_deg: float = 0.0  # from straight up, to the right

    def leans(self, mu, way):
        """Return how far a reaction may lean to the right (1) or left (-1): aside over up."""
        if abs(self.normal_deg) > math.degrees(math.acos(0.3)):
            return 4.0 * way
        angle_deg = self.normal_deg + way * math.degrees(math.atan(mu))
        furthest = math.degrees(math.atan(4.0))
        return math.tan(math.radians(min(max(angle_deg, -furthest), furthest)))


class Reaction(NamedTuple):
    """What holds a block at a point: up, and to the right."""

    at: Bearing
    up: float
    aside: float


class Bed(NamedTuple):
    points: list  # that it bears on
    faced: list  # the same, with upright faces where its weight acts beside those
    below: frozenset  # whose the points are; without points, those that hold it

    level: float = 0.0  # mean height of the points


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
                (Bearing(x, y, ids[other], math.degrees(math.atan2(aside, up))), up)
                for other, count, points, (aside, up) in zip(*found, strict=True)
                for x, y in points[:count]
            )
            points = faced = [point for point, up in touched if up >= 0.3]
            if not points or not points[0].x <= built.x <= points[-1].x:
                faced = [point for point, up in touched if up > -0.3]
            below = {p.below for p in points} or {ids[other] for other in found.others}
            level = sum(one.y for one in points) / max(1, len(points))
            self.beds[block] = Bed(points, faced, frozenset(below - {-1}), level)

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
            if one not in wall.laid or wall.stays(one, wall.beds, beneath):
                continue
            faced = {i: bed._replace(points=bed.faced) for i, bed in wall.beds.items()}
            held = {i: HELD for i, bed in wall.beds.items() if bed is HELD}
            if not wall.stays(one, {**faced, **held, one: wall.beds[one]}, {one}):
                wall = wall.rolled(one, beneath)
        return wall

    def stays(self, block, beds, beneath):
        near = self.how(self.laid[block].size).rules.tolerance
        burden = self.burden(beneath & self.laid.keys())
        return stays(block, self.laid, beds, burden, self.mu, near)

    def rolled(self, block, beneath):
        """Let a block go under its load, and put down again what lies on it."""
        built, out = self.laid[block], self.burden([block])
        acting = self.burden(beneath & self.laid.keys())
        _, x, y, _ = load(block, self.laid, self.beds, acting, self.mu)
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
            if left.gives_way(built, after, again) or any(
                left.tips_back(block, built, at, again, part) for part in (0.05, 0.5)
            ):
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
        return alone and all(is_near(after.laid.get(i), one, 0.5) for i, one in again.items())

    def tips_back(self, block, built, at, again, part):
        """Say whether its load acts over the edge again once a block has tipped so far."""
        corners, rules = built.corners - at[:2], self.how(built.size).rules
        less = rules._replace(turn=part * rules.turn, shift=part * rules.shift)
        end = settle(corners, polygon_edges(corners), at, self.polygons(), 0.0, less)
        tipped = moved_with(built, at[:2], (end.x, end.y), math.degrees(end.angle))
        wall = SlowWall(self.mu, self.how, {**self.laid, block: tipped}, self.beds)
        wall = wall.put(again.items())
        if not all(is_near(wall.laid.get(i), one, 1.0) for i, one in again.items()):
            return False
        wall.find_beds()
        _, x, *_ = load(block, wall.laid, wall.beds, wall.burden([block]), self.mu)
        on = wall.beds[block].points
        over = any(one.x <= x if end.angle > 0.0 else one.x >= x for one in on)
        return over or wall.stays(block, wall.beds, {block})


def is_near(one, other, share):
    """Within so much of a fall from each other; not so where one is gone."""
    if one is None:
        return False
    way = math.hypot(one.x - other.x, one.y - other.y) / one.size
    return way <= 0.25 * share and abs(one.angle_deg - other.angle_deg) <= 12.0 * share


def above(block, beds, burden):
    """Return what may bear on a block, or lean on it."""
    return [i for i in burden if any(one.below == block for one in beds[i].points + beds[i].faced)]


def load(block, laid, beds, burden, mu):
    """Return the weight of a block with what lies on it, where that acts, and the push aside.

    Where it acts, x, is on the level of its bed, and y is that of the weights.
    """
    own = laid[block]
    parts = [Reaction(Bearing(own.x, own.y, -1), own.size**2, 0.0)]
    for one in above(block, beds, burden):
        parts += [held for held in reactions(one, laid, beds, burden, mu) if held.at.below == block]
    whole, push = sum(part.up for part in parts), -sum(part.aside for part in parts)
    level = beds[block].level
    x = sum(p.up * p.at.x - p.aside * (p.at.y - level) for p in parts) / whole
    return whole, x, sum(p.up * p.at.y for p in parts) / whole, push


def reactions(block, laid, beds, burden, mu):
    """Return what holds a block under its load: one or two reactions, then that of a face."""
    bed = beds[block]
    if not bed.points or bed is HELD:
        return []
    whole, x, _, push = load(block, laid, beds, burden, mu)
    left, right = beside(bed.points, x)
    if left is not right:
        share = (right.x - x) / (right.x - left.x) if right.x > left.x else 1.0
        ups = whole * share, whole * (1.0 - share)
        # What the left one may give to the right, by its own friction and by that of the other.
        own = [ups[0] * left.leans(mu, way) for way in (-1, 1)]
        rest = [-push - ups[1] * right.leans(mu, way) for way in (1, -1)]
        least, most = max(own[0], rest[0]), min(own[1], rest[1])
        aside = sorted((least, -push * share, most))[1] if least <= most else (least + most) / 2
        return [Reaction(left, ups[0], aside), Reaction(right, ups[1], -push - aside)]
    faces = []
    for face in bed.faced if bed.faced is not bed.points else ():
        steep_deg = abs(face.normal_deg)
        if abs(steep_deg - 90.0) >= math.degrees(math.asin(0.3)):
            continue
        if (x - left.x) * face.normal_deg >= 0.0:
            continue
        # Friction turns the reaction up, towards the block's own weight.
        turned_deg = steep_deg - math.degrees(math.atan(mu))
        aside = -math.copysign(math.sin(math.radians(turned_deg)), x - left.x)
        up = math.cos(math.radians(turned_deg))
        torque = (face.x - left.x) * up - (face.y - left.y) * aside
        if torque * (x - left.x) > 0.0:
            force = whole * min((x - left.x) / torque, 1.0 / up if up > 0.0 else math.inf)
            faces.append((abs(torque), Reaction(face, force * up, force * aside)))
    found = [max(faces, key=lambda one: one[0])[1]] if faces else []
    up, aside = (sum(getattr(one, name) for one in found) for name in ("up", "aside"))
    return [Reaction(left, whole - up, -push - aside), *found]


def beside(points, x):
    """Return the points next to a load on both sides, beyond an end the same one twice."""
    if x <= points[0].x or x > points[-1].x:
        end = points[0] if x <= points[0].x else points[-1]
        return end, end
    after = next(i for i, one in enumerate(points) if one.x >= x)
    return points[after - 1], points[after]


def stays(block, laid, beds, burden, mu, near):
    """Say whether a block bears its load, by what would hold it were it to roll about its edge."""
    on, level = beds[block].points, beds[block].level
    if not on:
        return False
    whole, x, *_ = load(block, laid, beds, burden, mu)
    if on[0].x - near <= x <= on[-1].x + near:
        return True
    edge, way = (on[0], 1.0) if x < on[0].x else (on[-1], -1.0)
    torque = way * (edge.x - laid[block].x) * laid[block].size ** 2
    for other in above(block, beds, burden):
        found = reactions(other, laid, beds, burden, mu)
        for bears in found:
            if bears.at.below != block:
                continue
            torque += way * bears.aside * (bears.at.y - level)
            point, up = bears.at, bears.up
            held = next((one for one in found if one.at is not bears.at), bears)
            between = len(found) == 2 and all(one.at in beds[other].points for one in found)
            if between and held.at.below != block and point.x != held.at.x:
                # Of all points on its side those that help: the ones towards the block's middle.
                both, away = up + held.up, point.x - held.at.x
                side = [
                    one
                    for one in beds[other].points
                    if one.below == block and (one.x - held.at.x) * away > 0
                ]
                last = max(side, key=lambda one: way * one.x)
                if abs(last.x - held.at.x) > abs(away):
                    point, up = last, up * away / (last.x - held.at.x)
                # So much the two can give each other, the block's own way back and against it.
                forth = way * (both - up) * held.at.leans(mu, way)
                back = min(-way * up * point.leans(mu, -way), forth)
                torque -= max(back, 0.0) * (point.y - edge.y)
            torque += way * (edge.x - point.x) * up
    return torque <= near * whole
