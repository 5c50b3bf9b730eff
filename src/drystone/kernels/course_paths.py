"""How straight bed joints run along a planned wall, and how straight head joints go up it.

The twin of `compiled/course_paths.pyx`; what DESIGN 5 measures on pixels, told from the ends of
joints alone.  Lengths in units (:mod:`drystone.kernels.course_types`).
"""

from typing import Final

import numpy as np

from drystone.kernels.course_types import PIXEL_UNITS, Ints

FIRST_PX: Final = 10
"""Distance of the first start from the end, px."""

STARTS: Final = 10
"""The side is divided by this to find the distance between two starts; there are no more."""

SHORTEST: Final = 5
"""How many of the shortest paths are averaged."""

PADDING_PX: Final = 3
"""Open rows and columns around the wall, px; one of them comes first."""

DIAGONAL: Final = 424
"""What a step up or down adds to a path, over 1024."""

Joints = list[tuple[int, int]]
Bed = tuple[int, int, int]


def path_starts(side: int) -> list[int]:
    """Return where paths across a side start, from its first end.

    Examples
    --------
    >>> path_starts(100 * PIXEL_UNITS)[:2]
    [304, 624]
    """
    side_px = (side + PIXEL_UNITS - 1) // PIXEL_UNITS + PADDING_PX
    starts = range(FIRST_PX, side_px - FIRST_PX, max(1, side_px // STARTS))
    return [px * PIXEL_UNITS - PIXEL_UNITS // 2 for px in starts]


def apart(one: tuple[int, int], other: tuple[int, int]) -> int:
    """Return how far two stretches are apart, 0 when they overlap."""
    return max(0, one[0] - other[1], other[0] - one[1])


def ways_up(joints: Joints, below: Joints, ways: Ints, starts: list[int]) -> Ints:
    """Return how far paths from the bottom to joints go aside.

    Parameters
    ----------
    joints, below : list of (int, int)
        Of a course and of that below it.
    ways : (len(below), STARTS) int32 array
        How far paths to the joints below go aside.
    starts : list of int
        Where they start.

    Returns
    -------
    ways : (len(joints), STARTS) int32 array
        Zeros beyond the starts.
    """
    found = np.zeros((len(joints), STARTS), np.int32)
    for j, joint in enumerate(joints):
        if below:
            aside = np.array([apart(joint, other) for other in below], np.int32)
            found[j, : len(starts)] = (ways[:, : len(starts)] + aside[:, np.newaxis]).min(axis=0)
        else:
            found[j, : len(starts)] = [apart(joint, (start, start)) for start in starts]
    return found


def crossing_percent(joints: Joints, ways: Ints, starts: list[int], top: int) -> float:
    """Return F_AV of a wall, in percent, as far as head joints tell.

    Parameters
    ----------
    joints, ways, starts
        Of the last course, as of :func:`ways_up`.
    top : int
        Height of the wall.
    """
    lengths = [
        min(int(ways[j, s]) + apart(joint, (start, start)) for j, joint in enumerate(joints))
        for s, start in enumerate(starts)
    ]
    return mean_percent(lengths, top + 2 * PIXEL_UNITS)


def bed_percent(beds: list[Bed], top: int, width: int) -> float:
    """Return F_AH of a wall, in percent, as far as bed joints tell.

    Parameters
    ----------
    beds : list of (int, int, int)
        Heights at the left and right ends, and ups and downs, of all bed joints.
    top, width : int
        Height and width of the wall.
    """
    above = top + PIXEL_UNITS // 2
    lines = [*beds, (-PIXEL_UNITS // 2, -PIXEL_UNITS // 2, 0), (above, above, 0)]
    lengths = []
    for start in path_starts(top):
        y = top - start
        ways = [abs(y - a) + abs(y - b) + ((DIAGONAL * ups) >> 10) for a, b, ups in lines]
        lengths.append(min(ways))
    return mean_percent(lengths, width + 2 * PIXEL_UNITS)


def mean_percent(lengths: list[int], straight: int) -> float:
    """Return the mean of the shortest lengths over what is straight, in percent; 0 for none."""
    shortest = sorted(lengths)[:SHORTEST]
    if not shortest:
        return 0.0
    return 100.0 * float(sum(shortest)) / (float(len(shortest)) * float(straight))
