"""Slow twins of drystone.kernels.outline."""

from fractions import Fraction


def centre_inside(corners: list[tuple[int, int]], col: int, row: int) -> bool | None:
    """Say whether the centre of a pixel is inside a polygon; None when it is on the edge.

    Counts crossings of the ray to the left, in exact arithmetic.
    """
    x, y = Fraction(2 * col + 1, 2), Fraction(2 * row + 1, 2)
    crossings = 0
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        if min(y0, y1) < y < max(y0, y1):
            at = x0 + (y - y0) * (x1 - x0) / (y1 - y0)
            if at == x:
                return None
            crossings += at < x
    return crossings % 2 == 1


def inside_by_floats(corners: list[list[float]], x: float, y: float) -> bool:
    """Say whether a point is inside any polygon, even one that crosses itself: even-odd rule."""
    inside = False
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        if min(y0, y1) <= y < max(y0, y1) and x0 + (y - y0) * (x1 - x0) / (y1 - y0) <= x:
            inside = not inside
    return inside
