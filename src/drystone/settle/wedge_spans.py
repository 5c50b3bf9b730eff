"""Where in the free space under a stone a wedge may be: how thick, how wide, how steep (§3.7)."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from drystone.kernels.crevice import SAME, Crevice, slabs
from drystone.kernels.polygons import Points
from drystone.model.wedge_shape import WedgeRule, WedgeShape

Span = tuple[float, float]
"""A wedge or a part of a crevice from one x to another."""

ASPECT = 1.25
"""Width of a wedge over its height, where there is room and the least width is less."""
WIDENINGS = 8
"""How often a wedge is made wider whose height grows with its width."""


@dataclass(frozen=True, kw_only=True)
class WedgeLimits(WedgeRule):
    """What a wedge may be, and how it must hold a stone; source px."""

    # distance of the centre of mass from the end of the support, as a share of the stone's
    # width
    margin: float = 0.0
    clearance_px: float = 0.01  # gap that is left above and below
    contact_px: float = 0.1  # gaps up to this one touch
    setback: float = 0.01  # see `SettleSettings`
    # between a stone and the end of the wall, in which another one may come to stand beside
    # its wedge
    room_px: float = 0.0
    rest: float = 0.0  # how far gravity may lean until the wedged stone moves, over mu, at least
    steep: float = -1.0  # see `SettleSettings`

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.margin < 0.5:
            raise ValueError("margin must be in [0, 0.5)")
        if not 0 < 2 * self.clearance_px <= self.contact_px:
            raise ValueError("clearance must be above 0, contact_px at least twice as much")


class Slabs(NamedTuple):
    """A crevice cut into slabs with straight floors and lids (:func:`slabs`)."""

    x: Points  # (n + 1,): where the slabs begin, and the end of the last
    # (n, 2): y of floor and lid at the left and at the right of each slab
    low: Points
    high: Points

    @classmethod
    def of(cls, space: Crevice) -> "Slabs":
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


def all_spans(table: Slabs, places: int, limits: WedgeLimits) -> list[Span]:
    """List where wedges may be anywhere in a crevice, from left to right.

    At so many places, from one end to the other of each part of it: as wide as high there; and
    over the whole part.
    """
    found: list[Span] = []
    for part in parts(table, limits):
        last = part[1] - limits.least_width
        if last < part[0]:
            continue
        spans = [
            fitted(table, (left, min(left + limits.least_width, part[1])), part, limits)
            for left in np.linspace(part[0], last, places).tolist()
        ]
        spans.append(part if limits.allows(table.shape(part), SAME) else None)
        found += [span for span in dict.fromkeys(spans) if span is not None]
    return found


def fitted(table: Slabs, narrowest: Span, part: Span, limits: WedgeLimits) -> Span | None:
    """Make a span as wide as it is high: outwards, then inwards; None when that is no wedge."""
    left, right = narrowest
    for _ in range(WIDENINGS):
        height = table.shape((left, right)).height
        if height <= right - left:
            break
        right = min(left + ASPECT * height, part[1])
        left = max(min(left, right - ASPECT * height), part[0])
    return (left, right) if limits.allows(table.shape((left, right)), SAME) else None


def parts(table: Slabs, limits: WedgeLimits) -> list[Span]:
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
