"""The joints of a wall, the shortest paths along them, and what these say (§5.2, Fig. 17)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.paths import row_lengths, row_ways, step_counts
from drystone.kernels.raster import Mask
from drystone.model.wall import Labels

PAD_TOP, PAD_BOTTOM, PAD_LEFT, PAD_RIGHT = 1, 2, 1, 2
"""Open rows and columns around the wall, px: paths may run along its outside."""

FIRST_PX = 10
"""Distance of the first start from the end of the joint image; no start is nearer to the other."""

STARTS = 10
"""The side is divided by this to find the distance between two starts."""

SHORTEST = 5
"""How many of the shortest paths are averaged."""


def joint_mask(labels: Labels) -> Mask:
    """Return where a path may run: everything that is not the inside of a stone.

    Every stone is eroded once by a 3 x 3 square, so stones that touch have a joint of 2 px.  The
    edge of the image erodes nothing.  The result, (h + 3, w + 3), is padded by :data:`PAD_TOP` and
    the other three with open joint: pixel (row, col) of the wall is pixel (row + 1, col + 1) of it.
    """
    height, width = labels.shape
    # Repeating the edge gives an outer pixel neighbours of its own stone.
    around = np.pad(labels, 1, mode="edge")
    inside = labels > 0
    for row in range(3):
        for col in range(3):
            inside &= around[row : row + height, col : col + width] == labels
    pad = ((PAD_TOP, PAD_BOTTOM), (PAD_LEFT, PAD_RIGHT))
    return np.pad(~inside, pad, constant_values=True)


def vertical_arrangement(joint: Mask) -> float | None:
    """Return F_AV in percent, by how much vertical paths are longer than straight (Eq. 27).

    100 (v - (H - 1)) / (H - 1) with H the height of the joint image, (H, W), and v the length of a
    path of :func:`vertical_paths`, averaged over the five shortest, or over all when there are
    fewer; None when there is none.  Higher is better: head joints are interrupted.
    """
    return horizontal_arrangement(joint.T)


def horizontal_arrangement(joint: Mask) -> float | None:
    """Return F_AH in percent, by how much horizontal paths are longer than straight (Eq. 26).

    Lower is better: courses are straight.  As :func:`vertical_arrangement`, with W and
    :func:`horizontal_paths`.
    """
    return mean_excess(horizontal_lengths(joint)[:SHORTEST], joint.shape[1] - 1)


def mean_excess(lengths_px: Sequence[float], straight_px: int) -> float | None:
    """Return by how much paths are longer than a straight line, in percent; None without any."""
    if not lengths_px:
        return None
    return 100.0 * math.fsum(length / straight_px - 1.0 for length in lengths_px) / len(lengths_px)


@dataclass(frozen=True, eq=False)
class JointPath:
    """One shortest path along the joints."""

    # (n, 2), row and column of its pixels in the joint image, from start to end.
    pixels: NDArray[np.intp]

    @property
    def length_px(self) -> float:
        """Length over pixel centres: 1 for a straight step, sqrt 2 for a diagonal one."""
        steps = np.abs(np.diff(self.pixels, axis=0)).sum(axis=1)
        return length_px(int((steps == 1).sum()), int((steps == 2).sum()))


def horizontal_lengths(joint: Mask) -> tuple[float, ...]:
    """Return the lengths of :func:`horizontal_paths`, px, the shortest first."""
    lengths = row_lengths(joint, _starts(joint.shape[0])).tolist()
    return tuple(sorted(length_px(*step_counts(length)) for length in lengths if length >= 0))


def vertical_paths(joint: Mask) -> tuple[JointPath, ...]:
    """Find the shortest paths from the top row to the same column of the last row (Fig. 17b).

    Starts are at columns 10, 10 + floor(W / 10), ... < W - 10, with W the width of the joint
    image (:func:`joint_mask`), its padding included.  The shortest comes
    first, of equal ones the left one; starts without a path are left out.
    """
    return tuple(JointPath(path.pixels[:, ::-1]) for path in horizontal_paths(joint.T))


def horizontal_paths(joint: Mask) -> tuple[JointPath, ...]:
    """Find the shortest paths from the left column to the same row of the last one (Fig. 17a).

    Starts are at rows 10, 10 + floor(H / 10), ... < H - 10, with H the height of the joint image.
    """
    ways = row_ways(joint, _starts(joint.shape[0]))
    paths = [JointPath(way) for way in ways if way is not None]
    return tuple(sorted(paths, key=lambda path: path.length_px))


def _starts(side_px: int) -> NDArray[np.intp]:
    return np.arange(FIRST_PX, side_px - FIRST_PX, max(1, side_px // STARTS))


def length_px(straight: int, diagonal: int) -> float:
    """Return the length of a path of so many straight and diagonal steps, px."""
    # Counted, not summed up, so that paths of equal length are equal to the last bit.
    return float(straight + math.sqrt(2) * diagonal)
