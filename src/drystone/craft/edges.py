"""Slopes of the upper and lower edges of stones."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from drystone.craft.finding import Line
from drystone.craft.masonry import Masonry

MIDDLE = 0.8
"""Share of the width of a stone whose edges are looked at: its corners are rounded."""


@dataclass(frozen=True, eq=False)
class Edge:
    """The upper or lower edge of a stone.

    Parameters
    ----------
    stone : int
        Id.
    side : {"lower", "upper"}
        Which.
    slope : float
        Rise to the right over run of the straight line fitted to it.
    width : float
        Of the part that was fitted.
    line : (2, 2) float array
        The fitted line.
    """

    stone: int
    side: Literal["lower", "upper"]
    slope: float
    width: float
    line: Line

    @property
    def angle_deg(self) -> float:
        """Of the slope, in (-90, 90)."""
        return float(np.degrees(np.arctan(self.slope)))


def edges(masonry: Masonry) -> tuple[Edge, ...]:
    """Fit a straight line to the lower and the upper edge of every stone.

    Returns
    -------
    tuple of Edge
        By id, the lower one first; stones that are too narrow to have edges are left out.
    """
    profiles: dict[int, list[tuple[float, float, float]]] = {i: [] for i in masonry.stones}
    for x, runs in zip(masonry.columns.places.tolist(), masonry.columns.runs, strict=True):
        spans: dict[int, tuple[float, float]] = {}
        for run in runs:
            if run.id in profiles:
                begin, _ = spans.get(run.id, (run.begin, run.end))
                spans[run.id] = begin, run.end
        for stone, (low, high) in spans.items():
            profiles[stone].append((x, low, high))
    found = []
    for stone, profile in profiles.items():
        x0, _, x1, _ = masonry.boxes[stone]
        values = np.array(profile).reshape(-1, 3)
        inner = values[np.abs(values[:, 0] - 0.5 * (x0 + x1)) <= 0.5 * MIDDLE * (x1 - x0)]
        if len(inner) > 2:
            found.append(_fitted(stone, "lower", inner[:, :2]))
            found.append(_fitted(stone, "upper", inner[:, ::2]))
    return tuple(found)


def _fitted(stone: int, side: Literal["lower", "upper"], points: Line) -> Edge:
    x, y = points.T
    about = x - x.mean()
    slope = float(about @ (y - y.mean()) / (about @ about))
    ends = x[[0, -1]]
    line = np.column_stack([ends, y.mean() + slope * (ends - x.mean())])
    return Edge(stone, side, slope, float(np.ptp(x)), line)
