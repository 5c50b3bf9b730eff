"""Straight pieces of a digitised line: how few lines it takes, fitted by least squares.

Only sums, products, quotients and square roots: they are the same bits on every machine, as sines
and solvers are not, and outlines decide which wall is planned.

The contour of a label at level .5 passes through the midpoints of its pixel edges
(`skimage.measure.find_contours` on the padded mask gives the same points).  Where pixel centres
decide what is inside, a straight line lies within half a pixel of all midpoints.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import sqrt

    from drystone.kernels.lists import doubles

Points = NDArray[np.float64]

PULL = 1e-3
"""Weight of the pixel corner where lines meet, beside 1 for each line."""

PASSES = 6
"""How often all cuts are moved at most: a cut that moves makes room for the next one."""

MOVES = 8
"""Newton steps to the area of a chain; the error falls tenfold and more with each."""

REACH_PX = 1.0
"""A corner may lie this far from the pixel corner where two pieces meet."""


class Line(NamedTuple):
    """A fitted line: a point on it, and its unit vector in the sense of the contour."""

    x: float
    y: float
    along_x: float
    along_y: float


def fitted_lines(nodes: Points, tolerance: float) -> tuple[list[int], list[Line]]:
    """Cover a chain of unit pixel edges, given by its nodes (n + 1, 2), with few fitted lines.

    No midpoint of an edge is further from the line of its piece than the tolerance, px.  Cuts are
    the indices of the nodes between pieces, with 0 and n.  From its start every piece is as long as
    it can be; then every cut moves to where the two pieces beside it fit best.
    """
    chain: EdgeChain = EdgeChain(nodes)
    cuts, last = [0], 0
    while last < chain.count:
        last = furthest(chain, last, tolerance)
        cuts.append(last)
    for _ in range(PASSES):
        before = cuts.copy()
        for i in range(1, len(cuts) - 1):
            cuts[i] = best_cut(chain, cuts[i - 1], cuts[i], cuts[i + 1], tolerance)
        if cuts == before:
            break
    lines = []
    for first, last in pairwise(cuts):
        fit(chain, first, last)
        lines.append(
            Line(nodes[0, 0] + chain.x, nodes[0, 1] + chain.y, chain.along_x, chain.along_y)
        )
    return cuts, lines


@cython.cclass
class EdgeChain:
    """Midpoints of the edges of a chain, sums that make fits of any piece quick, and a fit."""

    def __init__(self, nodes: Points) -> None:
        nodes = np.ascontiguousarray(nodes)
        middle = (nodes[1:] + nodes[:-1]) / 2.0 - nodes[0]
        x, y = middle.T
        # All are quarters of whole numbers, which have no rounding.
        terms = np.column_stack([x, y, x * x, x * y, y * y])
        sums = np.vstack([np.zeros(5), np.cumsum(terms, axis=0)])
        self.kept = (nodes, middle, sums)
        self.count = len(middle)
        self.nodes, self.middle, self.sums = doubles(nodes), doubles(middle), doubles(sums)


def fit(chain, first, last):
    """Fit a line to the edges first ... last - 1; return the sum of their squared distances."""
    count: cython.double = last - first
    a: cython.Py_ssize_t = 5 * first
    b: cython.Py_ssize_t = 5 * last
    x: cython.double = (chain.sums[b] - chain.sums[a]) / count
    y: cython.double = (chain.sums[b + 1] - chain.sums[a + 1]) / count
    xx: cython.double = (chain.sums[b + 2] - chain.sums[a + 2]) / count - x * x
    xy: cython.double = (chain.sums[b + 3] - chain.sums[a + 3]) / count - x * y
    yy: cython.double = (chain.sums[b + 4] - chain.sums[a + 4]) / count - y * y
    wide: cython.double = xx - yy
    skew: cython.double = 2.0 * xy
    spread: cython.double = sqrt(wide * wide + skew * skew)
    along_x: cython.double = chain.nodes[2 * last] - chain.nodes[2 * first]
    along_y: cython.double = chain.nodes[2 * last + 1] - chain.nodes[2 * first + 1]
    if max(abs(wide), 0.5 * abs(skew)) > 1e-9:
        # Half of the angle whose cosine and sine are as wide and skew.
        longer: cython.double = sqrt((1.0 + abs(wide) / spread) / 2.0)
        shorter: cython.double = skew / spread / (2.0 * longer)
        shorter = shorter if abs(shorter) > 1e-12 else 0.0
        u: cython.double = longer if wide >= 0.0 else shorter
        v: cython.double = shorter if wide >= 0.0 else longer
        sense: cython.double = 1.0 if u * along_x + v * along_y >= 0.0 else -1.0
        along_x, along_y = sense * u, sense * v
    elif along_x or along_y:  # one edge, or no direction better than another
        length: cython.double = sqrt(along_x * along_x + along_y * along_y)
        along_x, along_y = along_x / length, along_y / length
    else:
        along_x = 1.0
    chain.x, chain.y, chain.along_x, chain.along_y = x, y, along_x, along_y
    least: cython.double = (xx + yy - spread) / 2.0
    # The sums cancel: what is left below 1e-9 is rounding, not distance.
    return least * count if least > 1e-9 else 0.0


def fits(chain, first, last, tolerance):
    """Tell whether one line will do for the edges first ... last - 1."""
    fit(chain, first, last)
    for i in range(2 * first, 2 * last, 2):
        x: cython.double = chain.middle[i] - chain.x
        y: cython.double = chain.middle[i + 1] - chain.y
        if abs(chain.along_x * y - chain.along_y * x) > tolerance + 1e-9:
            return False
    return True


def furthest(chain, first, tolerance):
    """Return the end of the longest piece from `first` that is found by doubling."""
    good: cython.Py_ssize_t = first + 1
    step: cython.Py_ssize_t = 1
    while good < chain.count and fits(chain, first, min(good + step, chain.count), tolerance):
        good = min(good + step, chain.count)
        step *= 2
    while step > 1:
        step //= 2
        if good + step <= chain.count and fits(chain, first, good + step, tolerance):
            good += step
    return good


def best_cut(chain, first, cut, last, tolerance):
    """Return where the pieces before and after a cut have the least squared distances."""
    best: cython.Py_ssize_t = cut
    least: cython.double = math.inf
    for place in range(first + 1, last):
        found: cython.double = fit(chain, first, place) + fit(chain, place, last)
        if found < least:
            best, least = place, found
    if fits(chain, first, best, tolerance) and fits(chain, best, last, tolerance):
        return best
    return cut


def meeting_point(lines: Iterable[Line], near: Points) -> Points:
    """Return the point closest to several lines, at most REACH_PX from the pixel corner near it.

    In the sense of least squares; a weak pull towards the pixel corner decides along lines of one
    direction.
    """
    xx, xy, yy, x, y = PULL, 0.0, PULL, 0.0, 0.0
    near_x, near_y = near.tolist()
    for line in lines:
        along_x, along_y = line.along_x, line.along_y
        away = along_x * (line.y - near_y) - along_y * (line.x - near_x)
        xx, xy, yy = xx + along_y * along_y, xy - along_x * along_y, yy + along_x * along_x
        x, y = x - along_y * away, y + along_x * away
    whole = xx * yy - xy * xy
    x, y = (yy * x - xy * y) / whole, (xx * y - xy * x) / whole
    shorter = min(1.0, REACH_PX / max(math.sqrt(x * x + y * y), REACH_PX))
    return np.array([near_x + shorter * x, near_y + shorter * y])


def with_area(line: Points, nodes: Points, more: float = 0.0) -> Points:
    """Move the inner corners of a simplified chain until it has the area of the chain beside it.

    `more` is to be gained on the left beyond that.  The ends stay.  Every corner moves across the
    line between its neighbours, further the longer that is, so that long sides keep their
    directions.
    """
    line = line.copy()
    for _ in range(MOVES):  # the area is almost linear in the moves
        span = line[2:] - line[:-2]
        squared = float((span * span).sum())
        if squared == 0.0:
            break
        missing = 2.0 * (_area_between(line, nodes) - more) / squared
        line[1:-1] += missing * np.column_stack([-span[:, 1], span[:, 0]])
    return line


def _area_between(line: Points, nodes: Points) -> float:
    """Return the area to the left of a line and to the right of a chain with its ends nearby."""
    ring = np.concatenate([line, nodes[::-1]])
    (x, y), (ahead_x, ahead_y) = ring.T, np.concatenate([ring[1:], ring[:1]]).T.copy()
    return float(x @ ahead_y - y @ ahead_x) / 2.0
