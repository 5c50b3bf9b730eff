"""Whether a polygon lies over others: quick, for outlines that keep a clearance.

No overlap is missed.  Outlines that only touch may count as crossing; where they may touch, ask
:mod:`drystone.model.overlap`.
"""

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.polygons import Points, Polygons

_fast = compiled("gaps")


def crosses_any(corners: Points, around: Polygons) -> bool:
    """Say whether edges of a polygon cross those of others, or one lies in another.

    Parameters
    ----------
    corners : (n, 2) float array
        Of the polygon.
    around : Polygons
        The others.

    Examples
    --------
    >>> from drystone.kernels.polygons import no_polygons
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> crosses_any(square + 1.0, no_polygons().added([square]))
    True
    """
    if _fast is None:
        return crosses_any_python(corners, around)
    return bool(_fast.crosses_any(corners, around.corners, around.first, around.boxes))


def crosses_any_python(corners: Points, around: Polygons) -> bool:
    """Twin of :func:`crosses_any`."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    box = around.boxes
    apart = (low[0] > box[:, 2]) | (high[0] < box[:, 0])
    apart |= (low[1] > box[:, 3]) | (high[1] < box[:, 1])
    return any(_over(corners, around.polygon(i)) for i in np.flatnonzero(~apart).tolist())


def contains(polygon: Points, x: float, y: float) -> bool:
    """Say whether a point lies in a polygon (even-odd rule)."""
    ends = np.roll(polygon, 1, axis=0)
    hit = (polygon[:, 1] > y) != (ends[:, 1] > y)
    ax, ay = polygon[hit].T
    bx, by = ends[hit].T
    return bool(np.count_nonzero(x < (bx - ax) * (y - ay) / (by - ay) + ax) % 2)


def _over(a: Points, b: Points) -> bool:
    """Say whether edges of two polygons cross, or one lies in the other."""
    low = np.maximum(a.min(axis=0), b.min(axis=0))
    high = np.minimum(a.max(axis=0), b.max(axis=0))
    (a0, c), (b0, d) = _edges_in(a, low, high), _edges_in(b, low, high)
    cut = _parted(a0[:, None], c[:, None], b0, d) & _parted(b0, d, a0[:, None], c[:, None])
    if cut.any():
        return True
    return contains(b, *a[0].tolist()) or contains(a, *b[0].tolist())


def _edges_in(polygon: Points, low: Points, high: Points) -> tuple[Points, Points]:
    """Return both ends of the edges whose boxes meet a box."""
    ends = np.roll(polygon, -1, axis=0)
    clear = (np.maximum(polygon, ends) < low) | (np.minimum(polygon, ends) > high)
    meets = ~clear.any(axis=1)
    return polygon[meets], ends[meets]


def _parted(a: Points, b: Points, c: Points, d: Points) -> NDArray[np.bool_]:
    """Say whether two points lie on different sides of a line through two others."""
    return np.asarray((_side(a, b, c) > 0.0) != (_side(a, b, d) > 0.0))


def _side(a: Points, b: Points, c: Points) -> Points:
    """Return twice the area of a triangle, positive when it is counter-clockwise."""
    first = (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1])
    second = (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])
    return np.asarray(first - second)
