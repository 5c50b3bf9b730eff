"""What lies on straight lines across a wall, one after the other."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """A piece of a line inside a stone or wedge.

    Parameters
    ----------
    id : int
        Of the stone or wedge.
    begin, end : float
        Along the line, ascending.
    """

    id: int
    begin: float
    end: float


@dataclass(frozen=True, eq=False)
class Scan:
    """Parallel lines through a wall.

    Parameters
    ----------
    spacing : float
        Distance of the lines.
    places : (n,) float array
        Where they are: heights of rows, or x of columns; as far from one end of the wall's box
        as from the other, so that a mirrored wall is cut in the same places.
    runs : tuple of tuple of Run
        For each line, in order along it.
    """

    spacing: float
    places: NDArray[np.float64]
    runs: tuple[tuple[Run, ...], ...]


def scan(outlines: Mapping[int, Points], axis: int, spacing: float) -> Scan:
    """Cut outlines by parallel lines.

    Parameters
    ----------
    outlines : mapping of int to (n, 2) float array
        Corners in order, not closed.
    axis : {0, 1}
        0 for rows, which run along x; 1 for columns, which run up.
    spacing : float
        About how far apart, above 0.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    >>> rows = scan({7: square, 8: square + [3, 0]}, 0, 1.0)
    >>> rows.runs
    ((Run(id=7, begin=0.0, end=2.0), Run(id=8, begin=3.0, end=5.0)),)
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
        ahead = np.roll(loop, -1, axis=0)
        first, last = np.searchsorted(places, [loop[:, across].min(), loop[:, across].max()])
        for line in range(int(first), min(int(last) + 1, count)):
            found[line] += _runs(block, loop, ahead, axis, float(places[line]))
    rows = tuple(tuple(sorted(line, key=lambda run: run.begin + run.end)) for line in found)
    return Scan((high - low) / count, places, rows)


def _runs(block: int, loop: Points, ahead: Points, axis: int, place: float) -> list[Run]:
    """Cut one outline by one line; a corner on the line belongs to the side above it."""
    across = 1 - axis
    a, b = loop[:, across], ahead[:, across]
    crossing = np.flatnonzero((a <= place) != (b <= place))
    share = (place - a[crossing]) / (b[crossing] - a[crossing])
    along = loop[crossing, axis] + share * (ahead[crossing, axis] - loop[crossing, axis])
    ends = np.sort(along).tolist()
    return [Run(block, x0, x1) for x0, x1 in zip(ends[::2], ends[1::2], strict=True)]
