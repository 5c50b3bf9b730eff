"""Joints between the stones of a wall, found along rows and columns, and those that go on."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray

from drystone.kernels.polygons import Points

if TYPE_CHECKING:
    from drystone.craft.masonry import Masonry

STEEPEST = 1.0
"""A joint that rises more than it runs is a head joint, else a bed joint: 45 degrees."""


@dataclass(frozen=True)
class Run:
    """A piece of a line inside a stone or wedge."""

    id: int  # of the stone or wedge
    begin: float  # along the line, ascending
    end: float


@dataclass(frozen=True, eq=False)
class Scan:
    """Parallel lines through a wall."""

    spacing: float  # distance of the lines
    # (n,), where they are: heights of rows, or x of columns; as far from one end of the wall's
    # box as from the other, so that a mirrored wall is cut in the same places.
    places: NDArray[np.float64]
    runs: tuple[tuple[Run, ...], ...]  # for each line, in order along it


def scan(outlines: Mapping[int, Points], axis: int, spacing: float) -> Scan:
    """Cut outlines, (n, 2) and not closed, by parallel lines about a spacing apart.

    Along axis 0 they are rows, which run along x; along axis 1 columns, which run up.
    """
    if not outlines:
        return Scan(spacing, np.empty(0), ())
    across = 1 - axis
    corners = np.concatenate(list(outlines.values()))
    low, high = float(corners[:, across].min()), float(corners[:, across].max())
    count = max(1, int(np.ceil((high - low) / spacing - 1e-9)))
    places = low + (np.arange(count) + 0.5) * (high - low) / count
    found: list[list[Run]] = [[] for _ in places]
    for block, loop in outlines.items():
        lines, along = _crossings(loop, axis, places)
        for line, begin, end in zip(lines[::2], along[::2], along[1::2], strict=True):
            found[line].append(Run(block, begin, end))
    rows = tuple(tuple(sorted(line, key=lambda run: run.begin + run.end)) for line in found)
    return Scan((high - low) / count, places, rows)


def _crossings(
    loop: Points, axis: int, places: NDArray[np.float64]
) -> tuple[list[int], list[float]]:
    """Return which lines cross an outline and where, in order; an even number of times each.

    A corner on a line belongs to the side above it.
    """
    ahead = np.roll(loop, -1, axis=0)
    a, b = loop[:, 1 - axis], ahead[:, 1 - axis]
    first, end = np.searchsorted(places, [np.minimum(a, b), np.maximum(a, b)])
    counts = end - first
    edges = np.repeat(np.arange(len(loop)), counts)
    lines = np.arange(len(edges)) + np.repeat(end - np.cumsum(counts), counts)
    share = (places[lines] - a[edges]) / (b[edges] - a[edges])
    along = loop[edges, axis] + share * (ahead[edges, axis] - loop[edges, axis])
    order = np.lexsort((along, lines))
    return lines[order].tolist(), along[order].tolist()


@dataclass(frozen=True, eq=False)
class Joint:
    """A piece of joint between two stones."""

    first: int  # stones to the left and right of a head joint, below and above a bed joint
    second: int
    points: Points  # (n, 2), middle of the gap, bottom to top or left to right
    spacing: float  # length that a point stands for

    @property
    def length(self) -> float:
        """Height of a head joint, width of a bed joint."""
        return len(self.points) * self.spacing

    @property
    def bottom(self) -> Points:
        """Lower end of a head joint."""
        return np.asarray(self.points[0] - np.array([0.0, 0.5 * self.spacing]))

    @property
    def top(self) -> Points:
        """Upper end of a head joint."""
        return np.asarray(self.points[-1] + np.array([0.0, 0.5 * self.spacing]))

    @property
    def x0(self) -> float:
        """Left end of a bed joint."""
        return float(self.points[0, 0]) - 0.5 * self.spacing

    @property
    def x1(self) -> float:
        """Right end of a bed joint."""
        return float(self.points[-1, 0]) + 0.5 * self.spacing


def joints(scanned: Scan, axis: int, widest: float, wedges: frozenset[int]) -> tuple[Joint, ...]:
    """Find the joints that lines of a scan cross: head joints by rows, bed joints by columns.

    Gaps are `widest` at most, but for the thickness of wedges, which are no neighbours.  Two stones
    have several joints where theirs changes between rising and running, or is interrupted.
    """
    sampled: dict[tuple[int, int], list[tuple[int, float]]] = {}
    for line, runs in enumerate(scanned.runs):
        for pair, middle, gap in _neighbours(runs, wedges):
            if gap <= widest:
                sampled.setdefault(pair, []).append((line, middle))
    found = []
    for pair, samples in sampled.items():
        for piece in _pieces(samples, scanned.spacing):
            if len(piece) > 1:  # else it has no direction
                lines, middles = (np.array(column) for column in zip(*piece, strict=True))
                places = scanned.places[lines]
                points = np.column_stack((middles, places) if axis == 0 else (places, middles))
                found.append(Joint(*pair, points, scanned.spacing))
    return tuple(sorted(found, key=lambda one: (*one.points[0].tolist(), one.first, one.second)))


def _neighbours(
    runs: tuple[Run, ...], wedges: frozenset[int]
) -> Iterator[tuple[tuple[int, int], float, float]]:
    """Yield pairs of stones that follow each other on a line, the middle and width of their gap."""
    filled = [run for run in runs if run.id in wedges]
    for one, other in pairwise(run for run in runs if run.id not in wedges):
        if one.id == other.id:
            continue
        between = sum(
            max(0.0, min(run.end, other.begin) - max(run.begin, one.end)) for run in filled
        )
        gap = max(0.0, other.begin - one.end - between)
        yield (one.id, other.id), 0.5 * (one.end + other.begin), gap


def _pieces(samples: list[tuple[int, float]], spacing: float) -> Iterator[list[tuple[int, float]]]:
    """Cut samples of a pair where lines are left out, and where the joint runs along the lines."""
    piece = samples[:1]
    for sample in samples[1:]:
        line, middle = piece[-1]
        if sample[0] - line > 1 or abs(sample[1] - middle) > STEEPEST * spacing:
            yield piece
            piece = []
        piece.append(sample)
    yield piece


@dataclass(frozen=True, eq=False)
class Chain:
    """Head joints that form one joint, from the lowest to the highest."""

    joints: tuple[Joint, ...]

    @property
    def left(self) -> tuple[int, ...]:
        """Stones on its left side, upwards."""
        return tuple(dict.fromkeys(joint.first for joint in self.joints))

    @property
    def right(self) -> tuple[int, ...]:
        """Stones on its right side, upwards."""
        return tuple(dict.fromkeys(joint.second for joint in self.joints))

    @property
    def courses(self) -> int:
        """Through how many courses it goes: the lesser number of stones on a side."""
        return min(len(self.left), len(self.right))

    @property
    def height(self) -> float:
        """From its lower to its upper end."""
        return float(self.joints[-1].top[1] - self.joints[0].bottom[1])

    @property
    def line(self) -> Points:
        """Its middle, upwards."""
        return np.concatenate(
            [np.vstack([joint.bottom, joint.points, joint.top]) for joint in self.joints]
        )


def chains(masonry: "Masonry") -> tuple[Chain, ...]:
    """Join the head joints that go on above each other.

    A joint goes on when the next one begins no farther to the side than the offset of the
    settings and no farther above than a hole, and no stone lies between them.  Where several
    could go on, the one straight above does.
    """
    heads = masonry.heads
    above: dict[int, int] = {}
    below: dict[int, int] = {}
    for _, lower, upper in sorted(_links(masonry)):
        if lower not in above and upper not in below:
            above[lower], below[upper] = upper, lower
    found = []
    for index in range(len(heads)):
        if index not in below:
            place, chain = index, [index]
            while place in above:
                place = above[place]
                chain.append(place)
            found.append(Chain(tuple(heads[i] for i in chain)))
    return tuple(found)


def _links(masonry: "Masonry") -> list[tuple[tuple[float, float], int, int]]:
    """Return how far apart two joints are that may be one, and their indices, lower first."""
    heads = masonry.heads
    if not heads:
        return []
    settings, height = masonry.settings, masonry.mean_height
    bottoms = np.array([joint.bottom for joint in heads])
    tops = np.array([joint.top for joint in heads])
    aside, up = (1e-9 + settings.offset) * height, (1e-9 + settings.hole) * height
    # The ends of two joints that meet overlap by the rounding of stones to lines of the scan.
    low, high = tops - (aside, 2.5 * masonry.rows.spacing), np.add(tops, (aside, up))
    near = shapely.STRtree(shapely.points(bottoms)).query(shapely.box(*low.T, *high.T))
    stones = shapely.STRtree(list(masonry.shapes.values()))
    ids = list(masonry.shapes)
    found = []
    for lower, upper in near.T.tolist():
        one, other = heads[lower], heads[upper]
        # Else the joints are beside each other with the sides changed over.
        climbs = one.first != other.second and one.second != other.first
        if lower == upper or not climbs:
            continue
        way = shapely.LineString([tops[lower], bottoms[upper]])
        four = {one.first, one.second, other.first, other.second}
        if not _crossed(masonry, way, four, {ids[i] for i in stones.query(way)}):
            across, along = np.abs(bottoms[upper] - tops[lower]).tolist()
            cost = round(across / height, 6), round(along / height, 6)
            found.append((cost, lower, upper))
    return found


def _crossed(masonry: "Masonry", way: shapely.LineString, four: set[int], near: set[int]) -> bool:
    """Whether one of the stones near the way from one joint to another lies on it.

    The way may cut corners of the stones of the joints, as far to the side as they may be apart.
    Any other stone on it lies between them, as far as the scan tells it from a touch: each end of
    the way may lie half a line too high or low.
    """
    spacing = masonry.rows.spacing
    of_joints = masonry.settings.offset * masonry.mean_height + 2.5 * spacing
    own = shapely.union_all([masonry.shapes[i] for i in four])
    if shapely.intersection(own, way).length > of_joints:
        return True
    others = [masonry.shapes[i] for i in near - four]
    return bool((shapely.length(shapely.intersection(others, way)) > 0.75 * spacing).any())
