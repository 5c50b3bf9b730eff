"""Gaps between a polygon and those around it, as constraints of its small motions (DESIGN 4.9).

A gap belongs to a corner of one polygon and an edge, or a corner, of another.  It has a normal
that points towards the moving polygon, and a motion that takes the corner along the normal by
minus the gap makes the two touch.  Where two corners are near each other the face that parts
them best gives the normal, so that bricks meet with their faces.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.crossings import contains
from drystone.kernels.polygons import Points, Polygons
from drystone.kernels.rings import Ints, Ring

GROUND, END = -1, -2
SAME = 1e-9
INTO = 0.03

Flags = NDArray[np.bool_]
Keyed = tuple[int, int, int, int, float, float, float, float, float, float]

_fast = compiled("gaps")


class Gap(NamedTuple):
    """One gap.

    Parameters
    ----------
    gap : float
        Along the normal; below 0 where the corner lies inside.
    normal_x, normal_y : float
        Unit vector towards the moving polygon.
    x, y : float
        The corner; of two corners, that of the moving polygon.
    away : float
        Distance; more than the gap only where two corners meet with a face.
    other : int
        Number of the other polygon, or `GROUND`, or `END` for an end of the wall.
    """

    gap: float
    normal_x: float
    normal_y: float
    x: float
    y: float
    away: float
    other: int


def gaps_around(
    corners: Points, edges: Points, around: Polygons, width: float, reach: float, corner: float
) -> list[Gap]:
    """List the gaps of a polygon to what is near: others, the ground, the ends of the wall.

    Parameters
    ----------
    corners : (n, 2) float array
        Counter-clockwise.
    edges : (n, 3) float array
        Of it (:func:`drystone.kernels.polygons.polygon_edges`); those without length are left
        out.
    around : Polygons
        What is near, and more.
    width : float
        Of the wall.
    reach : float
        Largest gap, and largest depth.
    corner : float
        Two corners nearer than this meet with a face.

    Examples
    --------
    >>> from drystone.kernels.polygons import no_polygons, polygon_edges
    >>> flat = np.array([[4.0, 1.0], [6.0, 1.0], [6.0, 2.0], [4.0, 2.0]])
    >>> [gap.gap for gap in gaps_around(flat, polygon_edges(flat), no_polygons(), 10.0, 1.5, 0.3)]
    [1.0, 1.0]
    """
    if _fast is None:
        return gaps_python(corners, edges, around, width, reach, corner)
    rows = _fast.gaps_around(
        corners, edges, around.corners, around.first, around.boxes, around.edges, width, reach,
        corner,
    )  # fmt: skip
    return [Gap(d, nx, ny, x, y, away, int(k)) for d, nx, ny, x, y, away, k in rows.tolist()]


def gaps_python(
    corners: Points,
    edges: Points,
    around: Polygons,
    width: float,
    reach: float,
    corner: float,
    beyond: float = 0.0,
) -> list[Gap]:
    """Twin of :func:`gaps_around`."""
    body = Ring.of(corners, edges)
    left, low = corners.min(axis=0).tolist()
    right, high = corners.max(axis=0).tolist()
    box = around.boxes
    apart = (left > box[:, 2] + reach) | (right < box[:, 0] - reach)
    apart |= (low > box[:, 3] + reach) | (high < box[:, 1] - reach)
    near = np.flatnonzero(~apart)
    found: list[Keyed] = []
    if len(near):
        rings, owner = Ring.several(around, near)
        windows = _windows((left, low, right, high), box[near], reach)
        ways = Way(body, rings, 0, reach, corner), Way(rings, body, 1, reach, corner)
        in_window, meets = _points_in(body, windows), _edges_in(rings, windows)
        own = np.arange(len(owner))
        found += ways[0].gaps(in_window[:, owner] & meets[own, owner], owner)
        in_window, meets = _points_in(rings, windows), _edges_in(body, windows)
        found += ways[1].gaps(in_window[own, owner][:, None] & meets[:, owner].T, owner)
        found.sort()
    gaps = [Gap(d, nx, ny, x, y, away, int(near[k])) for k, _, _, _, d, nx, ny, x, y, away in found]
    gaps += _to_the_site(corners.tolist(), width, reach, beyond)
    return gaps


def _windows(box: tuple[float, float, float, float], boxes: Points, reach: float) -> Points:
    """Return where two boxes, grown by the reach, meet: left, bottom, right and top."""
    return np.stack(
        [
            np.maximum(boxes[:, 0], box[0]) - reach,
            np.maximum(boxes[:, 1], box[1]) - reach,
            np.minimum(boxes[:, 2], box[2]) + reach,
            np.minimum(boxes[:, 3], box[3]) + reach,
        ]
    )


def _points_in(ring: Ring, windows: Points) -> Flags:
    """Say which corners lie in which windows."""
    x, y = ring.corners[:, :1], ring.corners[:, 1:]
    inside = (x >= windows[0]) & (x <= windows[2])
    return np.asarray(inside & (y >= windows[1]) & (y <= windows[3]))


def _edges_in(ring: Ring, windows: Points) -> Flags:
    """Say the boxes of which edges meet which windows."""
    most, least = np.maximum(ring.corners, ring.ends), np.minimum(ring.corners, ring.ends)
    meets = (most[:, :1] >= windows[0]) & (least[:, :1] <= windows[2])
    return np.asarray(meets & (most[:, 1:] >= windows[1]) & (least[:, 1:] <= windows[3]))


class Way(NamedTuple):
    """Corners on one side, edges on the other.

    Parameters
    ----------
    a, b : Ring
        Whose corners, and whose edges.
    turn : int
        0 when the corners are those of the moving polygon, else 1.
    reach, corner : float
        See :func:`gaps_around`.
    """

    a: Ring
    b: Ring
    turn: int
    reach: float
    corner: float

    def gaps(self, pairs: Flags, owner: Ints) -> list[Keyed]:
        """List the gaps of some pairs of a corner and an edge, each with its place in the list."""
        a, b = self.a, self.b
        dx = a.corners[:, :1] - b.corners[:, 0]
        dy = a.corners[:, 1:] - b.corners[:, 1]
        ux, uy = b.edges[:, 0], b.edges[:, 1]
        s = dx * uy - dy * ux
        t = dx * ux + dy * uy
        pairs = pairs & (-self.reach <= s) & (s <= self.reach) & (t <= b.edges[:, 2])
        facing = t >= 0.0
        rows = list(self._facing(np.nonzero(pairs & facing & (s >= -SAME)), s, owner))
        rows += self._corners(np.nonzero(pairs & (t < 0.0)), s, owner)
        # Whether what lies on an edge is inside, rounding says.
        on = {(row[0], row[2]) for row in rows if row[-1] <= SAME}
        inside = self._inside(np.nonzero(pairs & facing & (s < -SAME)), s, owner)
        return rows + [row for row in inside if (row[0], row[2]) not in on]

    def _keyed(
        self, i: int, e: int, place: int, owner: Ints, gap: list[float], point: Points
    ) -> Keyed:
        """Give a gap (its size, normal out of b, and distance) its place in the list."""
        sign = -1.0 if self.turn else 1.0
        x, y = point.tolist()
        who = int(owner[i if self.turn else e])
        own = int(self.a.number[i])
        d, nx, ny, away = gap
        return who, self.turn, own, place, d, sign * nx, sign * ny, x, y, away

    def _facing(self, at: tuple[Ints, ...], s: Points, owner: Ints) -> Iterator[Keyed]:
        """List corners in front of an edge."""
        i, e = at
        sign = -1.0 if self.turn else 1.0
        yield from zip(
            (owner[i] if self.turn else owner[e]).tolist(),
            [self.turn] * len(i),
            self.a.number[i].tolist(),
            self.b.number[e].tolist(),
            s[i, e].tolist(),
            (sign * self.b.edges[e, 1]).tolist(),
            (-sign * self.b.edges[e, 0]).tolist(),
            self.a.corners[i, 0].tolist(),
            self.a.corners[i, 1].tolist(),
            s[i, e].tolist(),
            strict=True,
        )

    def _inside(self, at: tuple[Ints, ...], s: Points, owner: Ints) -> Iterator[Keyed]:
        """List corners inside a polygon, each with the nearest edge."""
        nearest: dict[tuple[int, int], int] = {}
        for i, e in zip(at[0].tolist(), at[1].tolist(), strict=True):
            key = i, int(self.b.first[e])
            if key not in nearest or s[i, e] > s[i, nearest[key]]:
                nearest[key] = e
        for (i, _), e in nearest.items():
            if contains(self.b.polygon(e), *self.a.corners[i].tolist()):
                ux, uy, _ = self.b.edges[e].tolist()
                gap = [float(s[i, e]), uy, -ux, float(s[i, e])]
                corner = self.a.corners[i]
                yield self._keyed(i, e, int(self.b.size[e]), owner, gap, corner)

    def _corners(self, at: tuple[Ints, ...], s: Points, owner: Ints) -> Iterator[Keyed]:
        """List corners that lie in the region of a corner."""
        i, e = at
        b, p = self.b, self.b.before[e]
        away = self.a.corners[i] - b.corners[p]
        ahead = away[:, 0] * b.edges[p, 0] + away[:, 1] * b.edges[p, 1] > b.edges[p, 2]
        i, e, p, away = i[ahead], e[ahead], p[ahead], away[ahead]
        side = away[:, 0] * b.edges[p, 1] - away[:, 1] * b.edges[p, 0]
        apart = self.a.corners[i] - b.corners[e]
        d = np.sqrt(apart[:, 0] * apart[:, 0] + apart[:, 1] * apart[:, 1])
        outside = (d <= self.reach) & ~((s[i, e] < 0.0) & (side < 0.0))
        for k in np.flatnonzero(outside).tolist():
            gap = self._between(int(i[k]), int(e[k]), float(d[k]), apart[k].tolist())
            if gap is not None:
                # Either way the force acts on the moving polygon's corner.
                corner = b.corners[e[k]] if self.turn else self.a.corners[i[k]]
                yield self._keyed(int(i[k]), int(e[k]), int(b.number[e[k]]), owner, gap, corner)

    def _between(self, i: int, e: int, d: float, apart: list[float]) -> list[float] | None:
        """Return the gap of two corners, with its normal."""
        dx, dy = apart
        if d < self.corner and (face := self._face(i, e, dx, dy)) is not None:
            return [*face, d]
        if d > SAME:
            return [d, dx / d, dy / d, d]
        own, before = self.b.edges[[e, self.b.before[e]]].tolist()
        nx, ny = own[1] + before[1], -own[0] - before[0]
        length = math.sqrt(nx * nx + ny * ny)
        return [0.0, nx / length, ny / length, 0.0] if length > SAME else None

    def _face(self, i: int, e: int, dx: float, dy: float) -> list[float] | None:
        """Return the gap along the normal of the face that parts two corners best."""
        a, b = self.a.edges, self.b.edges
        ends = a[self.a.before[i]], a[i], b[self.b.before[e]], b[e]
        after = [tuple(edge[:2].tolist()) for edge in ends]
        normals = [(y, -x) for x, y in after[2:]] + [(-y, x) for x, y in after[:2]]
        best, face = -SAME, None
        for mx, my in normals:
            along = [x * mx + y * my for x, y in after]
            # The two edges at either corner must not run through the face.
            if not (-along[0] >= -INTO and along[1] >= -INTO):
                continue
            if not (-along[2] <= INTO and along[3] <= INTO):
                continue
            s = dx * mx + dy * my
            if s > best:
                best, face = s, [s, mx, my]
        return face


def _to_the_site(
    corners: list[list[float]], width: float, reach: float, beyond: float
) -> list[Gap]:
    """List the gaps of corners to the ground and the ends of the wall."""
    gaps = [Gap(y, 0.0, 1.0, x, y, y, GROUND) for x, y in corners if y < reach]
    near = [(x + beyond, x, y) for x, y in corners]
    gaps += [Gap(d, 1.0, 0.0, x, y, d, END) for d, x, y in near if d < reach]
    far = [(width - x + beyond, x, y) for x, y in corners]
    return gaps + [Gap(d, -1.0, 0.0, x, y, d, END) for d, x, y in far if d < reach]
