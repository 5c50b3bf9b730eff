"""Polygons along pixel edges, and back to pixels."""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

Polygon = NDArray[np.float64]

_Corner = tuple[int, int]


def pixel_polygon(mask: Mask) -> Polygon:
    """Return the polygon along the pixel edges of a mask.

    Parameters
    ----------
    mask : (h, w) bool array
        One 4-connected piece without holes, row 0 at the top.

    Returns
    -------
    corners : (n, 2) float array
        Counter-clockwise from the leftmost corner of the lowest edge, no three in a row on one
        line; x to the right and y up, px from the mask's bottom-left corner.  Where two pixels
        touch only at a corner the polygon passes that corner twice and does not cross itself.

    Raises
    ------
    ValueError
        When there is no pixel, more than one piece, or a hole.

    Examples
    --------
    >>> pixel_polygon(np.array([[1, 0], [1, 1]], bool)).tolist()
    [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]
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
    """Return the pixels whose centres lie inside a polygon.

    Parameters
    ----------
    polygon : (n, 2) float array
        Corners in either sense, px, x to the right and y up; the even-odd rule says what is
        inside.

    Returns
    -------
    mask : (h, w) bool array
        Cropped to its pixels, row 0 at the top; of shape (0, 0) when no centre is inside.
    left, bottom : int
        Pixel corner at which its bottom-left corner lies.

    Examples
    --------
    >>> square = np.array([[3.0, 1.0], [5.0, 1.0], [5.0, 2.0], [3.0, 2.0]])
    >>> rasterise_polygon(square)
    (array([[ True,  True]]), 3, 1)
    """
    left, bottom = np.floor(polygon.min(axis=0)).astype(int).tolist()
    right, top = np.ceil(polygon.max(axis=0)).astype(int).tolist()
    x = np.arange(left, right) + 0.5
    inside = np.zeros((top - bottom, right - left), bool)
    for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        # Rows of centres that the edge crosses, its lower end counted and its upper one not.
        first, last = (np.ceil(np.sort([y0, y1]) - 0.5).astype(int) - bottom).tolist()
        for row in range(first, last):
            crossing = x0 + (bottom + row + 0.5 - y0) * (x1 - x0) / (y1 - y0)
            inside[row] ^= x >= crossing
    rows, cols = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    if not rows.size:
        return np.zeros((0, 0), bool), left, bottom
    cropped = inside[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1][::-1]
    return np.ascontiguousarray(cropped), left + int(cols[0]), bottom + int(rows[0])
