"""Rasterise a turned, reduced binary mask once, by coverage (paper §3.3; DESIGN 4.2)."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

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
    Coverage is counted on k x k sample points a pixel, k the power of two from 4 on that is at
    least 1/scale, so every source pixel is seen.  Nothing is resampled twice.

    Examples
    --------
    >>> rasterise(np.ones((2, 4), bool), (2.0, 1.0), 90.0, 1.0, (0.0, 0.0))[0].shape
    (4, 2)
    """
    hit, k, x0, y1 = _sampled(mask, centre, angle_deg, scale, phase)
    turned = _in_one_piece(_counted(hit, k), k * k)
    rows, cols = np.flatnonzero(turned.any(axis=1)), np.flatnonzero(turned.any(axis=0))
    cropped = turned[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    return np.ascontiguousarray(cropped), x0 + int(cols[0]), y1 - int(rows[-1]) - 1


def areas_by_phase(
    mask: Mask,
    centre: tuple[float, float],
    angle_deg: float,
    scale: float,
    phase: tuple[float, float],
) -> Iterator[int]:
    """Yield the area of the rasterised mask at 16 sub-pixel positions, from one sampling.

    Parameters
    ----------
    mask, centre, angle_deg, scale, phase
        As for :func:`rasterise`.

    Yields
    ------
    area : int
        Number of pixels covered to a half; the n-th with the phase (n % 4)/4 px further right and
        (n // 4)/4 px further up.
    """
    hit, k, _, _ = _sampled(mask, centre, angle_deg, scale, phase)
    # A phase further right and up is a grid of pixels further left and down on the same samples.
    hit = np.pad(hit, k)
    height, width = hit.shape[0] // k - 1, hit.shape[1] // k - 1
    for number in range(16):
        top, left = number // 4 * k // 4, k - number % 4 * k // 4
        view = hit[top : top + height * k, left : left + width * k]
        yield int(np.count_nonzero(2 * _counted(view, k) >= k * k))


def _sampled(
    mask: Mask,
    centre: tuple[float, float],
    angle_deg: float,
    scale: float,
    phase: tuple[float, float],
) -> tuple[Mask, int, int, int]:
    """Sample a turned mask on k x k points a pixel.

    Returns
    -------
    hit : (n k, m k) bool array
        The samples.
    k, left, top : int
        Samples a pixel, and the top-left pixel corner of the samples relative to the corner that
        the phase is measured from.
    """
    height, width = mask.shape
    cos, sin = rotation(angle_deg)
    corners = np.array([[0, 0], [width, 0], [width, height], [0, height]], float) - centre
    box = turn(corners, angle_deg) * scale + phase
    x0, y0 = np.floor(box.min(axis=0) + 1e-9).astype(int).tolist()
    x1, y1 = np.ceil(box.max(axis=0) - 1e-9).astype(int).tolist()
    # A power of two: sample points are then exact in floats at every phase.
    k = max(4, 1 << math.ceil(math.log2(1.0 / scale) - 1e-9))
    # Sample points of the result, from its centre, in source px; then turned back.
    sx = (np.arange((x1 - x0) * k) + 0.5) / k + (x0 - phase[0])
    sy = y1 - (np.arange((y1 - y0) * k) + 0.5) / k - phase[1]
    u, v = sx[None, :] / scale, sy[:, None] / scale
    col = np.floor(cos * u + (sin * v + centre[0])).astype(np.int32)
    row = np.floor(sin * u + (height - centre[1] - cos * v)).astype(np.int32)
    padded = np.zeros((height + 2, width + 2), bool)
    padded[1:-1, 1:-1] = mask
    np.clip(row, -1, height, out=row)
    np.clip(col, -1, width, out=col)
    return padded[row + 1, col + 1], k, x0, y1


def _counted(hit: Mask, k: int) -> NDArray[np.int64]:
    """Return how many of the k x k samples of each pixel are hit."""
    height, width = hit.shape[0] // k, hit.shape[1] // k
    rows = hit.reshape(height, k, width * k).sum(axis=1, dtype=np.int64)
    return np.asarray(rows.reshape(height, width, k).sum(axis=2))


def _in_one_piece(covered: NDArray[np.int64], full: int) -> Mask:
    """Return the pixels covered to a half, or to less where a thin neck would break otherwise.

    A stone neither vanishes nor falls apart at a coarse resolution.
    """
    for share in (2, 4):
        turned = share * covered >= full
        if ndimage.label(turned, np.ones((3, 3)))[1] == 1:
            return turned
    return np.asarray(covered > 0)
