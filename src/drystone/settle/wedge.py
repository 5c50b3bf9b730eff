"""Wedging with outlines: a small stone under the free side of one that would fall (§3.7, Fig. 9c).

A wedge is the free space itself between two upright lines, so it touches the stone and what is
below it all along.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from drystone.kernels.crevice import SAME, Crevice, between, crevice, slabs
from drystone.kernels.polygons import (
    Points,
    Polygons,
    area_and_centroid,
    mirrored_polygon,
    no_polygons,
)
from drystone.kernels.settling import rest_margin

Span = tuple[float, float]

PLACES = 4
"""How many places are tried in each part of the gap, from the nearest to the furthest."""
ASPECT = 1.25
"""Width of a wedge over its height, where there is room and the smallest width is less."""
WIDENINGS = 8
"""How often a wedge is made wider whose height grows with its width."""


@dataclass(frozen=True, kw_only=True)
class WedgeLimits:
    """What a wedge may be, in source px.

    Parameters
    ----------
    smallest_px : float
        Smallest height and width; at any place, a wedge does not end in an edge.
    largest_px : float
        Largest height.
    margin : float
        Distance of the centre of mass from the end of the support, as a share of the stone's
        width.
    mu : float
        Coefficient of friction: no face of a wedge is steeper, or the load would push it out.
    clearance_px : float
        Gap that is left above and below.
    contact_px : float
        Gaps up to this one touch.
    rest : float
        How far gravity may lean until the wedged stone moves, over mu, at least.
    steep : float
        See :class:`drystone.settle.settings.SettleSettings`.
    """

    smallest_px: float
    largest_px: float
    margin: float = 0.0
    mu: float = 0.58
    clearance_px: float = 0.01
    contact_px: float = 0.1
    rest: float = 0.0
    steep: float = -1.0

    def __post_init__(self) -> None:
        if not 0 < self.smallest_px <= self.largest_px:
            raise ValueError(
                "sizes of a wedge must be positive, the largest not below the smallest"
            )
        if not 0 <= self.margin < 0.5 or self.mu <= 0:
            raise ValueError("margin must be in [0, 0.5), mu positive")
        if not 0 < 2 * self.clearance_px <= self.contact_px:
            raise ValueError("clearance must be above 0, contact_px at least twice as much")


class _Slabs(NamedTuple):
    """A crevice cut into slabs with straight floors and lids (:func:`slabs`)."""

    x: Points
    low: Points
    high: Points


def wedge_under(
    stone: Points,
    centroid: tuple[float, float],
    around: Polygons,
    width: float,
    limits: WedgeLimits,
    falls: int | None = None,
) -> Points | None:
    """Cut the wedge that keeps a stone where it is (§3.7, Fig. 9c).

    Of the free space under the side to which the stone falls, the nearest piece is taken that is
    far enough out to bring the centre of mass inside the support, has the size of a wedge and is
    not steeper than friction allows, is as wide as high where there is room, rests by itself on
    what is below, and holds the stone.

    Parameters
    ----------
    stone : (n, 2) float array
        The stone where it touches something below, counter-clockwise, in the wall frame.
    centroid : (float, float)
        Its centre of mass.
    around : Polygons
        The stones and wedges that are there.
    width : float
        Of the wall.
    limits : WedgeLimits
        What a wedge may be.
    falls : {-1, 1}, optional
        To which side the stone falls, left or right; found from its contacts when it is not given.

    Returns
    -------
    wedge : (m, 2) float array or None
        Its corners, counter-clockwise.  None when no wedge within the limits holds the stone.
    """
    if falls is None:
        falls = falling_side(stone, centroid[0], around, limits)
    if falls == 0:
        return None
    near = _near(stone, around, limits)
    for wedge in _wedges(stone, centroid[0], near, falls, limits):
        if _holds(wedge, (stone, centroid), near, width, limits):
            return wedge
    return None


def falling_side(stone: Points, x_c: float, around: Polygons, limits: WedgeLimits) -> int:
    """Say to which side a stone on its contacts falls: -1 left, +1 right.

    0 when its centre of mass lies over the support, as far inside as `limits.margin` says, and
    when nothing supports it.

    Parameters
    ----------
    stone, around, limits
        As for :func:`wedge_under`.
    x_c : float
        x of its centre of mass.
    """
    x, low, high = slabs(crevice(stone, around, 0.0), *_extent(stone))
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


def _holds(
    wedge: Points,
    stone: tuple[Points, tuple[float, float]],
    around: Polygons,
    width: float,
    limits: WedgeLimits,
) -> bool:
    """Say whether a wedge rests on what is below it alone, and the stone rests with it."""
    _, *centroid = area_and_centroid(wedge)
    mu, contact_px, steep = limits.mu, limits.contact_px, limits.steep
    own = (centroid[0], centroid[1])
    if rest_margin(wedge, own, around, width, mu, contact_px, steep=steep) < 0.0:
        return False
    on_it = around.added([wedge])
    return rest_margin(*stone, on_it, width, mu, contact_px, steep=steep) >= limits.rest


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
    """List where a wedge may be that holds a stone which falls to the right.

    The nearest come first; those that are higher than wide, which tip easily, after all others.
    """
    table = _Slabs(*slabs(space, *_extent(space.lid)))
    least = x_c + limits.margin * float(table.x[-1] - table.x[0])
    high = []
    for part in _parts(table, limits):
        last = part[1] - limits.smallest_px
        if part[1] < least or part[0] > last:
            continue
        first = min(max(part[0], least), last)
        for left in np.linspace(first, last, PLACES if first < last else 1).tolist():
            span = _fitted(table, (left, min(left + limits.smallest_px, part[1])), part, limits)
            if span is None:
                continue
            if _height_and_slope(table, span)[0] <= span[1] - span[0] + SAME:
                yield span
            else:
                high.append(span)
    yield from high


def _fitted(table: _Slabs, smallest: Span, part: Span, limits: WedgeLimits) -> Span | None:
    """Return the smallest span made wider, itself where that is too high or steep, or None."""
    for span in (_widened(table, smallest, part), smallest):
        height, slope = _height_and_slope(table, span)
        # Parts end where the limits are reached: rounding must not decide.
        if height <= limits.largest_px + SAME and slope <= limits.mu + SAME:
            return span
    return None


def _parts(table: _Slabs, limits: WedgeLimits) -> list[Span]:
    """List the parts of a crevice that are neither too thin nor too thick; steps end a part."""
    x, low, high = table
    thick = high - low
    fits = (thick.max(axis=1) >= limits.smallest_px) & (thick.min(axis=1) <= limits.largest_px)
    step = np.maximum(np.abs(low[1:, 0] - low[:-1, 1]), np.abs(high[1:, 0] - high[:-1, 1]))
    joined = np.append(False, step <= SAME)
    parts: list[Span] = []
    for i in np.flatnonzero(fits).tolist():
        start, stop = _fitting((float(x[i]), float(x[i + 1])), thick[i].tolist(), limits)
        if joined[i] and parts and parts[-1][1] == start:
            start = parts.pop()[0]
        parts.append((start, stop))
    return parts


def _fitting(slab: Span, thick: list[float], limits: WedgeLimits) -> Span:
    """Return the part of a slab where its thickness, which is linear, is that of a wedge."""
    if thick[0] == thick[1]:
        return slab
    ends = sorted(
        (limit - thick[0]) / (thick[1] - thick[0])
        for limit in (limits.smallest_px, limits.largest_px)
    )
    run = slab[1] - slab[0]
    return (
        slab[0] if ends[0] <= 0.0 else slab[0] + run * ends[0],
        slab[1] if ends[1] >= 1.0 else slab[0] + run * ends[1],
    )


def _widened(table: _Slabs, span: Span, part: Span) -> Span:
    """Make a span as wide as it is high where there is room: outwards, then inwards."""
    left, right = span
    for _ in range(WIDENINGS):
        height, _ = _height_and_slope(table, (left, right))
        if height <= right - left:
            break
        right = min(left + ASPECT * height, part[1])
        left = max(min(left, right - ASPECT * height), part[0])
    return left, right


def _height_and_slope(table: _Slabs, span: Span) -> tuple[float, float]:
    """Return the height of what fills a span, and the slope of its steeper face, end to end."""
    floor, lid = (_piece(table.x, line, span) for line in (table.low, table.high))
    rise = max(abs(float(line[-1, 1] - line[0, 0])) for line in (floor, lid))
    return float(lid.max() - floor.min()), rise / (span[1] - span[0])


def _piece(x: Points, line: Points, span: Span) -> Points:
    """Return y at both ends of the slabs of a line, cut off at the ends of a span."""
    first = int(np.searchsorted(x, span[0], side="right")) - 1
    last = int(np.searchsorted(x, span[1])) - 1
    piece = line[first : last + 1].copy()
    for at, slab, end in ((span[0], first, 0), (span[1], last, 1)):
        share = (at - x[slab]) / (x[slab + 1] - x[slab])
        piece[slab - first, end] = line[slab, 0] + (line[slab, 1] - line[slab, 0]) * share
    return piece


def _near(stone: Points, around: Polygons, limits: WedgeLimits) -> Polygons:
    """Return the polygons that a stone or a wedge under it could meet."""
    reach = limits.contact_px + 4.0 * limits.clearance_px
    left, low = stone.min(axis=0) - reach
    right, high = stone.max(axis=0) + reach
    boxes = around.boxes
    met = (boxes[:, 0] < right) & (boxes[:, 2] > left) & (boxes[:, 1] < high)
    met &= boxes[:, 3] > low - limits.largest_px
    return no_polygons().added(around.polygon(i) for i in np.flatnonzero(met).tolist())


def _extent(points: Points) -> Span:
    """Return the least and the largest x."""
    return float(points[:, 0].min()), float(points[:, 0].max())
