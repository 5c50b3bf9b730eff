"""Slow, obvious twins of overlap and of lowering: loops over pixels, and exact arithmetic."""

from fractions import Fraction

import numpy as np

from tests.naive.outline import inside


def overlaps(occupied, mask, row, col):
    """Whether some pixel of the mask meets an occupied one, or leaves the image (§3.6)."""
    height, width = occupied.shape
    for i, j in zip(*np.nonzero(mask), strict=True):
        r, c = row + i, col + j
        if not (0 <= r < height and 0 <= c < width) or occupied[r, c]:
            return True
    return False


def lowered(occupied, mask, col):
    """Row at which a mask comes to rest that is lowered from far above, row by row.

    The site is open at the top; None when the mask comes to rest above it.
    """
    height = mask.shape[0]
    sky = np.zeros((height + 1, occupied.shape[1]), bool)
    scene = np.vstack([sky, occupied])
    row = 0
    while not overlaps(scene, mask, row + 1, col):
        row += 1
    row -= height + 1
    return row if row >= 0 else None


def depth(first, second, pieces):
    """How deep two polygons lie in each other, at least: by exact arithmetic, at some points.

    Looked at are all corners and `pieces` - 1 points between any two for the surfaces, and a grid
    of `pieces` x `pieces` points for the largest circle.
    """
    one, other = (
        [(Fraction(x), Fraction(y)) for x, y in ring.tolist()] for ring in (first, second)
    )
    found = 0.0
    for ring, around in ((one, other), (other, one)):
        for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1], strict=True):
            for k in range(pieces):
                share = Fraction(k, pieces)
                x, y = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
                if inside(around, x, y):
                    found = max(found, _to_boundary(around, x, y))
    low = np.maximum(first.min(axis=0), second.min(axis=0))
    high = np.minimum(first.max(axis=0), second.max(axis=0))
    if (low >= high).any():
        return found
    for i in range(1, pieces):
        for j in range(1, pieces):
            x, y = (Fraction(float(v)) for v in low + (high - low) * np.array([i, j]) / pieces)
            if inside(one, x, y) and inside(other, x, y):
                found = max(found, min(_to_boundary(ring, x, y) for ring in (one, other)))
    return found


def _to_boundary(ring, x, y):
    """Distance to the nearest edge; the square is exact."""
    squares = []
    for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1], strict=True):
        dx, dy = x1 - x0, y1 - y0
        share = min(max(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0), 1)
        squares.append((x - x0 - share * dx) ** 2 + (y - y0 - share * dy) ** 2)
    return float(min(squares)) ** 0.5
