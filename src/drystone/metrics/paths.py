"""Shortest paths along the joints of a wall (§5.2, Fig. 17)."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from drystone.kernels.raster import Mask

FIRST_PX = 10
"""Distance of the first start from the end of the joint image; no start is nearer to the other."""

STARTS = 10
"""The side is divided by this to find the distance between two starts."""

NO_NODE = -1


@dataclass(frozen=True, eq=False)
class JointPath:
    """One shortest path along the joints.

    Parameters
    ----------
    pixels : (n, 2) int array
        Row and column of its pixels in the joint image, from start to end.
    """

    pixels: NDArray[np.intp]

    @property
    def length_px(self) -> float:
        """Length over pixel centres: 1 for a straight step, sqrt 2 for a diagonal one."""
        steps = np.abs(np.diff(self.pixels, axis=0)).sum(axis=1)
        # Counted, not summed up, so that paths of equal length are equal to the last bit.
        return float(np.count_nonzero(steps == 1) + math.sqrt(2) * np.count_nonzero(steps == 2))


def vertical_paths(joint: Mask) -> tuple[JointPath, ...]:
    """Find the shortest paths from the top row to the same column of the last row (Fig. 17b).

    Starts are at columns 10, 10 + floor(W / 10), ... < W - 10, with W the width of the joint
    image, its padding included.

    Parameters
    ----------
    joint : (h, w) bool array
        True where a path may run (:func:`drystone.metrics.joints.joint_mask`).

    Returns
    -------
    paths : tuple of JointPath
        The shortest first; of equal ones the left one first.  Starts without a path are left out.

    Examples
    --------
    >>> [path.length_px for path in vertical_paths(np.ones((4, 21), bool))]
    [3.0]
    """
    node, graph = _joint_graph(joint)
    width = joint.shape[1]
    paths = []
    for column in range(FIRST_PX, width - FIRST_PX, max(1, width // STARTS)):
        start, end = int(node[0, column]), int(node[-1, column])
        if NO_NODE not in (start, end):
            before = dijkstra(graph, indices=start, return_predecessors=True)[1]
            trail = _trail(before, start, end)
            if trail is not None:
                paths.append(trail)
    positions = np.argwhere(joint)
    found = (JointPath(positions[trail]) for trail in paths)
    return tuple(sorted(found, key=lambda path: path.length_px))


def horizontal_paths(joint: Mask) -> tuple[JointPath, ...]:
    """Find the shortest paths from the left column to the same row of the last one (Fig. 17a).

    Starts are at rows 10, 10 + floor(H / 10), ... < H - 10, with H the height of the joint image.

    Parameters
    ----------
    joint : (h, w) bool array
        True where a path may run (:func:`drystone.metrics.joints.joint_mask`).

    Returns
    -------
    paths : tuple of JointPath
        The shortest first; of equal ones the upper one first.

    Examples
    --------
    >>> [path.length_px for path in horizontal_paths(np.ones((21, 4), bool))]
    [3.0]
    """
    turned = vertical_paths(np.ascontiguousarray(joint.T))
    return tuple(JointPath(path.pixels[:, ::-1]) for path in turned)


def _joint_graph(joint: Mask) -> tuple[NDArray[np.int32], csr_array]:
    """Return the number of each joint pixel and the steps between neighbours."""
    height, width = joint.shape
    count = int(np.count_nonzero(joint))
    node = np.full(joint.shape, NO_NODE, np.int32)
    node[joint] = np.arange(count)
    starts, ends, lengths = [], [], []
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = node[: height - down, max(0, -right) : width - max(0, right)]
        there = node[down:, max(0, right) : width - max(0, -right)]
        both = (here != NO_NODE) & (there != NO_NODE)
        starts += [here[both], there[both]]
        ends += [there[both], here[both]]
        lengths.append(np.full(2 * np.count_nonzero(both), math.hypot(down, right)))
    steps = (np.concatenate(starts), np.concatenate(ends))
    return node, csr_array((np.concatenate(lengths), steps), shape=(count, count))


def _trail(before: NDArray[np.int32], start: int, end: int) -> list[int] | None:
    """Follow predecessors from the end back to the start; None when they do not lead there."""
    trail = [end]
    while trail[-1] != start:
        previous = int(before[trail[-1]])
        if previous < 0:
            return None
        trail.append(previous)
    return trail[::-1]
