"""Slow, obvious twins of rasterising: exact clipping of polygons."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity

from drystone.kernels.raster import Mask


def polygon_of(mask: Mask) -> shapely.Geometry:
    """The pixel squares of a mask, y up from its bottom-left corner."""
    height = mask.shape[0]
    squares = [
        shapely.box(col, height - row - 1, col + 1, height - row)
        for row, col in zip(*np.nonzero(mask), strict=True)
    ]
    return shapely.union_all(squares)


def coverage(
    mask: Mask,
    centre: tuple[float, float],
    angle_deg: float,
    scale: float,
    phase: tuple[float, float],
    window: tuple[int, int, int, int],
) -> NDArray[np.float64]:
    """Covered share of every pixel of a window (left, bottom, right, top), row 0 at the top."""
    polygon = affinity.translate(polygon_of(mask), -centre[0], -centre[1])
    polygon = affinity.rotate(polygon, angle_deg, origin=(0, 0))
    polygon = affinity.scale(polygon, scale, scale, origin=(0, 0))
    polygon = affinity.translate(polygon, *phase)
    left, bottom, right, top = window
    cells = [
        shapely.box(x, y, x + 1, y + 1)
        for y in range(top - 1, bottom - 1, -1)
        for x in range(left, right)
    ]
    areas = shapely.area(shapely.intersection(np.array(cells), polygon))
    return np.asarray(areas, float).reshape(top - bottom, right - left)


def shape_factor(mask: Mask, angle_deg: float) -> float:
    """Eq. 3: area over that of the axis-aligned bounding box."""
    left, bottom, right, top = affinity.rotate(polygon_of(mask), angle_deg).bounds
    return float(np.count_nonzero(mask) / ((right - left) * (top - bottom)))


def second_moment_eccentricity(mask: Mask) -> float:
    """Focal distance over major axis of the ellipse of equal second moments (§3.4)."""
    rows, cols = np.nonzero(mask)
    # Four quarters of every pixel instead of its own moment: converges to the unit square.
    fine = (np.arange(64) + 0.5) / 64
    x = (cols[:, None, None] + fine[None, :, None] + 0 * fine[None, None, :]).ravel()
    y = (rows[:, None, None] + 0 * fine[None, :, None] + fine[None, None, :]).ravel()
    small, large = np.linalg.eigvalsh(np.cov(x, y, bias=True))
    return float(np.sqrt(1 - small / large))
