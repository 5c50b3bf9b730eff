"""A stone as a simple polygon with the area and the centroid of its pixels (DESIGN 4.9)."""

import math

import numpy as np
import shapely
from scipy import ndimage
from skimage import measure

from drystone.kernels.polygons import Points, area_and_centroid, turn
from drystone.kernels.raster import Mask

HALVINGS = 6
"""How often the tolerance is halved before the contour is taken as it is."""

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
    Every point of the contour is within :func:`reach_px` of it.

    The contour at level 1/2 goes through the midpoints of pixel edges.  It cuts off every corner
    of a pixel, so a brick would get eight corners: where the cut is between two sides along pixel
    edges the corner (√2/4 px from the contour) is put back.  Steps of one pixel, of which slopes
    consist, have no such sides.  Then the contour is simplified after Douglas and Peucker.  Where
    that makes it cross or touch itself, or shift and factor then take it too far away, the
    tolerance is halved, and in the end the contour is taken as it is.

    Pixels that touch at a corner only are joined there by a neck of √2/2 px, as they are one
    stone when an image is read.

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
    about_centroid = contour - np.array(centroid_of(pixels))
    corners = _within(_mended(contour), about_centroid, area_px, tolerance_px)
    return turn(corners, -90.0 * quarter)


def drawn_outline(ring: Points, tolerance_px: float) -> Points:
    """Return a drawn outline, counter-clockwise, about its centroid, with no idle corners.

    Area and centroid are its own.  What the tolerance leaves of the corners is what it leaves of a
    contour of pixels (:func:`stone_outline`): those that a person drew all stay.
    """
    area, *centre = area_and_centroid(ring)
    about_centroid = ring - np.array(centre)
    return _within(about_centroid, about_centroid, area, tolerance_px)


def _within(ring: Points, contour: Points, area_px: float, tolerance_px: float) -> Points:
    """Simplify a ring as long as it stays near its contour, which is about the centroid."""
    for halving in range(HALVINGS):
        corners = _without_straight_ones(_simplified(ring, tolerance_px / 2.0**halving))
        if len(corners) > 2 and shapely.Polygon(corners).is_valid:
            fitted = _fitted(corners, area_px)
            if farthest_px(contour, fitted) <= reach_px(tolerance_px):
                return fitted
    return _fitted(_without_straight_ones(contour), area_px)


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


def _mended(contour: Points) -> Points:
    """Add the corners of pixels that a contour cuts off between two sides along pixel edges."""
    steps = np.roll(contour, -1, axis=0) - contour
    slant = (steps != 0.0).all(axis=1)
    before, after = np.roll(steps, 1, axis=0), np.roll(steps, -1, axis=0)
    alone = slant & ~np.roll(slant, 1) & ~np.roll(slant, -1)
    cut = np.flatnonzero(alone & (_cross(before, after) != 0.0))
    corners = contour[cut] + 0.5 * before[cut]
    # Both sides of a neck between pixels have the same corner: they stay apart.
    _, place, uses = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    once = uses[place.ravel()] == 1
    return np.insert(contour, cut[once] + 1, corners[once], axis=0)


def _simplified(ring: Points, tolerance_px: float) -> Points:
    """Leave out corners as long as the ring stays within the tolerance.

    It begins at the point that is furthest from the middle: that one stays in any case.
    """
    away = ring - ring.mean(axis=0)
    ring = np.roll(ring, -int(np.argmax((away * away).sum(axis=1))), axis=0)
    return np.asarray(measure.approximate_polygon(np.vstack([ring, ring[:1]]), tolerance_px)[:-1])


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
