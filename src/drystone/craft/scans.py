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
