"""A stone as a simple polygon with the area and the centroid of its pixels (DESIGN 4.9)."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree
from skimage import measure

from drystone.kernels.outline import pixel_rings
from drystone.kernels.polygons import Points, area_and_centroid, turn
from drystone.kernels.raster import Mask
from drystone.kernels.segments import Line, fitted_lines, meeting_point

FINER, ATTEMPTS = 0.8, 12
"""By which factor a tolerance is made finer; and how often for a drawn outline."""

ROUNDS, NEIGHBOURS = 16, 3
"""How often lines are fitted finer at most, and how far beside those that are straight already."""

SAME_PX = 1e-3
"""What is so near a line is on it."""

SIDE = 3
"""Sides so long, px, that meet at a right angle are no steps of a slope."""

SMALL = 0.05
"""Lines are no further from the pixels than this share of the root of the area: a stone of a few
pixels keeps its corners."""

FIT = 0.15
"""So much further than the tolerance a shift and a factor may take an outline from its contour,
over the tolerance or 1 px, whichever is larger.

The contour of any pixels, itself shifted and scaled, stays within it (tested: .146 px)."""

STRAIGHT = 1e-9
"""Sine of the turn below which a corner is none."""


def stone_outline(mask: Mask, tolerance_px: float) -> Points:
    """Return the outline of some pixels as a simple polygon about their centroid.

    The mask has row 0 at the top and is one 8-connected piece.  What counts is its :func:`solid`:
    what lies in a stone meets no other.  The tolerance says how far the polygon may stay away from
    the contour of the pixels before it is shifted and scaled.

    The corners have x to the right and y up, are counter-clockwise and not closed; the polygon
    neither crosses nor touches itself, and no corner is repeated or on a line with its neighbours.
    Every point of the contour is within :func:`reach_px` of it; its corners may be further out, up
    to a pixel from the corner of the grid that is near them.

    The contour at level 1/2 goes through the midpoints of pixel edges, which a straight side leaves
    by half a pixel and more.  So the outline does not follow them, which gave it a corner for every
    step of the grid: few lines are fitted (:mod:`drystone.kernels.segments`), and its corners are
    where they meet.  A side is then straight, and as long as it is, at any resolution.  Lines where
    the outline crosses or touches itself, or is too far from the contour, are fitted with a finer
    tolerance; where that does not do, the contour is taken as it is.

    Pixels that touch at a corner only are joined there by one more, as they are one stone when an
    image is read.

    At last the polygon is shifted and scaled about its centroid, by a factor of about 1 unless
    there are only a few pixels, so that its area and its centroid are those of the pixels.  A
    stone then has one weight and one centre of mass: images, outlines and statics agree on
    where it balances, and no pose has to carry two centroids.
    """
    # Traced in one of four positions: how a stone was turned in the photograph changes nothing.
    ways = [np.rot90(solid(mask), quarter) for quarter in range(4)]
    quarter = min(range(4), key=lambda way: (ways[way].shape, ways[way].tobytes()))
    pixels = ways[quarter]
    contour, area_px = _contour(pixels), float(np.count_nonzero(pixels))
    nearest = min(tolerance_px, SMALL * math.sqrt(area_px))
    corners = _lined(pixels, contour, area_px, nearest)
    if corners is None:
        corners = _fitted(_without_straight_ones(contour), area_px)
    return turn(corners, -90.0 * quarter)


def _lined(pixels: Mask, contour: Points, area_px: float, tolerance_px: float) -> Points | None:
    """Return the outline of lines that are fitted finer wherever they must; None if none will do.

    That is where the outline crosses itself, or it and the contour are too far apart: where lines
    meet, the outline of a round stone is further away than they are.
    """
    ring = _from_furthest(max(pixel_rings(_joined(pixels)), key=len)[:-1])
    nodes = np.vstack([ring, ring[:1]])
    edges = cKDTree((nodes[1:] + nodes[:-1]) / 2.0).query(contour)[1]
    points = shapely.points(contour - centroid_of(pixels))
    pieces = [
        piece
        for first, last in pairwise(sorted({0, *_corners(ring), len(ring)}))
        for piece in _cut(nodes, first, last, tolerance_px)
    ]
    for _ in range(ROUNDS):
        begins = np.array([piece.first for piece in pieces])
        corners = np.array([
            meeting_point((pieces[i - 1].line, piece.line), nodes[piece.first])
            for i, piece in enumerate(pieces)
        ])  # fmt: skip
        kept = _without_straight_ones(corners)
        amiss = np.ones(len(pieces), bool)
        area, *centre = area_and_centroid(corners)
        if len(kept) > 2 and area > 0.0:
            corners = (corners - centre) * math.sqrt(area_px / area)
            sides = shapely.linestrings(np.stack([corners, np.roll(corners, -1, axis=0)], axis=1))
            if not shapely.Polygon(kept).is_valid:
                amiss = _crossing(sides)
            else:
                side = np.searchsorted(begins, edges, "right") - 1
                beside = [sides[(side + i) % len(sides)] for i in (-1, 0, 1)]
                far = np.min(shapely.distance(points, beside), axis=0) > reach_px(tolerance_px)
                amiss = np.bincount(side[far], minlength=len(sides)) > 0
                if not amiss.any():
                    return _fitted(kept, area_px)
        finer = _finer(nodes, pieces, amiss)
        for _ in range(NEIGHBOURS):
            if len(finer) > len(pieces):
                break
            amiss |= np.roll(amiss, 1) | np.roll(amiss, -1)
            finer = _finer(nodes, pieces, amiss)
        if len(finer) == len(pieces):
            break
        pieces = finer
    return None


class _Piece(NamedTuple):
    """A piece of a ring of pixel edges, from one node to another, and its line."""

    first: int
    last: int
    line: Line


def _finer(nodes: Points, pieces: list[_Piece], amiss: NDArray[np.bool_]) -> list[_Piece]:
    """Cut pieces that are amiss where a finer tolerance asks for it first."""
    found = []
    for i, (first, last, (x, y, along_x, along_y)) in enumerate(pieces):
        worst = 0.0
        if amiss[i]:
            to = (nodes[first + 1 : last + 1] + nodes[first:last]) / 2.0 - (x, y)
            worst = FINER * float(np.abs(along_x * to[:, 1] - along_y * to[:, 0]).max())
        found += _cut(nodes, first, last, worst) if worst > SAME_PX else [pieces[i]]
    return found


def _cut(nodes: Points, first: int, last: int, tolerance_px: float) -> list[_Piece]:
    """Cut a part of a ring into pieces of few lines."""
    cuts, lines = fitted_lines(nodes[first : last + 1], tolerance_px)
    return [
        _Piece(first + a, first + b, line)
        for (a, b), line in zip(pairwise(cuts), lines, strict=True)
    ]


def _crossing(sides: NDArray[np.object_]) -> NDArray[np.bool_]:
    """Say which sides of a polygon meet others than the two beside them; all when none does."""
    one, other = shapely.STRtree(sides).query(sides, predicate="intersects")
    apart = (one - other) % len(sides)
    found = np.bincount(one[(apart > 1) & (apart < len(sides) - 1)], minlength=len(sides)) > 0
    return found if found.any() else ~found


def drawn_outline(ring: Points, tolerance_px: float) -> Points:
    """Return a drawn outline, counter-clockwise, about its centroid, with no idle corners.

    Area and centroid are its own.  Corners that half the tolerance needs all stay where a person
    drew them (Douglas and Peucker): no grid has moved them.
    """
    area, *centre = area_and_centroid(ring)
    drawn = _from_furthest(ring - np.array(centre))
    closed = np.vstack([drawn, drawn[:1]])
    for attempt in range(ATTEMPTS):
        simplified = measure.approximate_polygon(closed, 0.5 * tolerance_px * FINER**attempt)[:-1]
        corners = _without_straight_ones(simplified)
        if len(corners) > 2 and shapely.Polygon(corners).is_valid:
            fitted = _fitted(corners, area)
            if farthest_px(drawn, fitted) <= reach_px(tolerance_px):
                return fitted
    return _fitted(_without_straight_ones(drawn), area)


def is_outline_of(ring: Points, pixels: Mask) -> bool:
    """Say whether a ring, y up, is simple, counter-clockwise, and that of some solid pixels.

    Those have their centres in it: none is 1 px beyond it, and their area is its own but for 1 px
    all along it.
    """
    if ring.shape[1:] != (2,) or len(ring) < 3 or not np.isfinite(ring).all():
        return False
    polygon, (height, width) = shapely.Polygon(ring), pixels.shape
    left, bottom, right, top = polygon.bounds
    beyond_px = max(left, bottom, width - right, height - top)
    near = beyond_px <= 1.0 and abs(polygon.area - np.count_nonzero(pixels)) <= polygon.length
    return bool(near and polygon.is_valid and polygon.exterior.is_ccw)


def reach_px(tolerance_px: float) -> float:
    """Return how far an outline is from any point of its contour at most, for a tolerance."""
    return tolerance_px + FIT * max(1.0, tolerance_px)


def solid(mask: Mask) -> Mask:
    """Return the largest 8-connected piece of some pixels, its holes filled."""
    filled = ndimage.binary_fill_holes(mask)
    pieces, count = ndimage.label(filled, np.ones((3, 3)))
    if count > 1:
        filled = pieces == 1 + int(np.bincount(pieces.ravel())[1:].argmax())
    return np.asarray(filled)


def centroid_of(mask: Mask) -> tuple[float, float]:
    """Return the centroid (x, y) of pixel squares from the mask's bottom-left corner, y up."""
    height, width = mask.shape
    count = int(mask.sum())
    x = float(mask.sum(axis=0) @ (np.arange(width) + 0.5)) / count
    y = float(mask.sum(axis=1) @ (height - np.arange(height) - 0.5)) / count
    return x, y


def farthest_px(points: Points, outline: Points) -> float:
    """Return the largest distance of a point to an outline, whichever side it is on."""
    ring = shapely.LinearRing(outline)
    return float(shapely.distance(shapely.points(points), ring).max())


def second_moments(corners: Points) -> tuple[float, float, float]:
    """Return the second moments of area xx, yy and xy of a simple polygon about its centroid.

    The corners are counter-clockwise; xx + yy is the polar moment.
    """
    _, *centre = area_and_centroid(corners)
    x, y = (corners - np.array(centre)).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y1 - x1 * y
    xx = float(((x * x + x * x1 + x1 * x1) * cross).sum()) / 12.0
    yy = float(((y * y + y * y1 + y1 * y1) * cross).sum()) / 12.0
    xy = float(((x * y1 + 2.0 * (x * y + x1 * y1) + x1 * y) * cross).sum()) / 24.0
    return xx, yy, xy


def _contour(mask: Mask) -> Points:
    """Return the contour of a solid piece, counter-clockwise, not closed."""
    found = measure.find_contours(np.pad(mask, 1).astype(float), 0.5, fully_connected="high")
    # On pixel centres of the padded mask, row first; x, y from the mask's bottom-left corner.
    rings = [np.column_stack([c[:-1, 1] - 0.5, mask.shape[0] + 0.5 - c[:-1, 0]]) for c in found]
    areas = [area_and_centroid(ring)[0] for ring in rings]
    largest = max(range(len(rings)), key=lambda i: abs(areas[i]))
    return np.asarray(rings[largest] if areas[largest] > 0.0 else rings[largest][::-1])


def _joined(mask: Mask) -> Mask:
    """Return some pixels with one more wherever two touch at a corner only."""
    more = mask.copy()
    for left, right in ((slice(-1), slice(1, None)), (slice(1, None), slice(-1))):
        apart = ~more[:-1, right] & ~more[1:, left]
        more[:-1, right] |= apart & more[:-1, left] & more[1:, right]
    # One more may touch others.
    return more if (more == mask).all() else _joined(more)


def _corners(ring: Points) -> list[int]:
    """List where two sides along pixel edges meet, each of `SIDE` px or more: slopes have none.

    So do the ends of what is thinner, between two such sides: no slope turns back.
    """
    steps = np.roll(ring, -1, axis=0) - ring
    before = np.roll(steps, 1, axis=0)
    senses = _cross(before, steps)
    turns = np.flatnonzero(senses)
    long = np.diff([*turns, turns[0] + len(ring)]) >= SIDE
    back = np.roll(long, 1) & np.roll(long, -1) & (senses[turns] == np.roll(senses[turns], -1))
    return [int(at) for at in turns[(long & np.roll(long, 1)) | back | np.roll(back, 1)]]


def _from_furthest(ring: Points) -> Points:
    """Let a ring begin at a point that is furthest from the middle, where there is a corner."""
    away = ring - ring.mean(axis=0)
    # Of points as far the highest: rounding does not decide.
    far = np.lexsort((*ring.T, (away * away).sum(axis=1).round(6)))[-1]
    return np.roll(ring, -int(far), axis=0)


def _without_straight_ones(corners: Points) -> Points:
    """Leave out corners that are repeated or on a line with their neighbours."""
    while len(corners) > 2:
        before, after = (
            corners - np.roll(corners, 1, axis=0),
            np.roll(corners, -1, axis=0) - corners,
        )
        bent = np.abs(_cross(before, after)) > STRAIGHT * np.hypot(*before.T) * np.hypot(*after.T)
        if bent.all():
            break
        corners = corners[bent]
    return corners


def _cross(first: Points, second: Points) -> Points:
    return np.asarray(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])


def _fitted(corners: Points, area_px: float) -> Points:
    """Shift and scale a polygon: the centroid at the origin, and the area that it must have."""
    area, *centre = area_and_centroid(corners)
    return np.asarray((corners - np.array(centre)) * math.sqrt(area_px / area))
