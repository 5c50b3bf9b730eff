"""Interlocking of head joints and straightness of bed joints (Eq. 26, Eq. 27)."""

import math
from collections.abc import Sequence

from drystone.kernels.raster import Mask
from drystone.metrics.paths import horizontal_lengths, vertical_lengths

SHORTEST = 5
"""How many of the shortest paths are averaged."""


def vertical_arrangement(joint: Mask) -> float | None:
    """Return F_AV in percent, by how much vertical paths are longer than straight (Eq. 27).

    Higher is better: head joints are interrupted.

    Parameters
    ----------
    joint : (H, W) bool array
        True where a path may run (:func:`drystone.metrics.joints.joint_mask`).

    Returns
    -------
    F_AV : float or None
        100 (v - (H - 1)) / (H - 1) with v the length of a path of
        :func:`drystone.metrics.paths.vertical_paths`, averaged over the five shortest, or over all
        when there are fewer; None when there is none.

    Examples
    --------
    >>> import numpy as np
    >>> vertical_arrangement(np.ones((4, 21), bool))
    0.0
    """
    return mean_excess(vertical_lengths(joint), joint.shape[0] - 1)


def horizontal_arrangement(joint: Mask) -> float | None:
    """Return F_AH in percent, by how much horizontal paths are longer than straight (Eq. 26).

    Lower is better: courses are straight.

    Parameters
    ----------
    joint : (H, W) bool array
        True where a path may run (:func:`drystone.metrics.joints.joint_mask`).

    Returns
    -------
    F_AH : float or None
        As :func:`vertical_arrangement`, with W and
        :func:`drystone.metrics.paths.horizontal_paths`.
    """
    return mean_excess(horizontal_lengths(joint), joint.shape[1] - 1)


def mean_excess(lengths_px: Sequence[float], straight_px: int) -> float | None:
    """Return by how much the shortest of some paths are longer than straight, in percent.

    Parameters
    ----------
    lengths_px : sequence of float
        The shortest first; the first :data:`SHORTEST` count.
    straight_px : int
        Length of the straight line from start to end.

    Examples
    --------
    >>> mean_excess([10.0, 15.0], 10)
    25.0
    """
    shortest = lengths_px[:SHORTEST]
    if not shortest:
        return None
    return 100.0 * math.fsum(length / straight_px - 1.0 for length in shortest) / len(shortest)
