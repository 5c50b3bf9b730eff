"""The paper's way to close the gaps of a traced wall: draw its stones together, dilate (§5.1)."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.model.wall import Labels

MOVES = ((1, -1), (1, 0), (0, -1), (1, 1), (-1, -1), (-1, 0), (0, 1), (-1, 1))
"""Steps of a stone, px down and to the right; the first of equally good ones is taken."""


def drawn_together(labels: Labels) -> Labels:
    """Move stones towards the wall's bottom left corner, nearest first, by whole pixels.

    The paper: "we reposition the stones such that the distance between their centers and the
    bottom left corner is minimized. The manipulation is performed sequentially, prioritizing
    stones with smaller distance to the bottom left corner."  A stone takes the step that brings
    its centre nearest to the corner, and does not overlap another stone or leave the image, as
    long as there is one; every stone is moved once.

    Returns
    -------
    moved : (h, w) array of the same type
        The same stones.

    Examples
    --------
    >>> drawn_together(np.array([[0, 1, 0, 2], [0, 0, 0, 2]])).tolist()
    [[0, 2, 0, 0], [1, 2, 0, 0]]
    """
    moved = labels.copy()
    ids = [int(each) for each in np.unique(labels) if each]
    for block in sorted(ids, key=lambda each: (_distance(*_centre(labels, each), labels), each)):
        pixels = np.argwhere(moved == block)
        moved[tuple(pixels.T)] = 0
        moved[tuple(_nearest(pixels, moved).T)] = block
    return moved


def dilated(labels: Labels) -> Labels:
    """Let every stone grow by one pixel on all sides, diagonals included, into what is empty.

    A pixel that several stones reach goes to the smallest id.

    Examples
    --------
    >>> dilated(np.array([[1, 0, 0, 0, 2]])).tolist()
    [[1, 1, 0, 2, 2]]
    """
    # Of 0 as the largest value the least of a neighbourhood is a stone, where there is one.
    high = int(labels.max(initial=0)) + 1
    values = np.where(labels == 0, high, labels)
    least = ndimage.minimum_filter(values, size=3, mode="nearest")
    return np.where(labels == 0, np.where(least == high, 0, least), labels).astype(labels.dtype)


def _nearest(pixels: NDArray[np.intp], others: Labels) -> NDArray[np.intp]:
    """Return where the pixels of a stone end."""
    row, col = pixels.mean(axis=0)
    while True:
        here = _distance(row, col, others)
        ways = sorted(
            (_distance(row + down, col + aside, others), order)
            for order, (down, aside) in enumerate(MOVES)
        )
        for distance, order in ways:
            step = np.array(MOVES[order])
            if distance < here and _is_free(pixels + step, others):
                pixels = pixels + step
                row, col = row + step[0], col + step[1]
                break
        else:
            return pixels


def _centre(labels: Labels, block: int) -> tuple[float, float]:
    row, col = np.argwhere(labels == block).mean(axis=0)
    return float(row), float(col)


def _distance(row: float, col: float, labels: Labels) -> float:
    """Return how far a place is from the bottom left corner."""
    return float(np.hypot(labels.shape[0] - 0.5 - row, col + 0.5))


def _is_free(pixels: NDArray[np.intp], others: Labels) -> bool:
    if (pixels < 0).any() or (pixels >= others.shape).any():
        return False
    return not others[tuple(pixels.T)].any()
