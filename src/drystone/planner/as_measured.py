"""A wall built again as it was measured: stones brought apart, and lowered until they rest."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from operator import itemgetter

import numpy as np

from drystone.errors import InputError
from drystone.kernels.gaps import crosses_any
from drystone.kernels.polygons import Points, place_on_grid
from drystone.kernels.raster import wrap_deg
from drystone.model.placement import Placement, Side
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.model.wall import Group
from drystone.planner.build import Build, Candidate
from drystone.planner.evaluate import Evaluator
from drystone.planner.measured import MeasuredPlace
from drystone.planner.replay import judged, replayed
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.settle.placing import settled_in
from drystone.settle.rest import (
    Repose,
    SettlingScene,
    Start,
    Turned,
    come_to_rest,
    lay,
    settled_at,
)
from drystone.settle.wedge import wedged

FAR = 0.1
"""A stone that is moved so far, over its size, from where it was measured is named (W127)."""

ENOUGH_PX = 1.5
"""A stone that rests so near to where it was measured, source px, is looked for no further."""

LIKE = 0.4
"""Places whose coordinates, source px and degrees, are in the same steps of this are alike."""

WEDGED = 6
"""So many of the places where it is let go are tried with wedges."""

JUDGED = 24
"""So many places near the measured one are judged at most."""

AWAY_PX = (0.5, 1.0, 2.0, 4.0, 8.0)
"""So far from the measured place, source px, a stone is let go where it overlaps others."""

AROUND = ((0.0, 1.0), (-0.7, 0.7), (0.7, 0.7), (-1.0, 0.0), (1.0, 0.0))
"""Directions of these."""

REACH = 0.25
"""So far, over its size, a stone may come to rest from where it was measured."""

ROOM = 3
"""So many working px a stone that is pixels is moved at most before it is stabilised."""

SAME_ANGLE_DEG = 2.0
"""Stones that are pixels may have the planned angle instead of one that is so near."""


Rested = tuple[Repose, Points | None]
"""Where a stone rests, and the wedge that holds it there."""


@dataclass(frozen=True, eq=False)
class Measured:
    """A stone that is to be put where it was measured."""

    stone: Stone
    place: MeasuredPlace
    side: Side  # the end of the wall from which it was placed
    planned: Group | None  # how it was planned: with wedges it gets one again

    def moved_px(self, x_px: float, y_px: float, angle_deg: float) -> float:
        """Return how far the rim of the stone is from where it was measured, about."""
        place = self.place
        turned = math.radians(abs(wrap_deg(angle_deg - place.angle_deg)))
        shift = math.hypot(x_px - place.x_px, y_px - place.y_px)
        return shift + 0.5 * turned * math.sqrt(self.stone.area_px)

    def placed_px(self, placement: Placement, build: Build) -> float:
        """Return the same for a placement in a wall, source px."""
        site = build.wall.site
        x, y = placement.centroid(site.height_px)
        return self.moved_px(x / site.scale, y / site.scale, placement.posed.angle_deg)

    def rested_px(self, rested: Rested) -> float:
        """Return the same for a place where it rests."""
        at = rested[0].settled
        return self.moved_px(at.x_px, at.y_px, rested[0].angle_deg)

    @property
    def reach_px(self) -> float:
        """How far that may be."""
        return REACH * math.sqrt(self.stone.area_px)

    def marked(self, stabilised: Group) -> Group:
        """Return a place that says when the stone is turned; its wedges keep their ids."""
        placement = stabilised.placement
        if self.planned is None:
            return stabilised
        before = self.planned.placement
        turned = before.posed.angle_deg != placement.posed.angle_deg
        moves = max(before.rotation_moves, placement.rotation_moves, int(turned))
        ids = {place: wedge.id for place, wedge in enumerate(self.planned.wedges)}
        wedges = (replace(w, id=ids.get(i, w.id)) for i, w in enumerate(stabilised.wedges))
        return Group(replace(placement, rotation_moves=moves), tuple(wedges))


def rebuilt(
    start: Build,
    before: Build,
    order: Sequence[int],
    added: Sequence[int],
    places: Mapping[int, MeasuredPlace],
    workshop: Workshop,
    settings: PlannerSettings,
) -> Build:
    """Build the wall of `before` again as it was measured, from an empty `start`.

    `order` are the planned stones that are in the wall, in their order of placement, `added` the
    others that are.  These come after all planned ones; from below where stones then do not stand,
    or are far from where they were measured: one may lie under a stone that was planned.
    InputError (E198) where a stone overlaps others wherever it is moved to.
    """
    orders = [[*order, *added]]
    if added:
        orders.append(sorted(orders[0], key=lambda i: (places[i].y_px, i)))
    walls: list[Build] = []
    errors: list[InputError] = []
    for stone_ids in orders:
        try:
            walls.append(_built(start, before, places, workshop, settings, stone_ids))
        except InputError as error:
            errors.append(error)
            continue
        if not any(_amiss(walls[-1], places)):
            break
    if not walls:
        raise errors[0]
    return min(walls, key=lambda wall: _amiss(wall, places))


def far_from(build: Build, places: Mapping[int, MeasuredPlace]) -> tuple[int, ...]:
    """Return the stones that are far from where they were measured, in the order of placement."""
    far = []
    for placement in build.wall.placements:
        stone = placement.posed.stone
        one = Measured(stone, places[stone.id], placement.side, None)
        if one.placed_px(placement, build) > FAR * math.sqrt(stone.area_px):
            far.append(stone.id)
    return tuple(far)


def _amiss(build: Build, places: Mapping[int, MeasuredPlace]) -> tuple[int, int]:
    """Return after how many stones a wall does not stand, and how many are far off."""
    return sum(not action.stands for action in build.actions), len(far_from(build, places))


def _built(
    start: Build,
    before: Build,
    places: Mapping[int, MeasuredPlace],
    workshop: Workshop,
    settings: PlannerSettings,
    order: Iterable[int],
) -> Build:
    keep = settings.search.budget > 1
    groups = {group.placement.stone_id: group for group in before.wall.groups}
    heights = before.course_heights_px()
    build = start
    for stone_id in order:
        planned, place = groups.get(stone_id), places[stone_id]
        if planned is not None and place.as_planned:
            same = build, [planned], heights, workshop, settings
            again = replayed(*same, keep=keep, renumber=False)
            if not again.left_out:
                build = again.build
                continue
        side = "left" if planned is None else planned.placement.side
        one = Measured(workshop.stones.by_id(stone_id), place, side, planned)
        action = _put(build, one, workshop, settings, heights)
        if action is None:
            raise InputError(
                "E198",
                f"stone {stone_id}, measured at ({place.x_px:.1f}, {place.y_px:.1f}) source px, "
                f"{place.angle_deg:.1f} degrees, overlaps others, and there is no room near it.",
                where="observe",
                cure="Measure again; poses that are this far off are of another stone or frame.",
            )
        build = build.add(action, keep=keep)
    return build


def _put(
    build: Build,
    one: Measured,
    workshop: Workshop,
    settings: PlannerSettings,
    course_heights_px: Mapping[int, float],
) -> Candidate | None:
    """Return the action that puts a stone where it was measured, or close by.

    Of the places where it rests, by itself or on a wedge, the nearest is taken after which the
    wall stands; if there is none, the nearest at which it overlaps nothing.
    """
    if build.wall.outlines is None:
        options = _on_pixels(build, one, workshop)
    else:
        options = _on_outlines(build, one, workshop, settings)
    evaluator = Evaluator(settings, workshop.stock)
    fallback: Candidate | None = None
    for found in islice(options, JUDGED):
        candidate = judged(build, found, course_heights_px, evaluator)
        if candidate.stands:
            return candidate
        fallback = fallback or candidate
    return fallback


def _on_outlines(
    build: Build, one: Measured, workshop: Workshop, settings: PlannerSettings
) -> Iterator[Group]:
    """List places where an outline rests, the nearest first, and one where it need not."""
    wall, settle = build.wall, settings.settle
    scene = SettlingScene.of(wall.exact.polygons, wall.site.extent_px[0], one.side, settings.mu)
    turned = workshop.outlines.hung(one.stone, one.place.angle_deg, one.side).turned
    starts = _starts(turned, one.place, scene, settle.clearance_px)

    def held(starts: Iterable[Start]) -> list[Rested]:
        found = (wedged(turned, scene, start, settle, workshop.limits) for start in starts)
        return [one for one in found if one is not None]

    def alone(way: Callable[..., Repose | None], starts: Iterable[Start]) -> list[Rested]:
        found = (way(turned, scene, start, settle) for start in starts)
        return [(one, None) for one in found if one is not None]

    def taken_in(repose: Repose, wedge: Points | None) -> Iterator[Group]:
        """Give a stone with the pixels that it fills, unless it fills none or leaves the wall."""
        # Measured stones are not where they were planned: half a working px is allowed at least.
        allowed_px = max(settle.beyond_px, 0.5 / wall.site.scale)
        (left, _), (right, top) = (end(repose.settled.corners, axis=0) for end in (np.min, np.max))
        if max(-left, right - scene.width_px, top - wall.site.extent_px[1]) < allowed_px:
            number = workshop.next_wedge(build)
            found = settled_in(wall, one.stone, one.side, repose, wedge, wedge_id=number)
            if found is not None:
                yield one.marked(found)

    on_wedges = one.planned is not None and bool(one.planned.wedges)
    for first in held(starts[:1]) if on_wedges else alone(lay, starts[:1]):
        if one.rested_px(first) <= ENOUGH_PX:
            yield from taken_in(*first)
    rested = alone(lay, starts) + alone(come_to_rest, starts) + held(starts[:WEDGED])
    for found in _different(sorted(rested, key=one.rested_px)):
        if one.rested_px(found) <= one.reach_px:
            yield from taken_in(*found)
    for start in starts:
        if not crosses_any(turned.corners + np.array(start), scene.polygons):
            # Where it was let go it does not rest.
            x = start[0] if scene.side == "left" else scene.width_px - start[0]
            x, y = place_on_grid(x, start[1])
            there = settled_at(turned.outline, turned.angle_deg, x, y)
            repose = Repose(there, turned.angle_deg, turned=False, margin=-1.0)
            yield from taken_in(repose, None)
            return


def _different(rested: Iterable[Rested]) -> Iterator[Rested]:
    """Leave out places that are as good as one before: a stone rests there or does not."""
    seen: set[tuple[int, int, int, bool]] = set()
    for found in rested:
        at, angle_deg = found[0].settled, found[0].angle_deg
        place = round(at.x_px / LIKE), round(at.y_px / LIKE), round(angle_deg / LIKE)
        key = (*place, found[1] is None)
        if key not in seen:
            seen.add(key)
            yield found


def _starts(
    turned: Turned, place: MeasuredPlace, scene: SettlingScene, clearance_px: float
) -> list[Start]:
    """Return where a stone is let go: within the wall, nearest first."""
    low, high = turned.corners.min(axis=0), turned.corners.max(axis=0)
    x = place.x_px if scene.side == "left" else scene.width_px - place.x_px
    least_x, most_x = clearance_px - float(low[0]), scene.width_px - clearance_px - float(high[0])
    least_y = clearance_px - float(low[1])
    moves = [(0.0, 0.0)] + [(away * dx, away * dy) for away in AWAY_PX for dx, dy in AROUND]
    inside = (
        (min(max(x + dx, least_x), max(least_x, most_x)), max(place.y_px + dy, least_y))
        for dx, dy in moves
    )
    return list(dict.fromkeys(inside))


def _on_pixels(build: Build, one: Measured, workshop: Workshop) -> Iterator[Group]:
    """List places of a stone that is pixels, the nearest first."""
    book, occupied, number = workshop.book, build.wall.occupied, workshop.next_wedge(build)
    poses = [book.pose(one.stone, one.place.angle_deg)]
    if one.planned is not None:
        angle = one.planned.placement.posed.angle_deg
        if abs(wrap_deg(angle - one.place.angle_deg)) <= SAME_ANGLE_DEG:
            poses.append(book.pose(one.stone, angle))
    spots = [spot for posed in poses for spot in _spots(build, posed, one.place)]
    found = []
    for _, posed, row, col in sorted(spots, key=itemgetter(0)):
        trial = posed, row, col
        there = workshop.memory.stabilise(occupied, trial, one.side, number)
        if there is not None:
            found.append((one.placed_px(there.placement, build), there))
    allowed = max(one.reach_px, (ROOM + 2) / build.wall.site.scale)
    for moved, there in sorted(found, key=itemgetter(0)):
        if moved <= allowed:
            yield one.marked(there)
    for _, posed, row, col in spots[:1]:
        yield one.marked(Group(Placement(posed, row, col, one.side)))


def _spots(
    build: Build, posed: PosedStone, place: MeasuredPlace
) -> list[tuple[float, PosedStone, int, int]]:
    """Return where a stone has room near a place, the nearest first.

    How far it is from the measured place, working px; the stone, and the corner of its mask.
    """
    site, occupied = build.wall.site, build.wall.occupied
    left = place.x_px * site.scale - posed.anchor[0]
    top = site.height_px - (place.y_px * site.scale - posed.anchor[1]) - posed.height_px
    found = []
    for row in range(round(top) - ROOM, round(top) + ROOM + 1):
        for col in range(round(left) - ROOM, round(left) + ROOM + 1):
            inside = row >= 0 and col >= 0 and row + posed.height_px <= site.height_px
            if not inside or col + posed.width_px > site.width_px:
                continue
            window = occupied[row : row + posed.height_px, col : col + posed.width_px]
            if not (window & posed.mask).any():
                found.append((float(np.hypot(row - top, col - left)), posed, row, col))
    return sorted(found, key=itemgetter(0))
