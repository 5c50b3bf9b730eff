"""The free space under a placed polygon, with all its corners: no columns, no pixels (§3.7).

What lies above and below it are *chains*: corners from left to right, two corners of one x are a
step.  The lid is the stone's lower boundary as seen from below, the floor the first that is met on
the way down from there.  Both are moved into the free space by a clearance.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.polygons import Points, Polygons

Chain = Points
Segments = NDArray[np.float64]
"""Rows x0, y0, x1, y1 with x0 < x1."""
Ints = NDArray[np.int64]

SAME = 1e-9
"""Corners nearer than this are one, and edges that cover less of the x axis are upright."""

_fast = compiled("crevice")


class Crevice(NamedTuple):
    """The free space under a polygon, from its left end to its right end.

    Parameters
    ----------
    lid, floor : (n, 2) float arrays
        Chains, the clearance already taken off.  Where the lid is not above the floor there is no
        space.
    """

    lid: Chain
    floor: Chain


def crevice(stone: Points, around: Polygons, clearance: float) -> Crevice:
    """Return the free space between a polygon and what is below it.

    Parameters
    ----------
    stone : (n, 2) float array
        The polygon, counter-clockwise, over the ground y = 0.
    around : Polygons
        The others, which it does not overlap.
    clearance : float
        Distance from both kept by the chains: nowhere less, at corners up to 1.42 times as much.
        0: the boundaries themselves.

    Examples
    --------
    >>> from drystone.kernels.polygons import no_polygons
    >>> raised = np.array([[0.0, 3.0], [2.0, 3.0], [2.0, 4.0], [0.0, 4.0]])
    >>> space = crevice(raised, no_polygons(), 0.25)
    >>> space.lid.tolist(), space.floor.tolist()
    ([[0.0, 2.75], [2.0, 2.75]], [[0.0, 0.25], [2.0, 0.25]])
    """
    if _fast is None:
        return crevice_numpy(stone, around, clearance)
    corners = np.ascontiguousarray(stone, np.float64)
    return Crevice(*_fast.crevice(corners, around.corners, around.first, around.boxes, clearance))


def crevice_numpy(stone: Points, around: Polygons, clearance: float) -> Crevice:
    """Twin of :func:`crevice`."""
    lid, floor = _boundaries(stone, around, 4.0 * clearance)
    left, right = float(stone[:, 0].min()), float(stone[:, 0].max())
    return Crevice(
        _flipped(_raised(_flipped(lid), clearance, left, right)),
        _raised(floor, clearance, left, right),
    )


def gap_polygon(
    stone: Points, around: Polygons, x_left: float, x_right: float, clearance: float
) -> Points | None:
    """Return the free space under a polygon between two upright lines.

    Parameters
    ----------
    stone, around, clearance
        As for :func:`crevice`.
    x_left, x_right : float
        The lines, below the polygon.

    Returns
    -------
    corners : (n, 2) float array or None
        Simple, counter-clockwise.  None when the space closes anywhere between the lines.

    Raises
    ------
    ValueError
        When there is no polygon above one of the lines, or they are not in order.

    Examples
    --------
    >>> from drystone.kernels.polygons import no_polygons
    >>> raised = np.array([[0.0, 3.0], [2.0, 3.0], [2.0, 4.0], [0.0, 4.0]])
    >>> gap_polygon(raised, no_polygons(), 0.5, 1.5, 0.25).tolist()
    [[0.5, 0.25], [1.5, 0.25], [1.5, 2.75], [0.5, 2.75]]
    """
    if not stone[:, 0].min() <= x_left < x_right <= stone[:, 0].max():
        raise ValueError(f"lines at {x_left} and {x_right} are not in order below the polygon")
    return between(crevice(stone, around, clearance), x_left, x_right)


def between(space: Crevice, x_left: float, x_right: float) -> Points | None:
    """Cut the piece between two upright lines out of a crevice; None when it closes there.

    Parameters
    ----------
    space : Crevice
        From :func:`crevice`.
    x_left, x_right : float
        In order, and inside it.
    """
    x, low, high = slabs(space, x_left, x_right)
    # Both sides of a step count together: halves that meet in a point are not one simple polygon.
    over = np.minimum(high[:-1, 1], high[1:, 0]) - np.maximum(low[:-1, 1], low[1:, 0])
    if not len(low) or (high <= low).any() or (over <= 0.0).any():
        return None
    inside = (x[0] + SAME, x[-1] - SAME)
    ends = np.array([[x[0], low[0, 0], high[0, 0]], [x[-1], low[-1, 1], high[-1, 1]]])
    return np.concatenate(
        [
            ends[:1, :2],
            _within(space.floor, *inside),
            ends[1:, :2],
            ends[1:, ::2],
            _within(space.lid, *inside)[::-1],
            ends[:1, ::2],
        ]
    )


def slabs(space: Crevice, x_left: float, x_right: float) -> tuple[Points, Points, Points]:
    """Cut a crevice at all its corners into slabs with a straight floor and lid.

    Parameters
    ----------
    space : Crevice
        From :func:`crevice`.
    x_left, x_right : float
        Where to begin and to end.

    Returns
    -------
    x : (n + 1,) float array
        Where the slabs begin, and the end of the last.
    low, high : (n, 2) float arrays
        y of floor and lid at the left and at the right of each slab.
    """
    x = _distinct(np.concatenate([space.lid[:, 0], space.floor[:, 0]]), x_left, x_right)
    return x, _heights(space.floor, x), _heights(space.lid, x)


def _boundaries(stone: Points, around: Polygons, reach: float) -> tuple[Chain, Chain]:
    """Return lid and floor as they are, from `reach` left of the stone to so far right of it."""
    x, y = stone[:, 0], stone[:, 1]
    left, right = float(x.min()) - reach, float(x.max()) + reach
    lids = _lids(stone, reach)
    near = (around.boxes[:, 0] < right) & (around.boxes[:, 2] > left)
    near &= around.boxes[:, 1] < y.max()
    edges, bottoms = _edges_of(around, np.flatnonzero(near))
    edges = np.concatenate([edges, [[left, 0.0, right, 0.0]]])
    at = _distinct(np.concatenate([lids[:, ::2].ravel(), edges[:, ::2].ravel()]), left, right)
    middle = (at[:-1] + at[1:]) / 2.0
    lid = _highest(_flipped(lids), middle, np.full(len(middle), np.inf))
    below = _highest(edges, middle, _line(lids[lid], middle))
    # Where nothing is below, or the next is a bottom from inside, the stone stands in something.
    closed = (below < 0) | np.append(bottoms, False)[below]
    floor = np.where(closed[:, None], lids[lid], edges[below])
    return (
        _chain(lids[lid], lid, at),
        _chain(floor, np.where(closed, len(edges) + lid, below), at),
    )


def _lids(stone: Points, reach: float) -> Segments:
    """Return the edges below which a polygon ends, and level ones beyond its two ends.

    In thought it goes on there, so that what stands close beside the lines is seen as well.
    """
    x, y = stone[:, 0], stone[:, 1]
    left, right = x.min(), x.max()
    low_left, low_right = y[x == left].min(), y[x == right].min()
    after = np.roll(stone, -1, axis=0)
    edges = np.concatenate(
        [
            np.column_stack([stone, after]),
            [
                [left - reach, low_left, left, low_left],
                [right, low_right, right + reach, low_right],
            ],
        ]
    )
    return np.asarray(edges[edges[:, 2] - edges[:, 0] > SAME])


def _edges_of(around: Polygons, near: Ints) -> tuple[Segments, NDArray[np.bool_]]:
    """Return the edges of some polygons from left to right, and whether each is a bottom."""
    sizes = np.diff(around.first)[near].astype(np.int64)
    ends = np.cumsum(sizes)
    at = np.arange(int(sizes.sum())) + np.repeat(around.first[near] - (ends - sizes), sizes)
    following = np.arange(1, len(at) + 1)
    following[ends - 1] = ends - sizes
    here = around.corners[at]
    after = here[following]
    run = after[:, 0] - here[:, 0]
    bottom = run > 0.0
    edges = np.where(
        bottom[:, None], np.column_stack([here, after]), np.column_stack([after, here])
    )
    kept = np.abs(run) > SAME
    return edges[kept], bottom[kept]


def _raised(chain: Chain, clearance: float, left: float, right: float) -> Chain:
    """Move a chain up by a clearance, along its normals, and cut it off at two places.

    The highest of its moved edges counts everywhere.  At corners that stand out they are made
    longer until they meet; where the chain turns by more than 90 degrees, by the clearance, and
    joined straight.
    """
    edges = _moved(chain, clearance) if clearance else np.column_stack([chain[:-1], chain[1:]])
    edges = edges[edges[:, 2] - edges[:, 0] > SAME]
    at = _distinct(np.concatenate([edges[:, ::2].ravel(), _crossings(edges)]), left, right)
    middle = (at[:-1] + at[1:]) / 2.0
    top = _highest(edges, middle, np.full(len(middle), np.inf))
    return _chain(edges[top], top, at)


def _moved(chain: Chain, clearance: float) -> Segments:
    """Return the edges of a chain moved up and made longer, and those that join them."""
    step = chain[1:] - chain[:-1]
    length = np.sqrt(step[:, 0] * step[:, 0] + step[:, 1] * step[:, 1])
    x, y = step[:, 0] / length, step[:, 1] / length
    sine = x[:-1] * y[1:] - y[:-1] * x[1:]
    cosine = x[:-1] * x[1:] + y[:-1] * y[1:]
    out, sharp = sine < 0.0, (sine < 0.0) & (cosine < 0.0)
    # The tangent of half the turn.
    more = np.where(sharp, 1.0, np.where(out, -sine / (1.0 + np.maximum(cosine, 0.0)), 0.0))
    longer = np.concatenate([[0.0], more, [0.0]])
    first, last = longer[:-1], longer[1:]
    starts = chain[:-1] + clearance * np.column_stack([-y - first * x, x - first * y])
    stops = chain[1:] + clearance * np.column_stack([-y + last * x, x + last * y])
    joints = np.column_stack([stops[:-1], starts[1:]])[sharp]
    return np.concatenate([np.column_stack([starts, stops]), joints])


def _crossings(edges: Segments) -> Points:
    """Return the x of all points where two segments cross."""
    one, two = np.nonzero(
        (edges[:, None, 0] < edges[None, :, 2]) & (edges[None, :, 0] < edges[:, None, 2])
    )
    one, two = one[one < two], two[one < two]
    low = np.maximum(edges[one, 0], edges[two, 0])
    high = np.minimum(edges[one, 2], edges[two, 2])
    before = _line(edges[one], low) - _line(edges[two], low)
    after = _line(edges[one], high) - _line(edges[two], high)
    cross = before * after < 0.0
    low, high, before, after = low[cross], high[cross], before[cross], after[cross]
    return np.asarray(low + (high - low) * (before / (before - after)))


def _highest(edges: Segments, middle: Points, ceiling: Points) -> Ints:
    """Return which segment is the highest at each of some x, none above the ceiling; -1: none."""
    first = np.searchsorted(middle, edges[:, 0])
    count = np.searchsorted(middle, edges[:, 2]) - first
    which = np.repeat(np.arange(len(edges)), count)
    starts = np.cumsum(count) - count
    at = np.arange(int(count.sum())) + np.repeat(first - starts, count)
    y = _line(edges[which], middle[at])
    below = y <= ceiling[at]
    which, at, y = which[below], at[below], y[below]
    order = np.lexsort((-which, y, at))
    found = np.full(len(middle), -1, np.int64)
    # Of several values for one place the last one stays.
    found[at[order]] = which[order]
    return found


def _chain(edges: Segments, which: Ints, x: Points) -> Chain:
    """Return the chain of segments that are given for each slab."""
    new = np.flatnonzero(np.append(True, which[1:] != which[:-1]))
    stop = np.append(new[1:], len(which))
    starts = np.column_stack([x[new], _line(edges[new], x[new])])
    stops = np.column_stack([x[stop], _line(edges[new], x[stop])])
    corners = np.stack([starts, stops], axis=1).reshape(-1, 2)
    new = (np.abs(corners[1:] - corners[:-1]) > SAME).any(axis=1)
    return np.asarray(corners[np.append(True, new)])


def _heights(chain: Chain, x: Points) -> Points:
    """Return y of a chain at the left and at the right end of each slab."""
    stop = np.searchsorted(chain[:, 0], (x[:-1] + x[1:]) / 2.0)
    edges = np.column_stack([chain[stop - 1], chain[stop]])
    return np.column_stack([_line(edges, x[:-1]), _line(edges, x[1:])])


def _within(chain: Chain, x_left: float, x_right: float) -> Chain:
    """Return the corners of a chain between two lines."""
    return chain[(chain[:, 0] > x_left) & (chain[:, 0] < x_right)]


def _distinct(x: Points, left: float, right: float) -> Points:
    """Return numbers in order, from one limit to another, without those that are the same."""
    inside = np.sort(x[(x > left + SAME) & (x < right - SAME)])
    if not len(inside):
        return np.array([left, right])
    new = np.append(True, inside[1:] - inside[:-1] > SAME)
    return np.concatenate([[left], inside[new], [right]])


def _line(edges: Segments, x: Points) -> Points:
    """Return y of segments at one x each."""
    share = (x - edges[:, 0]) / (edges[:, 2] - edges[:, 0])
    return np.asarray(edges[:, 1] + (edges[:, 3] - edges[:, 1]) * share)


def _flipped(points: Points) -> Points:
    """Return points or segments upside down."""
    return np.asarray(points * np.tile([1.0, -1.0], points.shape[1] // 2))
