"""Straight pieces of a digitised line: how few lines it takes, fitted by least squares.

Only sums, products, quotients and square roots: they are the same bits on every machine, as sines
and solvers are not, and outlines decide which wall is planned.

The contour of a label at level .5 passes through the midpoints of its pixel edges
(`skimage.measure.find_contours` on the padded mask gives the same points).  Where pixel centres
decide what is inside, a straight line lies within half a pixel of all midpoints.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

PULL = 1e-3
"""Weight of the pixel corner where lines meet, beside 1 for each line."""

PASSES = 6
"""How often all cuts are moved at most: a cut that moves makes room for the next one."""

MOVES = 8
"""Newton steps to the area of a chain; the error falls tenfold and more with each."""

REACH_PX = 1.0
"""A corner may lie this far from the pixel corner where two pieces meet."""


@dataclass(frozen=True, eq=False)
class Line:
    """A fitted line: a point on it, and its unit vector in the sense of the contour."""

    point: Points
    along: Points

    def distance(self, points: Points) -> Points:
        """Return how far points lie to the left of it."""
        x, y = (points - self.point).T
        return np.asarray(self.along[0] * y - self.along[1] * x)


def fitted_lines(nodes: Points, tolerance: float) -> tuple[list[int], list[Line]]:
    """Cover a chain of unit pixel edges, given by its nodes (n + 1, 2), with few fitted lines.

    No midpoint of an edge is further from the line of its piece than the tolerance, px.  Cuts are
    the indices of the nodes between pieces, with 0 and n.  From its start every piece is as long as
    it can be; then every cut moves to where the two pieces beside it fit best.
    """
    chain = _Chain(nodes)
    cuts = [0]
    while cuts[-1] < chain.count:
        cuts.append(chain.furthest(cuts[-1], tolerance))
    for _ in range(PASSES):
        before = cuts.copy()
        for i in range(1, len(cuts) - 1):
            cuts[i] = chain.best_cut(cuts[i - 1], cuts[i], cuts[i + 1], tolerance)
        if cuts == before:
            break
    return cuts, [chain.line(a, b) for a, b in pairwise(cuts)]


class _Chain:
    """Midpoints of the edges of a chain and sums that make fits of any piece quick."""

    def __init__(self, nodes: Points) -> None:
        self.nodes = nodes
        self.count = len(nodes) - 1
        self.origin = nodes[0]
        self.middle = (nodes[1:] + nodes[:-1]) / 2.0 - self.origin
        x, y = self.middle.T
        terms = np.column_stack([x, y, x * x, x * y, y * y])
        self.sums = np.vstack([np.zeros(5), np.cumsum(terms, axis=0)])

    def line(self, first: int, last: int) -> Line:
        """Fit a line to the edges first ... last - 1 by total least squares."""
        count = last - first
        x, y, xx, xy, yy = ((self.sums[last] - self.sums[first]) / count).tolist()
        wide, skew = (xx - x * x) - (yy - y * y), 2.0 * (xy - x * y)
        along_x, along_y = (self.nodes[last] - self.nodes[first]).tolist()
        if max(abs(wide), 0.5 * abs(skew)) > 1e-9:
            # Half of the angle whose cosine and sine are as wide and skew.
            spread = math.sqrt(wide * wide + skew * skew)
            longer = math.sqrt((1.0 + abs(wide) / spread) / 2.0)
            shorter = skew / spread / (2.0 * longer)
            shorter = shorter if abs(shorter) > 1e-12 else 0.0
            u, v = (longer, shorter) if wide >= 0.0 else (shorter, longer)
            sense = 1.0 if u * along_x + v * along_y >= 0.0 else -1.0
            along_x, along_y = sense * u, sense * v
        elif along_x or along_y:  # one edge, or no direction better than another
            length = math.sqrt(along_x * along_x + along_y * along_y)
            along_x, along_y = along_x / length, along_y / length
        else:
            along_x = 1.0
        return Line(self.origin + np.array([x, y]), np.array([along_x, along_y]))

    def fits(self, first: int, last: int, tolerance: float) -> bool:
        """Tell whether one line will do for the edges first ... last - 1."""
        line = self.line(first, last)
        away = line.distance(self.middle[first:last] + self.origin)
        return bool(np.abs(away).max() <= tolerance + 1e-9)

    def furthest(self, first: int, tolerance: float) -> int:
        """Return the end of the longest piece from `first` that is found by doubling."""
        good, step = first + 1, 1
        while good < self.count and self.fits(first, min(good + step, self.count), tolerance):
            good = min(good + step, self.count)
            step *= 2
        while step > 1:
            step //= 2
            if good + step <= self.count and self.fits(first, good + step, tolerance):
                good += step
        return good

    def best_cut(self, first: int, cut: int, last: int, tolerance: float) -> int:
        """Return where the pieces before and after a cut have the least squared distances."""
        places = np.arange(first + 1, last)
        best = int(places[np.argmin(self._misfit(first, places) + self._misfit(places, last))])
        if self.fits(first, best, tolerance) and self.fits(best, last, tolerance):
            return best
        return cut

    def _misfit(self, first: int | NDArray[np.int64], last: int | NDArray[np.int64]) -> Points:
        """Return the sums of squared distances of pieces from their lines."""
        count = np.asarray(last - first, float)
        x, y, xx, xy, yy = (self.sums[last] - self.sums[first]).T / count
        xx, xy, yy = xx - x * x, xy - x * y, yy - y * y
        least = (xx + yy - np.sqrt((xx - yy) ** 2 + 4.0 * xy * xy)) / 2.0
        # The sums cancel: what is left below 1e-9 is rounding, not distance.
        return np.asarray(np.where(least > 1e-9, least, 0.0) * count)


def meeting_point(lines: list[Line], near: Points) -> Points:
    """Return the point closest to several lines, at most REACH_PX from the pixel corner near it.

    In the sense of least squares; a weak pull towards the pixel corner decides along lines of one
    direction.
    """
    xx, xy, yy, x, y = PULL, 0.0, PULL, 0.0, 0.0
    for line in lines:
        (along_x, along_y), (to_x, to_y) = line.along.tolist(), (line.point - near).tolist()
        away = along_x * to_y - along_y * to_x
        xx, xy, yy = xx + along_y * along_y, xy - along_x * along_y, yy + along_x * along_x
        x, y = x - along_y * away, y + along_x * away
    whole = xx * yy - xy * xy
    x, y = (yy * x - xy * y) / whole, (xx * y - xy * x) / whole
    shorter = min(1.0, REACH_PX / max(math.sqrt(x * x + y * y), REACH_PX))
    return np.array([near[0] + shorter * x, near[1] + shorter * y])


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
