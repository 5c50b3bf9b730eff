"""Where in the free space under a stone a wedge may be: how thick, how wide, how steep (§3.7)."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from drystone.kernels.crevice import SAME, Crevice, slabs
from drystone.kernels.polygons import Points

Span = tuple[float, float]
"""A wedge or a part of a crevice from one x to another."""

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
    setback : float
        See :class:`drystone.settle.settings.SettleSettings`.
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
    setback: float = 0.01
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


class Slabs(NamedTuple):
    """A crevice cut into slabs with straight floors and lids (:func:`slabs`).

    Parameters
    ----------
    x : (n + 1,) float array
        Where the slabs begin, and the end of the last.
    low, high : (n, 2) float arrays
        y of floor and lid at the left and at the right of each slab.
    """

    x: Points
    low: Points
    high: Points

    @classmethod
    def of(cls, space: Crevice) -> "Slabs":
        """Cut a crevice at all its corners, from its left end to its right end."""
        return cls(*slabs(space, *extent(space.lid)))


def all_spans(table: Slabs, places: int, limits: WedgeLimits) -> list[Span]:
    """List where wedges may be anywhere in a crevice, from left to right.

    Parameters
    ----------
    table : Slabs
        The crevice.
    places : int
        At so many places, from one end to the other of each part of it: as wide as high there;
        and over the whole part.
    limits : WedgeLimits
        What a wedge may be.
    """
    found: list[Span] = []
    for part in parts(table, limits):
        last = part[1] - limits.smallest_px
        if last < part[0]:
            continue
        spans = [
            fitted(table, (left, min(left + limits.smallest_px, part[1])), part, limits)
            for left in np.linspace(part[0], last, places).tolist()
        ]
        spans.append(part if _within_limits(table, part, limits) else None)
        found += [span for span in dict.fromkeys(spans) if span is not None]
    return found


def fitted(table: Slabs, smallest: Span, part: Span, limits: WedgeLimits) -> Span | None:
    """Return the smallest span made wider, itself where that is too high or steep, or None."""
    for span in (_widened(table, smallest, part), smallest):
        if _within_limits(table, span, limits):
            return span
    return None


def _within_limits(table: Slabs, span: Span, limits: WedgeLimits) -> bool:
    """Say whether what fills a span is neither too high nor too steep."""
    height, slope = height_and_slope(table, span)
    # Parts end where the limits are reached: rounding must not decide.
    return height <= limits.largest_px + SAME and slope <= limits.mu + SAME


def parts(table: Slabs, limits: WedgeLimits) -> list[Span]:
    """List the parts of a crevice that are neither too thin nor too thick; steps end a part."""
    x, low, high = table
    thick = high - low
    fits = (thick.max(axis=1) >= limits.smallest_px) & (thick.min(axis=1) <= limits.largest_px)
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
        for limit in (limits.smallest_px, limits.largest_px)
    )
    run = slab[1] - slab[0]
    return (
        slab[0] if ends[0] <= 0.0 else slab[0] + run * ends[0],
        slab[1] if ends[1] >= 1.0 else slab[0] + run * ends[1],
    )


def _widened(table: Slabs, span: Span, part: Span) -> Span:
    """Make a span as wide as it is high where there is room: outwards, then inwards."""
    left, right = span
    for _ in range(WIDENINGS):
        height, _ = height_and_slope(table, (left, right))
        if height <= right - left:
            break
        right = min(left + ASPECT * height, part[1])
        left = max(min(left, right - ASPECT * height), part[0])
    return left, right


def height_and_slope(table: Slabs, span: Span) -> tuple[float, float]:
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


def extent(points: Points) -> Span:
    """Return the least and the largest x."""
    return float(points[:, 0].min()), float(points[:, 0].max())
