"""What a wedge must be that a mason would cut, and that stays where it was driven in."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from drystone.kernels.polygons import Points, Polygons
from drystone.model.settings import Ranged, ranged

SLENDER = 1.0
"""Greatest height of a wedge over its width: it lies.

Pushed aside a block slides before it tips while its height is below width / mu, 1.7 widths; a
wedge that rocks in its place has less, and masons lay the long side of a stone, pins too, flat."""

SLIVER = 5.0
"""Greatest width over mean thickness; what is longer breaks when it is driven in."""

HELD = 3.0
"""Least width over least thickness: what fingers hold while it is driven in."""

BENT = 0.1
"""How far a face may be from the line between its ends, over the width.

A hammer cuts faces that are about straight; one that follows every corner of two stones would lock
them together."""

COVERED = 0.5
"""Share of its height in which something must be beside a wedge."""

ROUNDING = 1e-5
"""Lengths, slopes and shares this near to a limit are at it: outlines are put on a grid."""


@dataclass(frozen=True, kw_only=True)
class WedgeSettings(Ranged):
    """Sizes of wedges that are outlines; `size` is the root of the median stone's area.

    Parameters
    ----------
    thickness : float
        Least thickness, at any place, over the size; where no scale is known.
    thickness_mm : float
        Least thickness where a scale is known: thinner flakes break under the hammer.
    height : float
        Greatest height over the size.
    area : float
        Greatest area over that of the median stone.
    """

    thickness: float = ranged(0.04, above=0)
    thickness_mm: float = ranged(5.0, above=0)
    height: float = ranged(0.25, above=0)
    area: float = ranged(0.1, above=0)


class WedgeShape(NamedTuple):
    """Measures of a wedge, in the unit of its corners."""

    # of its upright box
    width: float
    height: float
    thickness: float  # of the thinnest place: length of an upright line inside
    area: float
    # slopes (rise over run) of the lower and of the upper face, from end to end
    bed: float
    top: float
    # largest distance of a face from the line between its ends, upright, over the width
    bend: float

    @classmethod
    def of_slabs(cls, x: Points, low: Points, high: Points) -> "WedgeShape":
        """Measure what lies between a floor and a lid.

        `x`, (n + 1,), is where the slabs begin, from left to right, and the end of the last; `low`
        and `high`, (n, 2), are y of floor and lid at the left and at the right of each slab.
        """
        width, thick = float(x[-1] - x[0]), high - low
        # Straight lines between the ends, at both ends of each slab.
        along = ((np.column_stack([x[:-1], x[1:]]) - x[0]) / width)[:, :, None]
        faces = np.stack([low, high], axis=-1)
        ends = faces[0, 0], faces[-1, 1]
        bed, top = ((ends[1] - ends[0]) / width).tolist()
        bent = np.abs(faces - (ends[0] + along * (ends[1] - ends[0]))).max()
        height, area = high.max() - low.min(), 0.5 * thick.sum(axis=1) @ (x[1:] - x[:-1])
        thinnest, bend = float(thick.min()), float(bent) / width
        return cls(width, float(height), thinnest, float(area), bed, top, bend)

    @classmethod
    def of(cls, corners: Points) -> "WedgeShape":
        """Measure a polygon, counter-clockwise."""
        starts, ends = corners, np.roll(corners, -1, axis=0)
        x = np.unique(corners[:, 0])
        low, high, thin, area = [], [], [], 0.0
        for left, right in pairwise(x.tolist()):
            # Edges from end to end of the slab, from the lowest to the highest, in pairs.
            spans = np.minimum(starts[:, 0], ends[:, 0]) <= left
            spans &= np.maximum(starts[:, 0], ends[:, 0]) >= right
            run = ends[spans] - starts[spans]
            slope = run[:, 1] / run[:, 0]
            at = [starts[spans, 1] + slope * (end - starts[spans, 0]) for end in (left, right)]
            y = np.column_stack(at)[np.argsort(at[0] + at[1])]
            thick = y[1::2] - y[::2]
            low.append(y[0])
            high.append(y[-1])
            thin.append(float(thick.min()))
            area += 0.5 * float(thick.sum()) * (right - left)
        whole = cls.of_slabs(x, np.array(low), np.array(high))
        # A fork is as thick as its thinner prong.
        return whole._replace(thickness=min(thin), area=area)


@dataclass(frozen=True, kw_only=True)
class WedgeRule:
    """What a wedge may be, in the unit of its corners."""

    least_thickness: float  # at any place; a wedge does not end in an edge
    greatest_height: float  # of its upright box
    greatest_area: float = math.inf
    # coefficient of friction: no face is steeper, nor do the two open wider, or the load would
    # push the wedge out
    mu: float = 0.58

    @classmethod
    def of(
        cls, sizes: WedgeSettings, mu: float, size: float, per_m: float | None = None
    ) -> "WedgeRule":
        """Return the rule for stones of which `size` is the root of the median area.

        `per_m` is units of length in a metre, when that is known.
        """
        least = sizes.thickness * size if per_m is None else sizes.thickness_mm * per_m / 1000.0
        return cls(
            least_thickness=least,
            greatest_height=max(least, sizes.height * size),
            greatest_area=sizes.area * size * size,
            mu=mu,
        )

    @property
    def least_width(self) -> float:
        """Least width of a wedge."""
        return HELD * self.least_thickness

    def faults(self, shape: WedgeShape, rounding: float = ROUNDING) -> Iterator[str]:
        """Name what is wrong with a wedge; nothing when a mason would cut it."""
        friction = math.atan(self.mu)
        bed, top = math.atan(shape.bed), math.atan(shape.top)
        least = (
            ("thick", shape.thickness, self.least_thickness),
            ("wide", shape.width, self.least_width),
        )
        most = (
            ("high", shape.height, self.greatest_height),
            ("in area", shape.area, self.greatest_area),
            ("times as high as wide", shape.height / shape.width, SLENDER),
            ("times as wide as thick", shape.width**2 / shape.area, SLIVER),
            ("of its width bent", shape.bend, BENT),
        )
        angles = (
            ("steep below", abs(bed)),
            ("steep above", abs(top)),
            ("between its faces", abs(top - bed)),
        )
        for words, value, limit in least:
            if value < limit - rounding:
                yield f"{value:.4g} {words}, at least {limit:.4g}"
        for words, value, limit in most:
            if value > limit + rounding:
                yield f"{value:.4g} {words}, at most {limit:.4g}"
        for words, angle in angles:
            if angle > friction + rounding:
                yield (f"{math.degrees(angle):.1f}° {words}, at most {math.degrees(friction):.1f}°")

    def allows(self, shape: WedgeShape, rounding: float = ROUNDING) -> bool:
        """Say whether a mason would cut a wedge."""
        return next(self.faults(shape, rounding), None) is None


def open_sides(wedge: Points, others: Polygons) -> tuple[bool, bool]:
    """Say whether nothing is beside a wedge at its left, and at its right, up to the wall's end.

    Beside it is what lies further out in the same rows, in half of its height or more: then the
    wedge cannot be squeezed out of its place.  The wedge itself may be among the others.
    """
    (left, low), (right, high) = wedge.min(axis=0).tolist(), wedge.max(axis=0).tolist()
    after = np.arange(1, len(others.corners) + 1)
    after[others.first[1:] - 1] = others.first[:-1]
    edges = np.column_stack([others.corners, others.corners[after]])
    edges = edges[(edges[:, 1::2].min(axis=1) < high) & (edges[:, 1::2].max(axis=1) > low)]
    least = (COVERED - ROUNDING) * (high - low)
    return (
        _covered(edges * [-1.0, 1.0, -1.0, 1.0], -left, (low, high)) < least,
        _covered(edges, right, (low, high)) < least,
    )


def _covered(edges: Points, x: float, rows: tuple[float, float]) -> float:
    """Return in how much of some rows there are edges further to the right than an x."""
    y: list[tuple[float, float]] = []
    for x0, y0, x1, y1 in edges[edges[:, ::2].max(axis=1) > x].tolist():
        near, far = ((x0, y0), (x1, y1)) if x0 <= x1 else ((x1, y1), (x0, y0))
        if near[0] < x:
            share = (x - near[0]) / (far[0] - near[0])
            near = x, near[1] + share * (far[1] - near[1])
        y.append((max(min(near[1], far[1]), rows[0]), min(max(near[1], far[1]), rows[1])))
    covered, reached = 0.0, rows[0]
    for low, high in sorted(y):
        covered += max(0.0, high - max(low, reached))
        reached = max(reached, high)
    return covered
