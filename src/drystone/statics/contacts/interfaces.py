"""Pic-to-Ri: straight interfaces between the stones of a label image (§4.2; DESIGN 4.8)."""

import math
from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.boundary import (
    EMPTY,
    Cells,
    Chain,
    crossing_corners,
    split_at_corners,
    touching_edges,
    trace_chains,
)
from drystone.kernels.raster import Mask
from drystone.model.wall import Labels
from drystone.statics.model import GROUND, Interface

Window = tuple[slice, slice]
Points = NDArray[np.float64]

CORNER_TOLERANCE_PX = math.sqrt(2.0)
"""A run may leave its chord by this much before it is split.

The pixel corners of a straight joint lie in a strip narrower than |cos| + |sin| <= sqrt 2, so a
straight joint is never split, and a leg of two pixels at the end of a long run is.
"""

HOOK_NEEDS_PX = 3
"""An end edge square to a straight piece of at least this length is a hook of the grid."""

POINT_REACH_PX = 3
"""How far around a contact at a point the two stones are looked at for its normal."""


def find_interfaces(labels: Labels) -> tuple[Interface, ...]:
    """Find all interfaces of a label image that stands on its lowest row (Pic-to-Ri, §4.2).

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is, otherwise the id of a stone; row 0 at the top; the ground is below
        the last row.

    Returns
    -------
    tuple of Interface
        One for each straight run of boundary between two stones, or a stone and the ground; then
        one for each contact at a point.  Points are pixel corners, in px, in the wall frame.  Of
        two stones the larger id is `block`.  Sorted by ids and place.

    Notes
    -----
    A run is a connected chain of pixel edges, split where it bends by more than
    `CORNER_TOLERANCE_PX`.  Its contact points are its two ends; its normal is that of the line
    fitted to the midpoints of its edges.  A single edge that turns off at the end of a straight
    piece is a step of the grid and is left out.  Stones that touch only at a pixel corner, across
    two empty pixels, have an interface of one point.

    Examples
    --------
    >>> wall = np.ones((40, 20), np.uint32)
    >>> find_interfaces(wall)[0].points.tolist()
    [[0.0, 0.0], [20.0, 0.0]]
    """
    height, width = labels.shape
    return _interfaces_in(labels, (slice(0, height), slice(0, width)), None)


def find_interfaces_of(labels: Labels, ids: Iterable[int], window: Window) -> tuple[Interface, ...]:
    """Find the interfaces of new blocks with all others and the ground.

    Parameters
    ----------
    labels : (h, w) integer array
        As for :func:`find_interfaces`, new blocks included.
    ids : iterable of int
        The new blocks: a stone and its wedges.
    window : (slice, slice)
        Rows and columns that contain them.

    Returns
    -------
    tuple of Interface
        Equal to the interfaces of :func:`find_interfaces` that one of `ids` takes part in.

    Notes
    -----
    Adding block after block this way gives the interfaces of the whole image, except that a
    contact at a point disappears when a later block fills a pixel beside it: see
    :func:`closed_in`.
    """
    return _interfaces_in(labels, window, tuple(ids))


def closed_in(interfaces: tuple[Interface, ...], labels: Labels, window: Window) -> tuple[int, ...]:
    """Return the positions of the contacts at a point that blocks in a window have closed in.

    Where stones fill the pixels beside a contact at a point the joints with them carry the load;
    a corner exactly above a corner, as at the crossing of two joints, carries nothing.
    """
    height = labels.shape[0]
    rows, cols = window

    def is_closed(interface: Interface) -> bool:
        col, row = int(interface.points[0, 0]), height - int(interface.points[0, 1])
        if not (rows.start <= row <= rows.stop and cols.start <= col <= cols.stop):
            return False
        return int(np.count_nonzero(labels[row - 1 : row + 1, col - 1 : col + 1])) != 2

    return tuple(
        position
        for position, interface in enumerate(interfaces)
        if len(interface.points) == 1 and is_closed(interface)
    )


def _interfaces_in(
    labels: Labels, window: Window, ids: tuple[int, ...] | None
) -> tuple[Interface, ...]:
    cells, origin = _padded(labels, window)
    fresh = cells > GROUND
    if ids is not None:
        fresh = cells == ids[0]
        for other in ids[1:]:
            fresh |= cells == other
    found = []
    for chain in trace_chains(touching_edges(cells, fresh)):
        found += _runs(chain, origin)
    corners = crossing_corners(cells, fresh)
    found += [_contact_at_point(labels, corner, origin) for corner in corners.tolist()]
    return tuple(found)


def _padded(labels: Labels, window: Window) -> tuple[Cells, tuple[int, int]]:
    """Cut a window out with one pixel around it; below the last row is the ground.

    The origin is the wall-frame (x, y) of its top-left node.
    """
    height, width = labels.shape
    top, bottom = window[0].start, window[0].stop
    left, right = window[1].start, window[1].stop
    cells = np.full((bottom - top + 2, right - left + 2), EMPTY, np.int64)
    row0, row1, col0, col1 = (
        max(top - 1, 0),
        min(bottom + 1, height),
        max(left - 1, 0),
        min(right + 1, width),
    )
    seen = labels[row0:row1, col0:col1].astype(np.int64)
    seen[seen == 0] = EMPTY
    cells[row0 - top + 1 : row1 - top + 1, col0 - left + 1 : col1 - left + 1] = seen
    if bottom == height:
        cells[-1] = GROUND
    return cells, (left - 1, height - top + 1)


def _runs(chain: Chain, origin: tuple[int, int]) -> list[Interface]:
    """Split a chain into straight runs."""
    points = np.empty(chain.nodes.shape)
    points[:, 0] = chain.nodes[:, 1] + origin[0]
    points[:, 1] = origin[1] - chain.nodes[:, 0]
    cuts = split_at_corners(points, CORNER_TOLERANCE_PX)
    runs = []
    for first, last in pairwise(cuts):
        run = _without_hooks(points[first : last + 1])
        ends = run[[0, -1]]
        runs.append(Interface(chain.high, chain.low, ends, _fitted_normal(run)))
    return runs


def _without_hooks(run: Points) -> Points:
    """Leave out a single edge that turns off at either end of a straight piece.

    The ledge of one pixel is the grid's, not the stone's; it must not tilt the normal.
    """
    if _ends_in_hook(run):
        run = run[:-1]
    if _ends_in_hook(run[::-1]):
        run = run[1:]
    return run


def _ends_in_hook(run: Points) -> bool:
    if len(run) < HOOK_NEEDS_PX + 2:
        return False
    (x0, y0), (x1, y1), (x2, y2) = run[-2 - HOOK_NEEDS_PX], run[-2], run[-1]
    straight = max(abs(x1 - x0), abs(y1 - y0)) == HOOK_NEEDS_PX
    return bool(straight and (x1 - x0) * (x2 - x1) + (y1 - y0) * (y2 - y1) == 0)


def _fitted_normal(run: Points) -> tuple[float, float]:
    """Return the unit normal to the left of a run.

    The line is fitted to the midpoints of the edges by total least squares: on a regular
    staircase they lie along its slope, and one odd edge hardly turns it.
    """
    chord_x, chord_y = run[-1] - run[0]
    x, y = (run[1:] + run[:-1]).T
    x, y = x - x.mean(), y - y.mean()
    xx, yy, xy = float(x @ x), float(y @ y), float(x @ y)
    if xy == 0.0 and xx == yy:  # one edge, or no direction better than another
        tangent_x, tangent_y = chord_x, chord_y
    elif xy == 0.0:
        tangent_x, tangent_y = (1.0, 0.0) if xx > yy else (0.0, 1.0)
    else:
        angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
        tangent_x, tangent_y = math.cos(angle), math.sin(angle)
    length = math.hypot(tangent_x, tangent_y)
    if tangent_x * chord_x + tangent_y * chord_y < 0.0:
        length = -length
    return float(-tangent_y / length) + 0.0, float(tangent_x / length) + 0.0


def _contact_at_point(
    labels: Labels, corner: tuple[int, int, int, int], origin: tuple[int, int]
) -> Interface:
    """Make the interface of two stones that touch at a pixel corner across two empty pixels.

    The normal is that of the stone whose boundary passes the corner rather than ends in it: the
    first moment of its pixels around the corner points away from its boundary.  Each stone counts
    by how many of its pixels lie outside the quadrant of its corner pixel.  A square corner on a
    square corner has no tangent: there the upper stone stands on the lower one, so that it slides
    off freely as it would on a flat bed.
    """
    above, below, node_row, node_col = corner
    x, y = node_col + origin[0], origin[1] - node_row
    row = labels.shape[0] - y
    top, left = max(row - POINT_REACH_PX, 0), max(x - POINT_REACH_PX, 0)
    seen = labels[top : row + POINT_REACH_PX, left : x + POINT_REACH_PX]
    up = row - top - np.arange(seen.shape[0])[:, None] - 0.5
    right = np.arange(seen.shape[1])[None, :] + left + 0.5 - x
    toward_right = 1 if labels[row - 1, x] == above else -1
    normal = np.zeros(2)  # into the upper stone
    for stone, sign in ((above, 1), (below, -1)):
        pixels: Mask = seen == stone
        outside = pixels & ~((sign * up > 0) & (sign * toward_right * right > 0))
        weight = sign * int(np.count_nonzero(outside))
        normal += weight * np.array([(pixels * right).sum(), (pixels * up).sum()])
    length = float(np.hypot(normal[0], normal[1]))
    normal = normal / length if length > 0 else np.array([0.0, 1.0])
    if above < below:
        normal = -normal
    return Interface(
        max(above, below),
        min(above, below),
        np.array([[x, y]], float),
        (float(normal[0]), float(normal[1])),
    )
