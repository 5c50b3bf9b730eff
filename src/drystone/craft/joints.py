"""Joints between the stones of a wall, found along rows and columns, and those that go on."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.polygons import Points
from drystone.kernels.profiles import Floats


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


@dataclass(frozen=True, eq=False)
class StoneSides:
    """The lower and the upper side of a stone, column by column from left to right."""

    x: Floats  # (n,)
    low: Floats  # (n,) height of the lower side, of the lowest piece where there are several
    high: Floats  # (n,) height of the upper side, of the highest one
    gap: Floats  # (n,) air down to the next stone, wedge or the ground
    spacing: float  # of columns


def profiles(columns: Scan, stones: Collection[int], ground: float) -> dict[int, StoneSides]:
    """Return the sides of all stones that any column cuts."""
    found: dict[int, dict[float, tuple[float, float, float]]] = {i: {} for i in stones}
    for x, runs in zip(columns.places.tolist(), columns.runs, strict=True):
        top = ground
        for run in runs:
            if run.id in found:
                low, _, gap = found[run.id].get(x, (run.begin, 0.0, max(0.0, run.begin - top)))
                found[run.id][x] = low, run.end, gap
            top = max(top, run.end)
    sides = {}
    for stone, cells in found.items():
        if cells:
            low, high, gap = np.array([*cells.values()]).T
            sides[stone] = StoneSides(np.array([*cells]), low, high, gap, columns.spacing)
    return sides


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
    points: Points  # (n, 2), middle of the gap from end to end, bottom to top or left to right
    length: float  # height of a head joint, width of a bed joint


def joints(scanned: Scan, axis: int, widest: float, stones: Collection[int]) -> tuple[Joint, ...]:
    """Find the joints that lines of a scan cross: head joints by rows, bed joints by columns.

    Gaps are `widest` at most, but for the thickness of wedges: these are what is not among the ids
    of `stones`, and no neighbours.  Two stones have several joints where theirs changes between
    rising and running, or is interrupted.
    """
    sampled: dict[tuple[int, int], list[tuple[int, float]]] = {}
    for line, runs in enumerate(scanned.runs):
        for pair, middle, gap in _neighbours(runs, stones):
            if gap <= widest:
                sampled.setdefault(pair, []).append((line, middle))
    found = []
    # A line stands for half of what is between it and the next one.
    half = 0.5 * scanned.spacing * np.eye(2)[1 - axis]
    for pair, samples in sampled.items():
        for piece in _pieces(samples, scanned.spacing):
            if len(piece) > 1:  # else it has no direction
                lines, middles = (np.array(column) for column in zip(*piece, strict=True))
                places = scanned.places[lines]
                points = np.column_stack((middles, places) if axis == 0 else (places, middles))
                points = np.vstack([points[0] - half, points, points[-1] + half])
                found.append(Joint(*pair, points, len(piece) * scanned.spacing))
    return tuple(sorted(found, key=lambda one: (*one.points[0].tolist(), one.first, one.second)))


def _neighbours(
    runs: tuple[Run, ...], stones: Collection[int]
) -> Iterator[tuple[tuple[int, int], float, float]]:
    """Yield pairs of stones that follow each other on a line, the middle and width of their gap."""
    filled = [run for run in runs if run.id not in stones]
    for one, other in pairwise(run for run in runs if run.id in stones):
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
        # At 45 degrees a joint rises as much as it runs.
        if sample[0] - line > 1 or abs(sample[1] - middle) > spacing:
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
        return float(self.line[-1, 1] - self.line[0, 1])

    @property
    def line(self) -> Points:
        """Its middle, upwards."""
        return np.concatenate([joint.points for joint in self.joints])
