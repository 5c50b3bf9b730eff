"""Polygons along pixel edges, and back to pixels."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.boundary import boundary_of
from drystone.kernels.raster import Mask

Polygon = NDArray[np.float64]


def pixel_rings(mask: Mask) -> list[Polygon]:
    """Return the closed lines along the pixel edges of a mask (n, 2), one corner a pixel edge.

    They are counter-clockwise around pieces and clockwise around holes; x to the right and y up, px
    from the mask's bottom-left corner.  Where two pixels touch only at a corner, lines may pass it
    twice and do not cross.
    """
    boundary = boundary_of(np.pad(mask, 1).astype(np.int64))
    x, y = boundary.nodes[:, 1] - 1.0, mask.shape[0] + 1.0 - boundary.nodes[:, 0]
    return np.split(np.column_stack([x, y]), boundary.begins[1:-1])


def pixel_polygon(mask: Mask) -> Polygon:
    """Return the polygon along the pixel edges of a mask: one 4-connected piece without holes.

    Counter-clockwise from the leftmost corner of the lowest edge, no three corners in a row on one
    line, as :func:`pixel_rings` has them.
    """
    if not mask.any():
        raise ValueError("the mask has no pixel")
    ring, *others = pixel_rings(mask)
    if others:
        raise ValueError("the mask has several pieces or a hole")
    points = np.roll(ring[:-1], -np.lexsort(ring[:-1].T)[0], axis=0)
    ahead, behind = np.roll(points, -1, axis=0) - points, points - np.roll(points, 1, axis=0)
    return np.asarray(points[(ahead != behind).any(axis=1)])


def rasterise_polygon(polygon: Polygon) -> tuple[Mask, int, int]:
    """Return the pixels whose centres lie inside a polygon (n, 2), px, y up, by the even-odd rule.

    The mask is cropped, of shape (0, 0) when no centre is inside; then left and bottom: the pixel
    corner at which its bottom-left corner lies.
    """
    left, bottom = np.floor(polygon.min(axis=0)).astype(int).tolist()
    right, top = np.ceil(polygon.max(axis=0)).astype(int).tolist()
    row, crossing = _crossings(polygon)
    # A crossing turns over all centres from the first that is not left of it.
    first = np.searchsorted(np.arange(left, right) + 0.5, crossing)
    shape = (top - bottom, right - left + 1)
    flat = np.bincount((row - bottom) * shape[1] + first, minlength=shape[0] * shape[1])
    inside = (np.cumsum(flat.reshape(shape)[:, :-1], axis=1) & 1).astype(bool)
    rows, cols = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    if not rows.size:
        return np.zeros((0, 0), bool), left, bottom
    cropped = inside[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1][::-1]
    return np.ascontiguousarray(cropped), left + int(cols[0]), bottom + int(rows[0])


def _crossings(polygon: Polygon) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return the rows of pixel centres, y up, that cross edges, and the x of each crossing.

    The lower end of an edge counts to it, the upper one does not.
    """
    (x0, y0), (x1, y1) = polygon.T, np.roll(polygon, -1, axis=0).T
    first = np.ceil(np.minimum(y0, y1) - 0.5).astype(np.int64)
    counts = np.ceil(np.maximum(y0, y1) - 0.5).astype(np.int64) - first
    edge = np.repeat(np.arange(len(polygon)), counts)
    row = np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts - first, counts)
    x0, y0, x1, y1 = x0[edge], y0[edge], x1[edge], y1[edge]
    return row, x0 + (row + 0.5 - y0) * (x1 - x0) / (y1 - y0)
