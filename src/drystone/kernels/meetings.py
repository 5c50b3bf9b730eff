"""Where one placed polygon meets others and the ground: straight pieces and points (§4.1).

Two edges that face each other, parallel or nearly so, meet along the piece on which the gap
between them is small: at its two ends.  Any other contact is that of a corner on an edge, or of a
corner on a corner.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.meeting_rules import (
    BESIDE,
    Contact,
    Sides,
    corner_on_corner,
    corner_on_edge,
    edge_on_corner,
    facing_edges,
    set_back,
    set_back_by,
    without_repeats,
)
from drystone.kernels.polygons import Points, Polygons

GROUND_PLACE = -1
"""What stands for the ground where the index of a polygon is told."""

_fast = compiled("meetings")


class Meetings(NamedTuple):
    """Contacts of one polygon, ordered by the other one, then along the polygon.

    Parameters
    ----------
    others : (k,) int32 array
        Index of the other polygon of each contact; -1 for the ground, which comes first.
    counts : (k,) int32 array
        Number of points, 1 or 2.
    points : (k, 2, 2) float array
        (x, y) of both, on the boundary of the polygon; twice the same for a contact at a point.
    normals : (k, 2) float array
        Unit vectors into the polygon.
    """

    others: NDArray[np.int32]
    counts: NDArray[np.int32]
    points: Points
    normals: Points

    def __len__(self) -> int:
        """Return the number of contacts."""
        return len(self.others)


def meetings(corners: Points, around: Polygons, tolerance: float, setback: float = 0.0) -> Meetings:
    """Find all contacts of one placed polygon with others and with the ground, y = 0.

    Parameters
    ----------
    corners : (n, 2) float array
        A simple polygon, counter-clockwise, not closed, no corner twice in a row.
    around : Polygons
        The others.
    tolerance : float
        Gap or overlap up to which there is contact, above 0; edges are longer as a rule.
    setback : float
        Share of the size (root of the area) of the smaller polygon by which contacts stay away
        from the ends of faces, and by the tolerance at least; 0 leaves them as they are.

    Returns
    -------
    Meetings
        All of them.

    Raises
    ------
    ValueError
        When the corners are no polygon, or the tolerance is not above 0.

    Notes
    -----
    Edges that face each other at an angle of less than 2.9 degrees (:data:`~.LEAN`) touch on the
    part where the gap is within reach, as long as both run beside each other for more than the
    tolerance.  Reach is the tolerance for parallel edges and less the more they lean, nothing at
    2.9 degrees: from one stone to the next the part shrinks to the corner that is nearest, without
    a jump.  At larger angles only this corner touches.

    A corner of one that is beside an edge of the other touches where both sides of the corner lead
    away from the edge.  Corners beside each other touch on the face that separates them most, of
    the two at each corner; where none keeps them apart they do not.  Where faces separate them
    equally, which is common where four joints meet, it is the most level one.

    The normal is that of the edge that a corner stands on; for a piece, at the end with the
    smaller gap.

    Edges of stones are rounded, break and crush.  So with a set-back a piece stays away from the
    ends of both faces, and a point counts only where one of them goes on to both sides of it: a
    corner on a corner, or a lap of less than twice the set-back, carries nothing.

    Examples
    --------
    >>> from drystone.kernels.polygons import no_polygons
    >>> brick = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])
    >>> wall = no_polygons().added([brick])
    >>> found = meetings(brick + [2.0, 2.01], wall, 0.1)
    >>> found.others.tolist(), found.points[0].tolist(), found.normals[0].tolist()
    ([0], [[2.0, 2.01], [4.0, 2.01]], [0.0, 1.0])
    """
    corners = np.ascontiguousarray(corners, np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise ValueError("a polygon has three corners (x, y) or more")
    if not tolerance > 0.0:
        raise ValueError("the tolerance must be above 0")
    if not setback >= 0.0:
        raise ValueError("the set-back must not be below 0")
    if _fast is None:
        return meetings_numpy(corners, around, tolerance, setback)
    return Meetings(
        *_fast.meetings(corners, around.corners, around.first, around.boxes, tolerance, setback)
    )


def meetings_numpy(
    corners: Points, around: Polygons, tolerance: float, setback: float = 0.0
) -> Meetings:
    """Twin of :func:`meetings` without compiled code; inputs are taken as they are."""
    reach = BESIDE * tolerance
    left, bottom = corners.min(axis=0).tolist()
    right, top = corners.max(axis=0).tolist()
    sides = Sides.of(corners)
    others: list[int] = []
    found: list[Contact] = []
    if bottom - reach <= 0.0:
        by = set_back_by(sides, None, tolerance, setback)
        found += _contacts(sides, Sides.of(_ground(left, right, tolerance)), tolerance, by)
        others += [GROUND_PLACE] * len(found)
    boxes = around.boxes
    near = (boxes[:, 0] <= right + reach) & (boxes[:, 2] >= left - reach)
    near &= (boxes[:, 1] <= top + reach) & (boxes[:, 3] >= bottom - reach)
    for index in np.flatnonzero(near).tolist():
        other = Sides.of(around.polygon(index))
        by = set_back_by(sides, other, tolerance, setback)
        new = _contacts(sides, other, tolerance, by)
        found += new
        others += [index] * len(new)
    table = np.array([contact[2:9] for contact in found], np.float64).reshape(-1, 7)
    return Meetings(
        np.array(others, np.int32),
        table[:, 0].astype(np.int32),
        table[:, 1:5].reshape(-1, 2, 2).copy(),
        table[:, 5:] + 0.0,  # no zero has a sign
    )


def _ground(left: float, right: float, tolerance: float) -> Points:
    """Return the piece of ground below a polygon, a box that reaches further on all sides."""
    beyond = 1.0 + 4.0 * tolerance
    return np.array(
        [
            [left - beyond, -beyond],
            [right + beyond, -beyond],
            [right + beyond, 0.0],
            [left - beyond, 0.0],
        ]
    )


def _contacts(sides: Sides, other: Sides, tolerance: float, by: float) -> list[Contact]:
    """Return the contacts of two polygons, in order along the first."""
    reach = BESIDE * tolerance
    mine, theirs = sides.boxes[:, None], other.boxes[None]
    near = (theirs[..., 0] <= mine[..., 2] + reach) & (theirs[..., 2] >= mine[..., 0] - reach)
    near &= (theirs[..., 1] <= mine[..., 3] + reach) & (theirs[..., 3] >= mine[..., 1] - reach)
    found: list[Contact] = []
    for i, j in np.argwhere(near).tolist():
        # What an edge and the corner at its start have to do with an edge and the corner at its.
        for rule in (facing_edges, corner_on_edge, edge_on_corner, corner_on_corner):
            contact = rule(sides, i, other, j, tolerance)
            if contact is not None:
                found.append(contact)
    kept = without_repeats(found, tolerance)
    if by == 0.0:
        return kept
    left = (set_back(sides, other, contact, by, tolerance) for contact in kept)
    return [contact for contact in left if contact is not None]
