"""Polygons along pixel edges, and back to pixels."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

Polygon = NDArray[np.float64]

_Corner = tuple[int, int]


def pixel_polygon(mask: Mask) -> Polygon:
    """Return the polygon along the pixel edges of a mask: one 4-connected piece without holes.

    Counter-clockwise from the leftmost corner of the lowest edge, no three corners in a row on one
    line; x to the right and y up, px from the mask's bottom-left corner.  Where two pixels touch
    only at a corner the polygon passes that corner twice and does not cross itself.
    """
    outgoing = _boundary(mask)
    if not outgoing:
        raise ValueError("the mask has no pixel")
    start = min(outgoing, key=lambda corner: (corner[1], corner[0]))
    corners = [start]
    here, heading = start, (1, 0)
    while here != start or len(corners) == 1:
        # At a corner where two pixels touch, turning left stays with the pixel on the left.
        ends = outgoing.pop(here)
        end = max(ends, key=lambda e: heading[0] * (e[1] - here[1]) - heading[1] * (e[0] - here[0]))
        if len(ends) > 1:
            outgoing[here] = [e for e in ends if e != end]
        heading, here = (end[0] - here[0], end[1] - here[1]), end
        corners.append(here)
    if outgoing:
        raise ValueError("the mask has several pieces or a hole")
    points = np.array(corners[:-1], float)
    ahead, behind = np.roll(points, -1, axis=0) - points, points - np.roll(points, 1, axis=0)
    return np.asarray(points[(ahead != behind).any(axis=1)])


def _boundary(mask: Mask) -> dict[_Corner, list[_Corner]]:
    """Return the ends of the unit edges that start at each corner, the mask on their left."""
    inside = np.pad(mask[::-1], 1)
    core = inside[1:-1, 1:-1]
    outgoing: dict[_Corner, list[_Corner]] = {}
    for beyond, (x0, y0), (x1, y1) in (
        (inside[:-2, 1:-1], (0, 0), (1, 0)),
        (inside[1:-1, 2:], (1, 0), (1, 1)),
        (inside[2:, 1:-1], (1, 1), (0, 1)),
        (inside[1:-1, :-2], (0, 1), (0, 0)),
    ):
        for y, x in np.argwhere(core & ~beyond).tolist():
            outgoing.setdefault((x + x0, y + y0), []).append((x + x1, y + y1))
    return outgoing


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
