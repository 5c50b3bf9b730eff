"""Rasterise a turned, reduced binary mask once, by coverage (paper §3.3; DESIGN 4.2)."""

import math

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]

PHASE_STEPS = 64
"""Sub-pixel positions are multiples of 1/64 px: exact in floats, so a plan can be re-derived."""


def rotation(angle_deg: float) -> tuple[float, float]:
    """Return cosine and sine of an angle in degrees, exact at quarter turns.

    Examples
    --------
    >>> rotation(90.0)
    (0.0, 1.0)
    """
    quarter, rest = divmod(angle_deg, 90.0)
    if rest == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    angle = math.radians(angle_deg)
    return math.cos(angle), math.sin(angle)


def turn(points: NDArray[np.float64], angle_deg: float) -> NDArray[np.float64]:
    """Turn points counter-clockwise about the origin.

    Parameters
    ----------
    points : (n, 2) float array
        x to the right, y up.
    angle_deg : float
        Counter-clockwise angle in degrees.
    """
    cos, sin = rotation(angle_deg)
    turned: NDArray[np.float64] = points @ np.array([[cos, sin], [-sin, cos]])
    return turned


def quantise(value: float) -> float:
    """Round to the nearest multiple of 1/64 px."""
    return math.floor(value * PHASE_STEPS + 0.5) / PHASE_STEPS


def rasterise(
    mask: Mask,
    centre: tuple[float, float],
    angle_deg: float,
    scale: float,
    phase: tuple[float, float],
) -> tuple[Mask, int, int]:
    """Turn a mask about a point, reduce it, and rasterise it once by coverage >= 1/2.

    Parameters
    ----------
    mask : (h, w) bool array
        Row 0 at the top; pixel (row, col) covers x in [col, col+1], y in [h-row-1, h-row].
    centre : (float, float)
        Point (x, y) about which the mask turns, in px from its bottom-left corner.
    angle_deg : float
        Counter-clockwise as seen in the picture.
    scale : float
        Size of the result over the size of the mask.
    phase : (float, float)
        Where the centre falls in the result, in [0, 1) px right of and above a pixel corner.

    Returns
    -------
    turned : (h', w') bool array
        Cropped to its pixels, row 0 at the top.
    left, bottom : int
        Position of its bottom-left corner relative to the pixel corner that `phase` is
        measured from.

    Notes
    -----
    Coverage is counted on k x k sample points a pixel, k = max(4, ceil(1/scale)), so every
    source pixel is seen.  Nothing is resampled twice.

    Examples
    --------
    >>> rasterise(np.ones((2, 4), bool), (2.0, 1.0), 90.0, 1.0, (0.0, 0.0))[0].shape
    (4, 2)
    """
    height, width = mask.shape
    cos, sin = rotation(angle_deg)
    corners = np.array([[0, 0], [width, 0], [width, height], [0, height]], float) - centre
    box = turn(corners, angle_deg) * scale + phase
    x0, y0 = np.floor(box.min(axis=0) + 1e-9).astype(int)
    x1, y1 = np.ceil(box.max(axis=0) - 1e-9).astype(int)
    k = max(4, math.ceil(1.0 / scale - 1e-9))
    # Sample points of the result, from its centre, in source px; then turned back.
    sx = (np.arange((x1 - x0) * k) + 0.5) / k + (x0 - phase[0])
    sy = y1 - (np.arange((y1 - y0) * k) + 0.5) / k - phase[1]
    u, v = sx[None, :] / scale, sy[:, None] / scale
    col = np.floor(cos * u + sin * v + centre[0]).astype(np.intp)
    row = np.floor(height - (cos * v - sin * u + centre[1])).astype(np.intp)
    padded = np.zeros((height + 2, width + 2), bool)
    padded[1:-1, 1:-1] = mask
    hit = padded[np.clip(row + 1, 0, height + 1), np.clip(col + 1, 0, width + 1)]
    covered = hit.reshape(y1 - y0, k, x1 - x0, k).sum(axis=(1, 3), dtype=np.int32)
    turned = 2 * covered >= k * k
    if not turned.any():
        # Thinner than half a pixel everywhere: keep the best covered pixel, a stone never vanishes.
        turned = covered == covered.max()
    rows, cols = np.flatnonzero(turned.any(axis=1)), np.flatnonzero(turned.any(axis=0))
    cropped = turned[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    return np.ascontiguousarray(cropped), int(x0 + cols[0]), int(y1 - rows[-1] - 1)
