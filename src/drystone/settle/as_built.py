"""A wall as it is built, with errors (DESIGN 4.10).

A block comes to rest on others that do not move (:mod:`drystone.settle.putting`).  Then its weight
goes down through the wall: from each block by the lever to the two points it bears on left and
right of where its load acts.  A block whose load acts beside all that it bears on is let go again
under that load, unless it is held, and what lies on it is put down again.
"""

import math
from bisect import bisect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import Polygons, no_polygons, place_on_grid, polygon_edges
from drystone.kernels.raster import turn
from drystone.kernels.settling import Status, settle
from drystone.model.builder import Built
from drystone.poses import wrap_deg
from drystone.settle.putting import astray, moved, put_down, settling_rules, touching
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import in_order

UPWARD = 0.3
"""A block bears on what it touches where the normal of the contact goes up by at least so much."""


class Bearing(NamedTuple):
    """A point that a block bears on."""

    x: float
    y: float
    below: int  # whose it is; -1 is the ground


class Bed(NamedTuple):
    """What a block bears on."""

    points: Sequence[Bearing]  # from left to right
    below: frozenset[int]  # the blocks whose they are; without points, those that hold it
    # The same, and where its own weight acts beside them also those of upright faces at it.
    faced: Sequence[Bearing]


_ENDS = Bearing(-math.inf, 0.0, -1), Bearing(math.inf, 0.0, -1)
HELD = Bed(_ENDS, frozenset(), _ENDS)
"""The bed of a block that stays, whatever comes onto it."""

NOWHERE = (math.inf, math.inf, -math.inf, -math.inf)
"""A box that meets no other."""


@dataclass(frozen=True, eq=False)
class BuiltWall:
    """Blocks as they lie, each after all that it bears on."""

    mu: float
    settle: SettleSettings
    laid: Mapping[int, Built] = field(default_factory=dict)  # in the order of `polygons`
    polygons: Polygons = field(default_factory=no_polygons)
    beds: Mapping[int, Bed] = field(default_factory=dict)  # where they are known

    @property
    def held_bytes(self) -> int:
        """About how much memory it takes."""
        return 2 * self.polygons.corners.nbytes + 400 * len(self.laid)

    def put(self, pieces: Iterable[tuple[int, Built]]) -> "BuiltWall":
        """Put blocks down on what does not move; those that rest nowhere are left out.

        What is there stays as it is: a wedge whose stone has fallen waits for it.
        """
        laid, polygons, beds = dict(self.laid), self.polygons, dict(self.beds)
        for block, built in pieces:
            if block in laid:
                continue
            rest, pushed = put_down(built, polygons, self.mu, self.settle)
            if rest is None:
                continue
            if pushed:
                polygons = moved(polygons, pushed)
                ids = list(laid)
                shifts = {ids[place]: shift for place, shift in pushed.items()}
                for one, shift in shifts.items():
                    laid[one] = replace(laid[one], x=laid[one].x + shift)
                for one, bed in list(beds.items()):
                    if bed is not HELD and (one in shifts or not bed.below.isdisjoint(shifts)):
                        del beds[one]
            laid[block] = rest
            polygons = polygons.added([rest.corners])
        return replace(self, laid=laid, polygons=polygons, beds=beds)

    def held(self, blocks: Mapping[int, Built]) -> "BuiltWall":
        """Hold blocks where they are, whatever they bear on."""
        new = {i: built for i, built in blocks.items() if i not in self.laid}
        polygons = self.polygons.added(built.corners for built in new.values())
        beds = {**self.beds, **dict.fromkeys(blocks, HELD)}
        return replace(self, laid={**self.laid, **new}, polygons=polygons, beds=beds)

    def with_burden(self, blocks: Iterable[int]) -> set[int]:
        """Return blocks and all that lies on them; all beds are known."""
        some = set(blocks)
        for one in self.laid:
            if not some.isdisjoint(self.beds[one].below):
                some.add(one)
        return some

    def without(self, blocks: Iterable[int]) -> "BuiltWall":
        """Take up blocks, and all that lies on them; all beds are known."""
        out = self.with_burden(blocks)
        left = [place for place, one in enumerate(self.laid) if one not in out]
        laid = {i: one for i, one in self.laid.items() if i not in out}
        beds = {i: self.beds[i] for i in laid}
        return replace(self, laid=laid, polygons=in_order(self.polygons, left), beds=beds)

    def lost(self, before: "BuiltWall") -> list[int]:
        """List the blocks of a wall before that have fallen since."""
        known = ((i, one, self.laid.get(i)) for i, one in before.laid.items())
        return [i for i, one, now in known if now is not one and (not now or astray(now, one))]

    def loaded(self, block: int) -> "BuiltWall":
        """Let what carries a block move under it, each at most once.

        What was pushed on the way to it, and what lies on that, may move too.
        """
        wall = _with_beds(self)
        beneath = {block, *(one for one in wall.laid if one not in self.beds)}
        for one in reversed(list(wall.laid)):
            if one in beneath:
                beneath |= wall.beds[one].below
        loads = _loads(wall, beneath)
        for one in [one for one in wall.laid if one in beneath and one != block]:
            if one not in wall.laid or _stays(wall, one, loads):  # it may have fallen with another
                continue
            # Upright faces may carry a part of what lies on it.
            beds = {
                i: bed if bed.faced is bed.points or i == one else bed._replace(points=bed.faced)
                for i, bed in wall.beds.items()
            }
            faced = replace(wall, beds=beds)
            if _stays(faced, one, _loads(faced, [one])):
                continue
            after = _rolled(wall, one, loads[one])
            if after is not wall:
                wall, loads = after, _loads(after, beneath)
        return wall


def _with_beds(wall: BuiltWall) -> BuiltWall:
    """Look for what blocks bear on where it is not known."""
    ids, beds = list(wall.laid), dict(wall.beds)
    for place, (block, built) in enumerate(wall.laid.items()):
        if block in beds:
            continue
        around = wall.polygons.leading(place)
        found = meetings(built.corners, around, touching(built.size, wall.settle))
        others = [ids[other] if other >= 0 else -1 for other in found.others.tolist()]
        told = zip(
            *(part.tolist() for part in (found.counts, found.points, found.normals)), strict=True
        )
        touched = sorted(
            (Bearing(x, y, other), up)
            for other, (count, points, (_, up)) in zip(others, told, strict=True)
            for x, y in points[:count]
        )
        points = faced = [point for point, up in touched if up >= UPWARD]
        if not points or not points[0].x <= built.x <= points[-1].x:
            # Friction on these holds it, as it came to rest there.
            faced = [point for point, up in touched if up > -UPWARD]
        # What bears on nothing is held between upright faces.
        below = {p.below for p in points} or set(others)
        beds[block] = Bed(points, frozenset(below - {-1}), faced)
    return replace(wall, beds=beds)


class Load(NamedTuple):
    """The weight of a block, with what lies on it, and where it acts."""

    weight: float
    x: float
    y: float


def _loads(wall: BuiltWall, blocks: Iterable[int]) -> dict[int, Load]:
    """Return the loads of blocks, and of all that lies on them."""
    burden = wall.with_burden(blocks)
    sums, loads = {}, {}
    for block in [one for one in wall.laid if one in burden]:
        built = wall.laid[block]
        weight = built.size**2
        sums[block] = [weight, weight * built.x, weight * built.y]
    for one in reversed(list(sums)):
        weight, x, y = sums[one]
        load = loads[one] = Load(weight, x / weight, y / weight)
        on = wall.beds[one].points
        if not on:
            continue
        left, right = _carrying(on, load.x)
        share = (load.x - left.x) / (right.x - left.x) if right.x > left.x else 0.0
        for bearing, part in ((left, weight * (1.0 - share)), (right, weight * share)):
            below = sums.get(bearing.below)
            if below is not None:
                below[0] += part
                below[1] += part * bearing.x
                below[2] += part * bearing.y
    return loads


def _carrying(on: Sequence[Bearing], x: float) -> tuple[Bearing, Bearing]:
    """Return the points left and right of a load; one beside all hangs on the last, twice."""
    i = bisect(on, (x,))
    return on[i - 1 if i else 0], on[i if i < len(on) else -1]


def _stays(wall: BuiltWall, block: int, loads: Mapping[int, Load]) -> bool:
    """Say whether a block bears its load.

    A stone on it that another block bears too comes to bear further in, and with less, once the
    block begins to roll.  Friction with that stone holds it back, as far as the other one holds it.
    """
    on, built = wall.beds[block].points, wall.laid[block]
    if not on:
        return False
    near = touching(built.size, wall.settle)
    weight, x, _ = loads[block]
    left = x < on[0].x
    edge = on[0] if left else on[-1]
    beside = edge.x - x if left else x - edge.x
    if beside <= near:
        return True
    moment = weight * beside  # about the edge, that rolls it
    for other, bed in wall.beds.items():
        if block not in bed.below or not bed.points:
            continue
        part, at, _ = loads[other]
        two = _carrying(bed.points, at)
        outer, held = two if two[0].below == block else two[::-1]
        if outer.below != block or held.below == block or outer.x == held.x:
            continue
        # Of all points of both the last one on the way to the middle of the block.
        inner = max(
            (p for p in bed.points if p.below == block and (p.x - held.x) * (outer.x - held.x) > 0),
            key=lambda p: abs(p.x - held.x),
        )
        inner = inner if (held.x < outer.x) == left else outer
        was, share = (part * (at - held.x) / (end.x - held.x) for end in (outer, inner))
        sign = 1.0 if left else -1.0
        moment += sign * (share * (edge.x - inner.x) - was * (edge.x - outer.x))
        moment -= wall.mu * min(share, part - share) * (inner.y - edge.y)
    return moment <= near * weight


def _rolled(wall: BuiltWall, block: int, load: Load) -> BuiltWall:
    """Let a block go under its load, and put down again what lies on it.

    It stays where it is held: what lies on it has no room to follow.
    """
    built = wall.laid[block]
    _, x, y = load
    out = wall.with_burden([block])
    # Nothing touches what has no box.
    boxes = wall.polygons.boxes.copy()
    boxes[[place for place, one in enumerate(wall.laid) if one in out]] = NOWHERE
    around = Polygons(wall.polygons.corners, wall.polygons.first, boxes, wall.polygons.edges)
    rest = None
    corners = built.corners - (x, y)  # gravity acts there
    edges = polygon_edges(corners)
    rules = settling_rules(built.size, wall.mu, wall.settle)
    for sticks in (True, False):
        way = rules._replace(sticks=sticks)
        found = settle(corners, edges, (x, y, 0.0), around, 0.0, way)
        if found.status is Status.RESTS:
            if (found.x, found.y, found.angle) == (x, y, 0.0):
                return wall
            turn_deg = math.degrees(found.angle)
            ((aside, up),) = turn(np.array([(built.x - x, built.y - y)]), turn_deg).tolist()
            x, y = place_on_grid(aside + found.x, up + found.y)
            angle_deg = wrap_deg(built.angle_deg + turn_deg)
            rest = Built(built.outline, x, y, angle_deg, built.size)
            break
    below = wall.without(out)
    if rest is not None:
        polygons = below.polygons.added([rest.corners])
        below = replace(below, laid={**below.laid, block: rest}, polygons=polygons)
    # What was pushed into another is put down again, too.
    pushed = rest is None and found.status is Status.OVERLAPS
    again = {i: one for i, one in wall.laid.items() if i in out and (pushed or i != block)}
    after = below.put(again.items())
    if rest is not None and not again.keys() <= after.laid.keys():
        # What finds no place where it was goes with the block.
        again |= {i: _along(one, built, rest) for i, one in again.items() if i not in after.laid}
        after = below.put(again.items())
        lost = (one for i, one in again.items() if i not in after.laid)
        if any(put_down(one, after.polygons, wall.mu, wall.settle)[1] is None for one in lost):
            return wall
    return _with_beds(after)


def _along(one: Built, before: Built, after: Built) -> Built:
    """Return a block that moves with another one."""
    turn_deg = after.angle_deg - before.angle_deg
    ((x, y),) = turn(np.array([(one.x - before.x, one.y - before.y)]), turn_deg).tolist()
    angle_deg = wrap_deg(one.angle_deg + turn_deg)
    return Built(one.outline, after.x + x, after.y + y, angle_deg, one.size)
