"""Outlines cut into convex parts, as rigid-body engines want them."""

from math import dist

import numpy as np
import shapely

from drystone.kernels.polygons import Points
from drystone.model.overlap import common_parts, shape_of

_Corner = tuple[float, float]
_Side = tuple[_Corner, _Corner]

STRAIGHT = 1e-9
"""Corners that go in by this share of the size of a stone count as straight."""

FLAT = 1e-6
"""Corners of parts that turn by less than this, radians, are none."""

REACHES = (0.3, 0.1, 0.03, 0.01, 0.003)
"""How far parts reach into the stone beyond their faces, over the square root of its area."""


def convex_parts(outline: Points) -> tuple[Points, ...]:
    """Cover the boundary of a polygon, from inside, with convex parts that overlap.

    No corner of the outline is moved, so contacts stay where they are.  A seam between two parts
    is an edge which the stone does not have; where it ended at a corner of the outline, a
    neighbour that touches this corner would be held by it (measured: stones hooked to their
    neighbours, and tilt angles above the proven bound).  Stones of a wall touch at corners
    everywhere.  So parts reach over their seams, between their own faces, and end elsewhere.
    Inside the stone, where nothing gets to, holes may be left.  Outline and parts, (n, 2), turn
    counter-clockwise and are not closed; a convex outline stays as it is.
    """
    ring = _corners(outline)
    whole = shapely.Polygon(ring)
    size = float(np.sqrt(whole.area))
    if _is_convex(ring, size):
        return (without_straight_corners(np.array(ring)),)
    faces = set(_sides(ring))
    parts: list[list[_Corner]] = []
    for cell in _cells(outline):
        grown = _reaching(
            whole, _corner(np.mean(cell, axis=0)), [(s, s not in faces) for s in _sides(cell)]
        )
        parts += [grown] if grown else _slabs(ring, whole, faces.intersection(_sides(cell)), cell)
    return tuple(without_straight_corners(np.array(part)) for part in parts)


def without_straight_corners(part: Points) -> Points:
    """Leave out the corners of a convex polygon at which it does not turn.

    The engine takes the corner furthest along a normal, then the face at it; where a face is made
    of several edges that may be the wrong one, and the contact comes to lie beside both stones
    (measured: a contact 46 px from where two stones touched, which turned one by 14 degrees).
    """
    before, after = part - np.roll(part, 1, axis=0), np.roll(part, -1, axis=0) - part
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turns = turn > FLAT * np.hypot(*before.T) * np.hypot(*after.T)
    return np.asarray(part[turns])


def _slabs(
    ring: list[_Corner], whole: shapely.Polygon, faces: set[_Side], cell: list[_Corner]
) -> list[list[_Corner]]:
    """Cover the faces of a cell one by one; a cell without faces needs nothing."""
    slabs = []
    around = zip(ring[-1:] + ring[:-1], ring, ring[1:] + ring[:1], ring[2:] + ring[:2], strict=True)
    for before, a, b, after in around:
        if (a, b) not in faces:
            continue
        normal = np.array([a[1] - b[1], b[0] - a[0]]) / dist(a, b)
        a_in, b_in = _corner(a + normal), _corner(b + normal)
        sides = [((a, b), False), ((b, a), True)]
        # At a corner the next face is the end; in a notch the slab goes on into the stone.
        sides += [((before, a), False) if _turns_left(before, a, b) else ((a_in, a), True)]
        sides += [((b, after), False) if _turns_left(a, b, after) else ((b, b_in), True)]
        reach = 1e-6 * float(np.sqrt(whole.area))
        inside = _corner((np.array(a) + np.array(b)) / 2 + normal * reach)
        slab = _reaching(whole, inside, sides)
        if slab is None:
            return [cell]
        slabs.append(slab)
    return slabs


def _reaching(
    whole: shapely.Polygon, inside: _Corner, sides: list[tuple[_Side, bool]]
) -> list[_Corner] | None:
    """Return what of a stone lies between lines, some moved outwards as far as it stays convex."""
    left, low, right, high = whole.bounds
    size = float(np.sqrt(whole.area))
    for reach in REACHES:
        region = [(left, low), (right, low), (right, high), (left, high)]
        for side, moved in sides:
            region = _left_of(region, side, reach * size if moved else 0.0)
        # In floats a part may leave out a flat corner of the stone, and stick out of it there.
        found = common_parts(shape_of(np.array(region)), whole) if len(region) > 2 else ()
        piece = next((p for p in found if p.intersects(shapely.Point(inside))), None)
        if piece is not None and not piece.interiors:
            corners = shapely.get_coordinates(shapely.orient_polygons(piece))[:-1]
            # Rounding may have made several of one.
            apart = np.hypot(*(corners - np.roll(corners, 1, axis=0)).T) > STRAIGHT * size
            ring = _corners(corners[apart])
            if _is_convex(ring, size):
                return ring
    return None


def _cells(outline: Points) -> list[list[_Corner]]:
    """Cut a polygon into convex cells whose corners are its own.

    Triangles are joined over their longest common sides first, as long as both ends stay convex
    (Hertel and Mehlhorn 1983: at most four times the fewest cells).
    """
    triangles = shapely.constrained_delaunay_triangles(shapely.Polygon(outline)).geoms
    cells = {
        key: _corners(shapely.get_coordinates(shapely.orient_polygons(triangle))[:3])
        for key, triangle in enumerate(triangles)
    }
    owner = {side: key for key, cell in cells.items() for side in _sides(cell)}
    shared = [(a, b) for a, b in owner if (b, a) in owner and a < b]
    for a, b in sorted(shared, key=lambda side: (-dist(*side), side)):
        key, gone = owner[a, b], owner[b, a]
        i, j = cells[key].index(b), cells[gone].index(a)
        joined = cells[key][i:] + cells[key][:i] + (cells[gone][j:] + cells[gone][:j])[1:-1]
        at = joined.index(a), joined.index(b)
        if all(_turns_left(joined[i - 1], joined[i], joined[(i + 1) % len(joined)]) for i in at):
            cells[key] = joined
            del cells[gone]
            owner.update(dict.fromkeys(_sides(joined), key))
    return list(cells.values())


def _left_of(region: list[_Corner], side: _Side, reach: float) -> list[_Corner]:
    """Return what of a convex region lies to the left of a line moved to the right by `reach`."""
    (ax, ay), (bx, by) = side
    length = dist(*side)
    heights = [((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length + reach for x, y in region]
    kept: list[_Corner] = []
    for i, (here, height) in enumerate(zip(region, heights, strict=True)):
        before, lower = region[i - 1], heights[i - 1]
        if (height < 0.0) != (lower < 0.0):
            t = lower / (lower - height)
            kept.append(
                (before[0] + t * (here[0] - before[0]), before[1] + t * (here[1] - before[1]))
            )
        if height >= 0.0:
            kept.append(here)
    return kept


def _corners(points: Points) -> list[_Corner]:
    return [(float(x), float(y)) for x, y in points]


def _sides(cell: list[_Corner]) -> list[_Side]:
    return list(zip(cell, cell[1:] + cell[:1], strict=True))


def _corner(point: Points) -> _Corner:
    return float(point[0]), float(point[1])


def _is_convex(ring: list[_Corner], size: float) -> bool:
    """Tell whether no corner goes in by more than a rounding error."""
    corners = zip(ring[-1:] + ring[:-1], ring, ring[1:] + ring[:1], strict=True)
    return all(_cross(*c) >= -STRAIGHT * size * dist(c[0], c[2]) for c in corners)


def _turns_left(before: _Corner, here: _Corner, after: _Corner) -> bool:
    return _cross(before, here, after) >= 0.0


def _cross(before: _Corner, here: _Corner, after: _Corner) -> float:
    ax, ay = here[0] - before[0], here[1] - before[1]
    bx, by = after[0] - here[0], after[1] - here[1]
    return ax * by - ay * bx
