"""Straight runs of chains of unit pixel edges, and the lines that fit them (§4.2).

All that decides is exact in integers, and a normal is a handful of float operations that are
rounded correctly everywhere: results do not depend on the machine.
"""

from collections.abc import Sequence
from itertools import pairwise
from math import copysign, isqrt, sqrt
from operator import mul

Numbers = Sequence[int]

SQUARED_TOLERANCE_PX = 2
"""A run may leave its chord by the square root of this before it is split.

The pixel corners of a straight joint lie in a strip narrower than |cos| + |sin| <= sqrt 2, so a
straight joint is never split, and a leg of two pixels at the end of a long run is.
"""

HOOK_NEEDS_PX = 3
"""An end edge square to a straight piece of at least this length is a hook of the grid."""


def straight_runs(x: Numbers, y: Numbers) -> list[tuple[int, int]]:
    """Return the first and last node of each straight run of a chain, without hooks.

    Parameters
    ----------
    x, y : sequence of int
        Pixel corners along the chain.

    Examples
    --------
    >>> straight_runs([0, 1, 2, 3, 4, 4], [0, 0, 0, 0, 0, 1])
    [(0, 4)]
    """
    return [without_hooks(x, y, *piece) for piece in pairwise(split_at_corners(x, y))]


def split_at_corners(x: Numbers, y: Numbers) -> list[int]:
    """Cut a chain at its corners (Douglas and Peucker 1973).

    Parameters
    ----------
    x, y : sequence of int
        At least two points; a closed chain repeats the first one at the end.

    Returns
    -------
    list of int
        Indices of the points where pieces meet, with the first and the last.

    Examples
    --------
    >>> split_at_corners([0, 0, 0, 4], [0, 1, 5, 5])
    [0, 2, 3]
    """
    cuts = {0, len(x) - 1}
    pieces = [(0, len(x) - 1)]
    while pieces:
        first, last = pieces.pop()
        middle = _corner_between(x, y, first, last)
        if middle is not None:
            cuts.add(middle)
            pieces += [(first, middle), (middle, last)]
    return sorted(cuts)


def _corner_between(x: Numbers, y: Numbers, first: int, last: int) -> int | None:
    """Return the point furthest from the chord, the first of several; None if that is near."""
    if last - first < 2:
        return None
    x0, y0 = x[first], y[first]
    dx, dy = x[last] - x0, y[last] - y0
    inner = zip(x[first + 1 : last], y[first + 1 : last], strict=True)
    if dx or dy:  # times the length of the chord
        away = [abs(dx * (v - y0) - dy * (u - x0)) for u, v in inner]
        near = isqrt(SQUARED_TOLERANCE_PX * (dx * dx + dy * dy))
    else:  # a closed piece has no chord; it is bent however small it is
        away = [(u - x0) ** 2 + (v - y0) ** 2 for u, v in inner]
        near = 0
    furthest = max(away)
    return first + 1 + away.index(furthest) if furthest > near else None


def without_hooks(x: Numbers, y: Numbers, first: int, last: int) -> tuple[int, int]:
    """Leave out a single edge that turns off at either end of a straight piece.

    The ledge of one pixel is the grid's, not the stone's; it must not tilt the normal.
    """
    needed = HOOK_NEEDS_PX + 1
    if last - first >= needed and _is_hook(x, y, last, -1):
        last -= 1
    if last - first >= needed and _is_hook(x, y, first, 1):
        first += 1
    return first, last


def _is_hook(x: Numbers, y: Numbers, end: int, inwards: int) -> bool:
    """Say whether the edge at the end of a run turns off from a straight piece."""
    bend = end + inwards
    far = bend + HOOK_NEEDS_PX * inwards
    dx, dy = x[bend] - x[far], y[bend] - y[far]
    straight = max(abs(dx), abs(dy)) == HOOK_NEEDS_PX
    return straight and dx * (x[end] - x[bend]) + dy * (y[end] - y[bend]) == 0


def normal_beside(x: Numbers, y: Numbers, first: int, last: int) -> tuple[float, float]:
    """Return the unit normal to the left of a run.

    Parameters
    ----------
    x, y : sequence of int
        Pixel corners along a chain; y up.
    first, last : int
        Ends of the run.

    Notes
    -----
    The line is fitted to the midpoints of the edges by total least squares: on a regular
    staircase they lie along its slope, and one odd edge hardly turns it.  The scatter of twice
    the midpoints is found from sums of integers, exact up to some thousand edges.

    Examples
    --------
    >>> normal_beside([0, 1, 2], [0, 0, 0], 0, 2)
    (0.0, 1.0)
    """
    x0, y0 = 2 * x[first], 2 * y[first]
    xs = [a + b - x0 for a, b in pairwise(x[first : last + 1])]
    ys = [a + b - y0 for a, b in pairwise(y[first : last + 1])]
    count, sx, sy = float(last - first), float(sum(xs)), float(sum(ys))
    xx = count * float(sum(map(mul, xs, xs))) - sx * sx
    xy = count * float(sum(map(mul, xs, ys))) - sx * sy
    yy = count * float(sum(map(mul, ys, ys))) - sy * sy
    chord_x, chord_y = float(x[last] - x[first]), float(y[last] - y[first])
    along_x, along_y = _long_axis(xx - yy, 2.0 * xy) or (chord_x, chord_y)
    length = sqrt(along_x * along_x + along_y * along_y)
    if along_x * chord_x + along_y * chord_y < 0.0:
        length = -length
    return -along_y / length + 0.0, along_x / length + 0.0


def _long_axis(difference: float, mixed: float) -> tuple[float, float] | None:
    """Return the direction of the largest scatter; None when none is better than another.

    Parameters
    ----------
    difference, mixed : float
        xx - yy and 2 xy of the scatter: cosine and sine of twice the angle, times something.
    """
    if mixed == 0.0:
        if difference == 0.0:
            return None
        return (1.0, 0.0) if difference > 0.0 else (0.0, 1.0)
    size = sqrt(difference * difference + mixed * mixed)
    if difference >= 0.0:  # of two expressions the one that does not cancel
        return size + difference, mixed
    return abs(mixed), copysign(size - difference, mixed)
