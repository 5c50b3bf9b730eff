"""Generated walls of any number of stones, for timing."""

from math import ceil, sqrt

import numpy as np
from scipy.spatial import cKDTree

from drystone.model.wall import Labels

ASPECT = 1.5
"""Number of stones along the wall over the number of its courses."""

SPARE = 1.3
"""Walls have so many times the stones that are asked for: some fall, some are candidates."""

STONE_PX = (24, 16)
"""Mean width and height of a stone."""

JITTER = 0.3
"""Irregular stones: how far their centres leave a running bond, in stones."""


def coursed_labels(rng: np.random.Generator, count: int) -> Labels:
    """Courses of random heights, of stones of random lengths.

    Parameters
    ----------
    rng : numpy.random.Generator
        Draws heights and lengths.
    count : int
        Number of stones at least.

    Examples
    --------
    >>> int(coursed_labels(np.random.default_rng(0), 10).max()) >= 10
    True
    """
    along, courses = _size(count)
    width, height = STONE_PX
    heights = rng.integers(height - 4, height + 5, courses)
    length = along * width
    labels = np.zeros((int(heights.sum()), length), np.uint32)
    bottom, number = len(labels), 0
    for tall in heights.tolist():
        left = 0
        while left < length:
            right = min(left + int(rng.integers(width - 8, width + 9)), length)
            if length - right < width - 8:
                right = length
            number += 1
            labels[bottom - tall : bottom, left:right] = number
            left = right
        bottom -= tall
    return labels


def irregular_labels(rng: np.random.Generator, count: int) -> Labels:
    """Cells nearest to the jittered centres of a running bond: every joint is tilted.

    Parameters
    ----------
    rng : numpy.random.Generator
        Jitters.
    count : int
        Number of stones at least.

    Examples
    --------
    >>> int(irregular_labels(np.random.default_rng(0), 10).max()) >= 10
    True
    """
    along, courses = _size(count)
    width, height = STONE_PX
    row, col = (part.ravel() for part in np.mgrid[:courses, :along])
    centres = np.column_stack((row + 0.5, col + 0.25 + 0.5 * (row % 2)))
    centres += rng.uniform(-JITTER, JITTER, centres.shape)
    pixels = np.mgrid[: courses * height, : along * width].reshape(2, -1).T + 0.5
    # Distances in stones, so that they are wider than high.
    _, nearest = cKDTree(centres).query(pixels / (height, width))
    labels: Labels = np.asarray(nearest + 1, np.uint32).reshape(courses * height, along * width)
    return labels


def _size(count: int) -> tuple[int, int]:
    """Return the numbers of stones along and of courses."""
    along = ceil(sqrt(SPARE * count * ASPECT)) + 1
    return along, ceil(SPARE * count / along) + 1
