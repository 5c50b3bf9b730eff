"""Head joints and bed joints between the stones of a wall, found along rows and columns."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.craft.scans import Run, Scan

Points = NDArray[np.float64]

STEEPEST = 1.0
"""A joint that rises more than it runs is a head joint, else a bed joint: 45 degrees."""


@dataclass(frozen=True, eq=False)
class Joint:
    """A piece of joint between two stones.

    Parameters
    ----------
    first, second : int
        Stones to the left and right of a head joint, below and above a bed joint.
    points : (n, 2) float array
        Middle of the gap, bottom to top or left to right.
    gap : (n,) float array
        Open width at the points, wedges taken off.
    spacing : float
        Length that a point stands for.
    """

    first: int
    second: int
    points: Points
    gap: NDArray[np.float64]
    spacing: float

    @property
    def length(self) -> float:
        """Height of a head joint, width of a bed joint."""
        return len(self.points) * self.spacing

    @property
    def bottom(self) -> Points:
        """Lower end of a head joint."""
        end: Points = self.points[0] - np.array([0.0, 0.5 * self.spacing])
        return end

    @property
    def top(self) -> Points:
        """Upper end of a head joint."""
        end: Points = self.points[-1] + np.array([0.0, 0.5 * self.spacing])
        return end

    @property
    def x0(self) -> float:
        """Left end of a bed joint."""
        return float(self.points[0, 0]) - 0.5 * self.spacing

    @property
    def x1(self) -> float:
        """Right end of a bed joint."""
        return float(self.points[-1, 0]) + 0.5 * self.spacing


def joints(scanned: Scan, axis: int, widest: float, wedges: frozenset[int]) -> tuple[Joint, ...]:
    """Find the joints that lines of a scan cross.

    Parameters
    ----------
    scanned : Scan
        Rows for head joints, columns for bed joints.
    axis : {0, 1}
        Of the scan.
    widest : float
        Widest gap between neighbours; the thickness of wedges between them does not count.
    wedges : frozenset of int
        Ids of wedges, which are no neighbours.

    Returns
    -------
    tuple of Joint
        Sorted by their first points.  Two stones have several where their joint changes between
        rising and running, or is interrupted.
    """
    sampled: dict[tuple[int, int], list[tuple[int, float, float]]] = {}
    for line, runs in enumerate(scanned.runs):
        for pair, middle, gap in _neighbours(runs, wedges):
            if gap <= widest:
                sampled.setdefault(pair, []).append((line, middle, gap))
    found = [
        _joint(pair, piece, scanned, axis)
        for pair, samples in sampled.items()
        for piece in _pieces(samples, scanned.spacing)
    ]
    return tuple(sorted(found, key=lambda one: (*one.points[0].tolist(), one.first, one.second)))


def _neighbours(
    runs: tuple[Run, ...], wedges: frozenset[int]
) -> Iterator[tuple[tuple[int, int], float, float]]:
    """Yield pairs of stones that follow each other on a line, the middle and width of their gap."""
    stones = [run for run in runs if run.id not in wedges]
    filled = [run for run in runs if run.id in wedges]
    for one, other in pairwise(stones):
        if one.id == other.id:
            continue
        between = sum(
            max(0.0, min(run.end, other.begin) - max(run.begin, one.end)) for run in filled
        )
        gap = max(0.0, other.begin - one.end - between)
        yield (one.id, other.id), 0.5 * (one.end + other.begin), gap


def _pieces(
    samples: list[tuple[int, float, float]], spacing: float
) -> Iterator[list[tuple[int, float, float]]]:
    """Cut samples of a pair where lines are left out, and leave out what runs along the lines."""
    piece: list[tuple[int, float, float]] = []
    for sample in samples:
        if piece:
            step = sample[0] - piece[-1][0]
            if step > 1 or abs(sample[1] - piece[-1][1]) > STEEPEST * spacing:
                yield from _long(piece)
                piece = []
        piece.append(sample)
    yield from _long(piece)


def _long(piece: list[tuple[int, float, float]]) -> Iterator[list[tuple[int, float, float]]]:
    """Keep what has a direction."""
    if len(piece) > 1:
        yield piece


def _joint(
    pair: tuple[int, int], piece: list[tuple[int, float, float]], scanned: Scan, axis: int
) -> Joint:
    lines, middles, gaps = (np.array(column) for column in zip(*piece, strict=True))
    places = scanned.places[lines]
    columns = (middles, places) if axis == 0 else (places, middles)
    return Joint(*pair, np.column_stack(columns), gaps.astype(float), scanned.spacing)
