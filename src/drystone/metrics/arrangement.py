"""Interlocking of head joints and straightness of bed joints (Eq. 26, Eq. 27)."""

import math
from collections.abc import Sequence

from drystone.metrics.paths import JointPath

SHORTEST = 5
"""How many of the shortest paths are averaged."""


def vertical_arrangement(paths: Sequence[JointPath]) -> float | None:
    """Return F_AV in percent, by how much vertical paths are longer than straight (Eq. 27).

    Higher is better: head joints are interrupted.

    Parameters
    ----------
    paths : sequence of JointPath
        From :func:`drystone.metrics.paths.vertical_paths`.

    Returns
    -------
    F_AV : float or None
        100 (v - (H - 1)) / (H - 1) with v the length of a path and H the rows of the joint image,
        averaged over the five shortest paths, or over all when there are fewer; None when there
        is none.

    Examples
    --------
    >>> import numpy as np
    >>> vertical_arrangement([JointPath(np.array([[0, 0], [1, 1], [2, 1]]))])  # doctest: +ELLIPSIS
    20.71...
    """
    return _mean_excess(paths, axis=0)


def horizontal_arrangement(paths: Sequence[JointPath]) -> float | None:
    """Return F_AH in percent, by how much horizontal paths are longer than straight (Eq. 26).

    Lower is better: courses are straight.

    Parameters
    ----------
    paths : sequence of JointPath
        From :func:`drystone.metrics.paths.horizontal_paths`.

    Returns
    -------
    F_AH : float or None
        As :func:`vertical_arrangement`, with the width of the joint image.

    Examples
    --------
    >>> import numpy as np
    >>> horizontal_arrangement([JointPath(np.array([[4, 0], [4, 1], [4, 2]]))])
    0.0
    """
    return _mean_excess(paths, axis=1)


def _mean_excess(paths: Sequence[JointPath], axis: int) -> float | None:
    shortest = sorted(paths, key=lambda path: path.length_px)[:SHORTEST]
    if not shortest:
        return None
    straight = [int(path.pixels[-1, axis] - path.pixels[0, axis]) for path in shortest]
    excess = [path.length_px / steps - 1.0 for path, steps in zip(shortest, straight, strict=True)]
    return 100.0 * math.fsum(excess) / len(excess)
