"""A wall as it is built, with errors (DESIGN 4.10).

A block comes to rest on others that do not move (:mod:`drystone.settle.putting`).  Then its weight
goes down through the wall: from each block by the lever to the two points it bears on left and
right of where its load acts.  A block whose load acts beside all that it bears on does not stay: it
is let go again under that load, and what lies on it is put down again.
"""

import math
from bisect import bisect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import Polygons, no_polygons, on_grid, polygon_edges
from drystone.kernels.raster import turn
from drystone.kernels.settling import Status
from drystone.model.builder import Built
from drystone.poses import wrap_deg
from drystone.settle.putting import astray, let_go, moved, put_down, touching
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import in_order

UPWARD = 0.3
"""A block bears on what it touches where the normal of the contact goes up by at least so much."""


class Bearing(NamedTuple):
    """A point that a block bears on."""

    x: float
    y: float
    below: int  # whose it is; -1 is the ground


HELD = (Bearing(-math.inf, 0.0, -1), Bearing(math.inf, 0.0, -1))
"""What a block bears on that stays, whatever comes onto it."""


@dataclass(frozen=True, eq=False)
class BuiltWall:
    """Blocks as they lie, each after all that it bears on."""

    mu: float
    settle: SettleSettings
    laid: Mapping[int, Built] = field(default_factory=dict)  # in the order of `polygons`
    polygons: Polygons = field(default_factory=no_polygons)
    # What blocks bear on, from left to right, where it is known.
    bearings: Mapping[int, Sequence[Bearing]] = field(default_factory=dict)

    def put(self, pieces: Iterable[tuple[int, Built]]) -> "BuiltWall":
        """Put blocks down on what does not move; those that rest nowhere are left out.

        What is there stays as it is: a wedge whose stone has fallen waits for it.
        """
        laid, polygons, bearings = dict(self.laid), self.polygons, dict(self.bearings)
        for block, built in pieces:
            if block in laid:
                continue
            rest, pushed = put_down(built, polygons, self.mu, self.settle)
            if rest is None:
                continue
            ids = list(laid)
            shifts = {ids[place]: shift for place, shift in pushed.items()}
            for one, shift in shifts.items():
                laid[one] = replace(laid[one], x=laid[one].x + shift)
            for one, on in list(bearings.items()) if shifts else ():
                both = {one, *(bearing.below for bearing in on)}
                if on is not HELD and not both.isdisjoint(shifts):
                    del bearings[one]
            laid[block] = rest
            polygons = moved(polygons, pushed).added([rest.corners])
        return replace(self, laid=laid, polygons=polygons, bearings=bearings)

    def held(self, blocks: Mapping[int, Built]) -> "BuiltWall":
        """Hold blocks where they are, whatever they bear on."""
        new = {i: built for i, built in blocks.items() if i not in self.laid}
        polygons = self.polygons.added(built.corners for built in new.values())
        bearings = {**self.bearings, **dict.fromkeys(blocks, HELD)}
        return replace(self, laid={**self.laid, **new}, polygons=polygons, bearings=bearings)

    def without(self, blocks: Iterable[int]) -> "BuiltWall":
        """Take up blocks, and all that lies on them; what all bear on is known."""
        out = set(blocks)
        for one in self.laid:
            if not out.isdisjoint(bearing.below for bearing in self.bearings[one]):
                out.add(one)
        left = [place for place, one in enumerate(self.laid) if one not in out]
        laid = {i: one for i, one in self.laid.items() if i not in out}
        bearings = {i: self.bearings[i] for i in laid}
        return replace(self, laid=laid, polygons=in_order(self.polygons, left), bearings=bearings)

    def lost(self, before: "BuiltWall") -> list[int]:
        """List the blocks of a wall before that have fallen since."""
        now = self.laid
        return [i for i, one in before.laid.items() if i not in now or astray(now[i], one)]

    def loaded(self, block: int) -> "BuiltWall":
        """Let what carries a block move under it, each at most once."""
        wall = _with_bearings(self)
        beneath = {block}
        for one in reversed(list(wall.laid)):
            if one in beneath:
                beneath |= {bearing.below for bearing in wall.bearings[one]}
        loads = _loads(wall)
        for one in [one for one in wall.laid if one in beneath and one != block]:
            if one in wall.laid:  # it may have fallen with another
                after = _rolled(wall, one, loads[one])
                if after is not wall:
                    wall, loads = after, _loads(after)
        return wall


def _with_bearings(wall: BuiltWall) -> BuiltWall:
    """Look for what blocks bear on where it is not known."""
    ids, bearings = list(wall.laid), dict(wall.bearings)
    for place, (block, built) in enumerate(wall.laid.items()):
        if block in bearings:
            continue
        below = wall.polygons.leading(place)
        found = meetings(built.corners, below, touching(built.size, wall.settle))
        told = zip(found.others, found.counts, found.points, found.normals, strict=True)
        bearings[block] = sorted(
            Bearing(x, y, ids[other] if other >= 0 else -1)
            for other, count, points, normal in told
            if normal[1] >= UPWARD
            for x, y in points[:count].tolist()
        )
    return replace(wall, bearings=bearings)


def _loads(wall: BuiltWall) -> dict[int, tuple[float, float]]:
    """Return where the weight of each block and of what lies on it acts."""
    sums = {i: [b.size**2, b.size**2 * b.x, b.size**2 * b.y] for i, b in wall.laid.items()}
    loads = {}
    for one in reversed(list(wall.laid)):
        weight, x, y = sums[one]
        x, y = loads[one] = x / weight, y / weight
        on = wall.bearings[one]
        if not on:
            continue
        # What acts beside all that it bears on hangs on the last point.
        i = bisect(on, (x,))
        left, right = on[max(i - 1, 0)], on[min(i, len(on) - 1)]
        share = (x - left.x) / (right.x - left.x) if right.x > left.x else 0.0
        for bearing, part in ((left, 1.0 - share), (right, share)):
            if bearing.below >= 0:
                for k, value in enumerate((1.0, bearing.x, bearing.y)):
                    sums[bearing.below][k] += weight * part * value
    return loads


def _rolled(wall: BuiltWall, block: int, load: tuple[float, float]) -> BuiltWall:
    """Let a block go under its load, and put down again what lies on it, if it does not stay."""
    built, on = wall.laid[block], wall.bearings[block]
    x, y = load
    if on and on[0].x <= x <= on[-1].x:
        return wall
    below = wall.without([block])
    again = [i for i in wall.laid if i not in below.laid and i != block]
    corners = built.corners - load  # gravity acts there
    edges = polygon_edges(corners)
    for sticks in (True, False):
        found = let_go(
            corners, edges, load, built.size, below.polygons, wall.mu, wall.settle, sticks=sticks
        )
        if found.status is Status.RESTS:
            if (found.x, found.y, found.angle) == (*load, 0.0):
                return wall
            turn_deg = math.degrees(found.angle)
            (way,) = turn(np.array([(built.x - x, built.y - y)]), turn_deg)
            x, y = on_grid(way + (found.x, found.y)).tolist()  # noqa: RUF005 - an array
            angle_deg = wrap_deg(built.angle_deg + turn_deg)
            rest = Built(built.outline, x, y, angle_deg, built.size)
            polygons = below.polygons.added([rest.corners])
            below = replace(below, laid={**below.laid, block: rest}, polygons=polygons)
            break
    return _with_bearings(below.put((i, wall.laid[i]) for i in again))
