"""When edges and corners of two polygons touch, pair by pair: see :mod:`.meetings`.

Every rule looks at edge `i` of a polygon or the corner at its start, and at edge `j` of another
one or the corner at its start.  Polygons are counter-clockwise: their outside is to the right.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from drystone.kernels.polygons import Points, polygon_edges

Contact = tuple[int, float, int, float, float, float, float, float, float, int]
"""Edge, how far along it, number of points, x and y of both points, normal into the polygon, and
edge of the other polygon."""

Common = tuple[float, float, float, float, float, float]
"""See :func:`_common`."""

Face = tuple[float, float, float, float]
"""See :func:`_face`."""

LEAN = 0.05
"""Edges that face each other may lean by so much (tangent) and still touch along a piece."""

SAME = 0.995
"""Cosine above which normals of contacts at one place are those of one contact."""

BESIDE = 1.5
"""Nothing that is further away than so many tolerances has to do with a contact."""

EQUAL = 0.01
"""Faces separate corners equally when they do to this share of the tolerance."""

LEVEL = 1e-6
"""How much more level, by the cosine, a face must be to be preferred."""

SHARP = 0.577
"""A face ends where the outline has turned away from it by more than 30 degrees (tangent)."""


@dataclass(frozen=True, eq=False)
class Sides:
    """The edges of a polygon and the corners at their starts, in lists, read one by one.

    Parameters
    ----------
    x, y : list of float
        The corners.
    along_x, along_y : list of float
        Unit vectors of the edges.
    length : list of float
        Of the edges.
    convex : list of bool
        Whether the polygon has less than half a turn inside, at each corner.
    boxes : (n, 4) float array
        Left, bottom, right and top of the edges.
    """

    x: list[float]
    y: list[float]
    along_x: list[float]
    along_y: list[float]
    length: list[float]
    convex: list[bool]
    boxes: Points

    @classmethod
    def of(cls, corners: Points) -> "Sides":
        """Return the sides of a polygon, (n, 2) corners."""
        following = np.roll(corners, -1, axis=0)
        along_x, along_y, length = polygon_edges(corners).T
        before_x, before_y = np.roll(along_x, 1), np.roll(along_y, 1)
        turning = before_x * along_y - before_y * along_x
        x, y = corners.T.tolist()
        boxes = np.hstack([np.minimum(corners, following), np.maximum(corners, following)])
        return cls(
            x,
            y,
            along_x.tolist(),
            along_y.tolist(),
            length.tolist(),
            (turning > 0.0).tolist(),
            boxes,
        )


def set_back_by(p: Sides, q: Sides | None, tolerance: float, setback: float) -> float:
    """Return by how much the contacts of a polygon with another, or the ground, are set back.

    0 stands for not at all.
    """
    if setback == 0.0:
        return 0.0
    size = sqrt(_area(p) if q is None else min(_area(p), _area(q)))
    return max(tolerance, setback * size)


def _area(s: Sides) -> float:
    """Return the area, about the first corner; summed as the compiled twin does."""
    doubled = 0.0
    for k in range(1, len(s.x) - 1):
        x, y = s.x[k] - s.x[0], s.y[k] - s.y[0]
        doubled += x * (s.y[k + 1] - s.y[0]) - y * (s.x[k + 1] - s.x[0])
    return doubled / 2.0 if doubled > 0.0 else 0.0


def facing_edges(p: Sides, i: int, q: Sides, j: int, tolerance: float) -> Contact | None:
    """Return the contact along edges that face each other; one point where it is short."""
    common = _common(p, i, q, j, tolerance)
    if common is None:
        return None
    low, high, first, last, inside, slope = common
    at_low, at_high = inside + slope * (low - first), inside + slope * (high - first)
    low_first = abs(at_low) <= abs(at_high)
    reach = tolerance * (1.0 - abs(slope) / LEAN)
    ends = _within(low, high, at_low, at_high, reach)
    if ends is None:
        if min(abs(at_low), abs(at_high)) > tolerance:
            return None
        ends = (low, low) if low_first else (high, high)
    # The nearer end is a corner of one polygon that stands on an edge of the other; where corners
    # are beside each other it is a little of both.
    over = last if low_first else p.length[i] - first
    share = _clipped(0.5 + over / (2.0 * tolerance))
    normal_x = share * -p.along_y[i] + (1.0 - share) * q.along_y[j]
    normal_y = share * p.along_x[i] + (1.0 - share) * -q.along_x[j]
    length = sqrt(normal_x * normal_x + normal_y * normal_y)
    count = 2 if ends[1] - ends[0] > tolerance else 1
    if count == 1:
        middle = (ends[0] + ends[1]) / 2.0
        ends = middle, middle
    (x0, y0), (x1, y1) = _on_edge(p, i, ends[0]), _on_edge(p, i, ends[1])
    return i, ends[0], count, x0, y0, x1, y1, normal_x / length, normal_y / length, j


def corner_on_edge(p: Sides, i: int, q: Sides, j: int, tolerance: float) -> Contact | None:
    """Return the contact of corner `i` on edge `j`, away from its ends."""
    before = _before(p, i)
    if _along_edge(p, i, q, j, tolerance) is None:
        return None
    if _common(p, before, q, j, tolerance) or _common(p, i, q, j, tolerance):
        return None
    x, y = p.x[i], p.y[i]
    return i, 0.0, 1, x, y, x, y, q.along_y[j], -q.along_x[j], j


def edge_on_corner(p: Sides, i: int, q: Sides, j: int, tolerance: float) -> Contact | None:
    """Return the contact of edge `i`, away from its ends, on corner `j`."""
    before = _before(q, j)
    along = _along_edge(q, j, p, i, tolerance)
    if along is None:
        return None
    if _common(p, i, q, before, tolerance) or _common(p, i, q, j, tolerance):
        return None
    x, y = _on_edge(p, i, along)
    return i, along, 1, x, y, x, y, -p.along_y[i], p.along_x[i], j


def corner_on_corner(p: Sides, i: int, q: Sides, j: int, tolerance: float) -> Contact | None:
    """Return the contact of two convex corners beside each other, where a face separates them."""
    if not (p.convex[i] and q.convex[j] and _are_beside(p, i, q, j, tolerance)):
        return None
    before, behind = _before(p, i), _before(q, j)
    if any(_common(p, k, q, m, tolerance) for k in (before, i) for m in (behind, j)):
        return None
    away_x, away_y = p.x[i] - q.x[j], p.y[i] - q.y[j]
    faces = (
        _face(q, behind, p, i, away_x, away_y),
        _face(q, j, p, i, away_x, away_y),
        _face(p, before, q, j, -away_x, -away_y),
        _face(p, i, q, j, -away_x, -away_y),
    )
    place = _best(faces, EQUAL * tolerance)
    face = None if place is None else faces[place]
    if place is None or face is None:
        return None
    apart, out_x, out_y, along = face
    if place in (0, 2):  # the corner is where this edge ends
        along = -along
    near = away_x * away_x + away_y * away_y <= tolerance * tolerance
    if abs(apart) > tolerance or not (along >= 0.0 or near):
        return None
    if place < 2:
        face_of = behind if place == 0 else j
        return i, 0.0, 1, p.x[i], p.y[i], p.x[i], p.y[i], out_x, out_y, face_of
    edge, start = i, 0.0
    if along > 0.0:
        edge, start = (i, along) if place == 3 else (before, p.length[before] - along)
    x, y = _on_edge(p, edge, start)
    return edge, start, 1, x, y, x, y, -out_x, -out_y, j


def set_back(p: Sides, q: Sides, contact: Contact, by: float, tolerance: float) -> Contact | None:
    """Return what is left of a contact where edges are rounded, break and crush (DESIGN 4.8).

    A piece ends no nearer than `by` to the end of either face; one that is no longer than the
    tolerance then is a point in its middle.  A point counts where one of the two faces goes on
    for `by` to both sides of it.
    """
    i, start, count, x0, y0, x1, y1, normal_x, normal_y, j = contact
    if count == 2:
        end = start + (x1 - x0) * p.along_x[i] + (y1 - y0) * p.along_y[i]
        at_start, at_end = _projected(q, j, x0, y0), _projected(q, j, x1, y1)
        # The other polygon runs the other way.
        first = start + by - min(_runs_on(p, i, start, by, -1), _runs_on(q, j, at_start, by, 1))
        last = end - by + min(_runs_on(p, i, end, by, 1), _runs_on(q, j, at_end, by, -1))
        if last - first > tolerance:
            (x0, y0), (x1, y1) = _on_edge(p, i, first), _on_edge(p, i, last)
            return i, first, 2, x0, y0, x1, y1, normal_x, normal_y, j
        start = (first + last) / 2.0
        start = 0.0 if start < 0.0 else p.length[i] if start > p.length[i] else start
        x0, y0 = _on_edge(p, i, start)
    across = _projected(q, j, x0, y0)
    mine = min(_runs_on(p, i, start, by, -1), _runs_on(p, i, start, by, 1))
    theirs = min(_runs_on(q, j, across, by, -1), _runs_on(q, j, across, by, 1))
    if max(mine, theirs) < by:
        return None
    return i, start, 1, x0, y0, x0, y0, normal_x, normal_y, j


def without_repeats(found: list[Contact], tolerance: float) -> list[Contact]:
    """Return contacts of two polygons in order along the first, none of them twice.

    A point that has the place and the normal of a piece, or of a point found earlier, is left out.
    Pieces that meet at a corner stay, both of them.
    """
    kept = [
        contact
        for place, contact in enumerate(found)
        if contact[2] == 2
        or not any(
            (other[2] == 2 or earlier < place) and _is_same(contact, other, tolerance)
            for earlier, other in enumerate(found)
        )
    ]
    return sorted(kept, key=lambda contact: contact[:2])


def _before(s: Sides, i: int) -> int:
    """Return the edge that ends where edge `i` starts."""
    return i - 1 if i else len(s.x) - 1


def _after(s: Sides, i: int) -> int:
    """Return the edge that starts where edge `i` ends."""
    return i + 1 if i + 1 < len(s.x) else 0


def _on_edge(s: Sides, i: int, along: float) -> tuple[float, float]:
    """Return the point that is so far along an edge."""
    return s.x[i] + along * s.along_x[i], s.y[i] + along * s.along_y[i]


def _projected(s: Sides, i: int, x: float, y: float) -> float:
    """Return how far along an edge a point is beside it; its ends for what is beyond them."""
    along = (x - s.x[i]) * s.along_x[i] + (y - s.y[i]) * s.along_y[i]
    return 0.0 if along < 0.0 else s.length[i] if along > s.length[i] else along


def _runs_on(s: Sides, i: int, along: float, enough: float, sense: int) -> float:
    """Return how far a face goes on from a point of edge `i`, at most `enough`.

    It ends at a corner where the outline turns away; at one where it turns towards the other
    polygon there is stone enough behind it.
    """
    run = s.length[i] - along if sense > 0 else along
    edge = i
    for _ in range(len(s.x) - 1):
        if run >= enough:
            return enough
        edge = _after(s, edge) if sense > 0 else _before(s, edge)
        dot = s.along_x[i] * s.along_x[edge] + s.along_y[i] * s.along_y[edge]
        away = sense * (s.along_x[i] * s.along_y[edge] - s.along_y[i] * s.along_x[edge])
        if abs(away) > SHARP * dot:
            return run if away >= 0.0 else enough
        run += s.length[edge]
    return run if run < enough else enough


def _common(p: Sides, i: int, q: Sides, j: int, tolerance: float) -> Common | None:
    """Return where two edges face each other; None when they do not, or hardly.

    Returns
    -------
    low, high : float
        From where to where, along edge `i`.
    first, last : float
        Where edge `j` starts and ends, along edge `i`.
    inside, slope : float
        How far the start of edge `j` is on the inner side of edge `i`, and how much further all
        else is with every unit of length along it.
    """
    dot = p.along_x[i] * q.along_x[j] + p.along_y[i] * q.along_y[j]
    cross = p.along_x[i] * q.along_y[j] - p.along_y[i] * q.along_x[j]
    if dot >= 0.0 or abs(cross) > LEAN * -dot:
        return None
    end = _after(q, j)
    away_x, away_y = q.x[j] - p.x[i], q.y[j] - p.y[i]
    first = away_x * p.along_x[i] + away_y * p.along_y[i]
    last = (q.x[end] - p.x[i]) * p.along_x[i] + (q.y[end] - p.y[i]) * p.along_y[i]
    low = last if last > 0.0 else 0.0
    high = first if first < p.length[i] else p.length[i]
    if high - low <= tolerance:
        return None
    inside = p.along_x[i] * away_y - p.along_y[i] * away_x
    return low, high, first, last, inside, cross / dot


def _within(
    low: float, high: float, at_low: float, at_high: float, reach: float
) -> tuple[float, float] | None:
    """Return the part from low to high on which a value is at most `reach` from 0."""
    if min(at_low, at_high) > reach or max(at_low, at_high) < -reach:
        return None
    start, end = low, high
    if abs(at_low) > reach:
        limit = reach if at_low > 0.0 else -reach
        start = low + (high - low) * ((limit - at_low) / (at_high - at_low))
    if abs(at_high) > reach:
        limit = reach if at_high > 0.0 else -reach
        end = low + (high - low) * ((limit - at_low) / (at_high - at_low))
    return start, end


def _clipped(share: float) -> float:
    """Return a share between 0 and 1."""
    if share < 0.0:
        return 0.0
    return 1.0 if share > 1.0 else share


def _along_edge(s: Sides, i: int, t: Sides, j: int, tolerance: float) -> float | None:
    """Return how far along edge `j` corner `i` stands on it; None when it does not.

    Near a convex end of the edge the corner is on that corner instead.
    """
    away_x, away_y = s.x[i] - t.x[j], s.y[i] - t.y[j]
    along = away_x * t.along_x[j] + away_y * t.along_y[j]
    outside = away_x * t.along_y[j] - away_y * t.along_x[j]
    if not 0.0 <= along <= t.length[j] or abs(outside) > tolerance or not s.convex[i]:
        return None
    if not _clears(s, i, t.along_y[j], -t.along_x[j]):
        return None
    for end in (j, _after(t, j)):
        if t.convex[end] and _are_beside(s, i, t, end, tolerance):
            return None
    return along


def _are_beside(s: Sides, i: int, t: Sides, j: int, tolerance: float) -> bool:
    """Tell whether two corners are so near that neither stands on an edge away from its ends."""
    away_x, away_y = s.x[i] - t.x[j], s.y[i] - t.y[j]
    return away_x * away_x + away_y * away_y <= 2.0 * tolerance * tolerance


def _clears(s: Sides, i: int, out_x: float, out_y: float) -> bool:
    """Tell whether both edges at a corner lead outwards, or hardly inwards."""
    before = _before(s, i)
    coming = s.along_x[before] * out_x + s.along_y[before] * out_y
    leaving = s.along_x[i] * out_x + s.along_y[i] * out_y
    return coming <= LEAN and leaving >= -LEAN


def _face(s: Sides, k: int, t: Sides, j: int, away_x: float, away_y: float) -> Face | None:
    """Return how a face of one corner separates another one from it; None when it does not.

    Returns
    -------
    apart : float
        How far outside the other corner is.
    out_x, out_y : float
        Normal of the face.
    along : float
        How far the other corner is along the face, from the corner.
    """
    out_x, out_y = s.along_y[k], -s.along_x[k]
    if not _clears(t, j, out_x, out_y):
        return None
    apart = away_x * out_x + away_y * out_y
    return apart, out_x, out_y, away_x * s.along_x[k] + away_y * s.along_y[k]


def _best(faces: Sequence[Face | None], equal: float) -> int | None:
    """Return which face separates most; of equal ones the most level, of these the first."""
    most = max((face[0] for face in faces if face), default=0.0)
    best, level = None, 0.0
    for place, face in enumerate(faces):
        if face and face[0] >= most - equal and (best is None or abs(face[2]) > level + LEVEL):
            best, level = place, abs(face[2])
    return best


def _is_same(one: Contact, other: Contact, tolerance: float) -> bool:
    """Tell whether a contact at a point has the place and the normal of another contact."""
    limit = 4.0 * tolerance * tolerance
    if one[7] * other[7] + one[8] * other[8] < SAME:
        return False
    to_start = (one[3] - other[3]) * (one[3] - other[3]) + (one[4] - other[4]) * (one[4] - other[4])
    to_end = (one[3] - other[5]) * (one[3] - other[5]) + (one[4] - other[6]) * (one[4] - other[6])
    return to_start <= limit or to_end <= limit
