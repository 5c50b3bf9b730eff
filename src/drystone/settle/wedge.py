"""Wedging with outlines: a small stone under the free side of one that would fall (§3.7, Fig. 9c).

A wedge is the free space itself between two upright lines, so it touches the stone and what is
below it all along.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.crevice import SAME, Crevice, between, crevice, slabs
from drystone.kernels.polygons import Points, Polygons, area_and_centroid, mirrored_polygon, on_grid
from drystone.kernels.settling import rest_margin
from drystone.model.wedge_shape import ROUNDING, WedgeRule, WedgeShape, open_sides
from drystone.settle.rest import Repose, SettlingScene, Start, Turned, touch_down
from drystone.settle.settings import SettleSettings

Span = tuple[float, float]
"""A wedge or a part of a crevice from one x to another."""

ASPECT = 1.25
"""Width of a wedge over its height, where there is room and the least width is less."""
WIDENINGS = 8
"""How often a wedge is made wider whose height grows with its width."""

PLACES = 4
"""How many places are tried in each part of the gap, from the nearest to the furthest."""


@dataclass(frozen=True, kw_only=True)
class WedgeLimits(WedgeRule):
    """What a wedge may be, and how it must hold a stone; source px."""

    margin: float = 0.0  # see `StabiliseSettings`
    clearance_px: float = 0.01  # gap that is left above and below
    contact_px: float = 0.1  # gaps up to this one touch
    setback: float = 0.01  # see `SettleSettings`
    # between a stone and the end of the wall, in which another may come to stand beside its wedge
    room_px: float = 0.0
    rest: float = 0.0  # how far gravity may lean until the wedged stone moves, over mu, at least
    steep: float = -1.0  # see `SettleSettings`


class CreviceSlabs(NamedTuple):
    """A crevice cut into slabs with straight floors and lids (:func:`slabs`)."""

    x: Points  # (n + 1,): where the slabs begin, and the end of the last
    # (n, 2): y of floor and lid at the left and at the right of each slab
    low: Points
    high: Points

    @classmethod
    def of(cls, space: Crevice) -> "CreviceSlabs":
        """Cut a crevice at all its corners, from its left end to its right end."""
        return cls(*slabs(space, *extent(space.lid)))

    def shape(self, span: Span) -> WedgeShape:
        """Measure what fills a span."""
        first = int(np.searchsorted(self.x, span[0], side="right")) - 1
        last = int(np.searchsorted(self.x, span[1]))
        x = self.x[first : last + 1].copy()
        shares = (np.array(span) - x[[0, -2]]) / (x[[1, -1]] - x[[0, -2]])
        faces = []
        for line in (self.low, self.high):
            face = line[first:last].copy()
            ends = face[[0, -1], 0] + (face[[0, -1], 1] - face[[0, -1], 0]) * shares
            face[0, 0], face[-1, 1] = ends
            faces.append(face)
        x[[0, -1]] = span
        return WedgeShape.of_slabs(x, *faces)


def wedge_under(
    stone: Points,
    centroid: tuple[float, float],
    around: Polygons,
    width: float,
    limits: WedgeLimits,
) -> Points | None:
    """Cut the wedge, (m, 2) counter-clockwise, that keeps a stone where it is (§3.7, Fig. 9c).

    Of the free space under the side to which the stone falls, the nearest piece is taken that is
    far enough out to bring the centre of mass inside the support, is a wedge that a mason would
    cut, has something beside it or room for it, rests by itself on what is below, and holds the
    stone.  None when there is none.  The stone touches something below, in the wall frame; `width`
    is that of the wall.
    """
    falls = falling_side(stone, centroid[0], around, limits)
    if falls == 0:
        return None
    near, mu, steep = _near(stone, around, limits), limits.mu, limits.steep
    for wedge in _wedges(stone, centroid[0], near, falls, limits):
        if not rests(wedge, near, width, limits):
            continue
        on_it = near.added([wedge])
        margin = rest_margin(stone, centroid, on_it, width, mu, limits.contact_px, steep=steep)
        if margin >= limits.rest and not squeezed_out(wedge, stone, around, width, limits):
            return wedge
    return None


def wedges_below(polygons: Polygons, stone: int, limits: WedgeLimits) -> Iterator[Points]:
    """List wedges, (m, 2) on the grid, in the free space under a stone, whatever they shall hold.

    `stone` says which of the polygons it is.
    """
    corners = polygons.polygon(stone)
    space = crevice(corners, _near(corners, polygons, limits, stone), limits.clearance_px)
    for span in all_spans(CreviceSlabs.of(space), limits):
        wedge = between(space, *span)
        if wedge is not None:
            yield gridded(wedge)


def gridded(wedge: Points) -> Points:
    """Return a wedge with its corners on the grid, of which no two in a row are the same."""
    corners = on_grid(wedge)
    return np.asarray(corners[(corners != np.roll(corners, 1, axis=0)).any(axis=1)])


def rests(wedge: Points, around: Polygons, width: float, limits: WedgeLimits) -> bool:
    """Say whether a wedge rests on what is below it, rigid, without the stone on it."""
    _, x, y = area_and_centroid(wedge)
    mu, contact_px, steep = limits.mu, limits.contact_px, limits.steep
    return rest_margin(wedge, (x, y), around, width, mu, contact_px, steep=steep) >= 0.0


def squeezed_out(
    wedge: Points, stone: Points, around: Polygons, width: float, limits: WedgeLimits
) -> bool:
    """Say whether nothing is beside a wedge at a side, and no other stone can come there.

    `stone` lies on it; `around` is what else is there, or will be: both may be among it.
    """
    left = stone[:, 0].min() < limits.room_px - ROUNDING
    right = stone[:, 0].max() > width - limits.room_px + ROUNDING
    if not (left or right):
        return False
    opened = open_sides(wedge, around.added([stone]))
    return bool((left and opened[0]) or (right and opened[1]))


def falling_side(stone: Points, x_c: float, around: Polygons, limits: WedgeLimits) -> int:
    """Say to which side a stone on its contacts falls: -1 left, +1 right.

    0 when its centre of mass, at `x_c`, lies over the support, as far inside as `limits.margin`
    says, and when nothing supports it.
    """
    x, low, high = slabs(crevice(stone, around, 0.0), *extent(stone))
    run = (x[1:] - x[:-1])[:, None]
    slope = np.minimum(np.abs(low[:, 1:] - low[:, :1]), np.abs(high[:, 1:] - high[:, :1])) / run
    # A corner over a sloping face is nearer to it than it is above it.
    touches = high - low <= limits.contact_px * np.sqrt(1.0 + slope * slope)
    supports = np.column_stack([x[:-1], x[1:]])[touches]
    if not len(supports):
        return 0
    from_left, from_right = x_c - float(supports.min()), float(supports.max()) - x_c
    if min(from_left, from_right) >= limits.margin * (x[-1] - x[0]):
        return 0
    return -1 if from_left < from_right else 1


def _wedges(
    stone: Points, x_c: float, around: Polygons, falls: int, limits: WedgeLimits
) -> Iterator[Points]:
    """List the wedges that could hold a stone which falls to a side, the best places first."""
    if falls < 0:
        mirrored = _wedges(mirrored_polygon(stone, 0.0), -x_c, around.mirrored(0.0), 1, limits)
        yield from (mirrored_polygon(wedge, 0.0) for wedge in mirrored)
        return
    space = crevice(stone, around, limits.clearance_px)
    for span in _spans(space, x_c, limits):
        wedge = between(space, *span)
        if wedge is not None:
            yield wedge


def _spans(space: Crevice, x_c: float, limits: WedgeLimits) -> Iterator[Span]:
    """List where a wedge may be that holds a stone which falls to the right, the nearest first."""
    table = CreviceSlabs.of(space)
    least = x_c + limits.margin * float(table.x[-1] - table.x[0])
    for part in parts(table, limits):
        last = part[1] - limits.least_width
        if part[1] < least or part[0] > last:
            continue
        first = min(max(part[0], least), last)
        for left in np.linspace(first, last, PLACES if first < last else 1).tolist():
            span = fitted(table, left, part, limits)
            if span is not None:
                yield span


def met_below(stone: Points, around: Points, limits: WedgeLimits) -> NDArray[np.bool_]:
    """Say which polygons, by their (k, 4) boxes, a stone, or a wedge under it, could meet.

    A box is left, bottom, right and top.  The stone itself is met, if it is one of them.
    """
    reach = limits.contact_px + 4.0 * limits.clearance_px
    left, low = stone.min(axis=0) - reach
    right, high = stone.max(axis=0) + reach
    met = (around[:, 0] < right) & (around[:, 2] > left) & (around[:, 1] < high)
    return np.asarray(met & (around[:, 3] > low - limits.greatest_height))


def _near(
    stone: Points, around: Polygons, limits: WedgeLimits, itself: int | None = None
) -> Polygons:
    """Return the polygons that a stone or a wedge under it could meet, but not the stone itself."""
    met = met_below(stone, around.boxes, limits)
    if itself is not None:
        met[itself] = False
    return in_order(around, np.flatnonzero(met).tolist())


def in_order(polygons: Polygons, chosen: list[int]) -> Polygons:
    """Return some of the polygons, or all in another order."""
    first = polygons.first
    ends = [slice(first[i], first[i + 1]) for i in chosen]
    sizes = np.diff(first)[np.array(chosen, np.int64)]
    return Polygons(
        np.concatenate([polygons.corners[:0], *(polygons.corners[part] for part in ends)]),
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        polygons.boxes[chosen],
        np.concatenate([polygons.edges[:0], *(polygons.edges[part] for part in ends)]),
    )


def all_spans(table: CreviceSlabs, limits: WedgeLimits) -> list[Span]:
    """List where wedges may be anywhere in a crevice, from left to right.

    At :data:`PLACES` from one end to the other of each part of it: as wide as high there; and over
    the whole part.
    """
    found: list[Span] = []
    for part in parts(table, limits):
        last = part[1] - limits.least_width
        if last < part[0]:
            continue
        places = np.linspace(part[0], last, PLACES).tolist()
        spans = [fitted(table, left, part, limits) for left in places]
        spans.append(part if limits.allows(table.shape(part), SAME) else None)
        found += [span for span in dict.fromkeys(spans) if span is not None]
    return found


def fitted(table: CreviceSlabs, left: float, part: Span, limits: WedgeLimits) -> Span | None:
    """Make the narrowest span from a place on as wide as it is high: outwards, then inwards.

    None when that is no wedge.
    """
    right = min(left + limits.least_width, part[1])
    for _ in range(WIDENINGS):
        height = table.shape((left, right)).height
        if height <= right - left:
            break
        right = min(left + ASPECT * height, part[1])
        left = max(min(left, right - ASPECT * height), part[0])
    return (left, right) if limits.allows(table.shape((left, right)), SAME) else None


def parts(table: CreviceSlabs, limits: WedgeLimits) -> list[Span]:
    """List the parts of a crevice that are neither too thin nor too thick; steps end a part."""
    x, low, high = table
    thick = high - low
    fits = thick.max(axis=1) >= limits.least_thickness
    fits &= thick.min(axis=1) <= limits.greatest_height
    step = np.maximum(np.abs(low[1:, 0] - low[:-1, 1]), np.abs(high[1:, 0] - high[:-1, 1]))
    joined = np.append(False, step <= SAME)
    found: list[Span] = []
    for i in np.flatnonzero(fits).tolist():
        start, stop = _fitting((float(x[i]), float(x[i + 1])), thick[i].tolist(), limits)
        if joined[i] and found and found[-1][1] == start:
            start = found.pop()[0]
        found.append((start, stop))
    return found


def _fitting(slab: Span, thick: list[float], limits: WedgeLimits) -> Span:
    """Return the part of a slab where its thickness, which is linear, is that of a wedge."""
    if thick[0] == thick[1]:
        return slab
    ends = sorted(
        (limit - thick[0]) / (thick[1] - thick[0])
        for limit in (limits.least_thickness, limits.greatest_height)
    )
    run = slab[1] - slab[0]
    return (
        slab[0] if ends[0] <= 0.0 else slab[0] + run * ends[0],
        slab[1] if ends[1] >= 1.0 else slab[0] + run * ends[1],
    )


def extent(points: Points) -> Span:
    """Return the least and the largest x."""
    return float(points[:, 0].min()), float(points[:, 0].max())


def wedged(
    stone: Turned, scene: SettlingScene, start: Start, settings: SettleSettings, limits: WedgeLimits
) -> tuple[Repose, Points] | None:
    """Lower a stone without turning it, and wedge it there: where it rests, and its wedge.

    None when no wedge holds it.
    """
    repose = touch_down(stone, scene, start, settings)
    wedge = None if repose is None else wedge_for(repose, scene, limits)
    return None if repose is None or wedge is None else (repose, wedge)


def wedge_for(repose: Repose, scene: SettlingScene, limits: WedgeLimits) -> Points | None:
    """Cut the wedge that holds a stone where `touch_down` lowered it; None when none does.

    It is in the wall frame, (n, 2), counter-clockwise.
    """
    x, corners = repose.settled.x_px, repose.settled.corners
    if scene.side == "right":
        x, corners = scene.width_px - x, mirrored_polygon(corners, scene.width_px)
    centroid = (x, repose.settled.y_px)
    wedge = wedge_under(corners, centroid, scene.polygons, scene.width_px, limits)
    if wedge is None:
        return None
    if scene.side == "right":
        wedge = mirrored_polygon(wedge, scene.width_px)
    return gridded(wedge)
