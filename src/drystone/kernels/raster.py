"""Rasterise a turned, reduced binary mask once, by coverage (paper §3.3; DESIGN 4.2)."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.backend import compiled

Mask = NDArray[np.bool_]
Floats = NDArray[np.float64]
Pair = tuple[float, float]

PHASE_STEPS = 64
"""Sub-pixel positions are multiples of 1/64 px: exact in floats, so a plan can be re-derived."""

FINEST = 512
"""Samples along a pixel that the compiled kernel can count; NumPy takes more."""

BAND = 1 << 18
"""Samples that NumPy takes at once: a large stone must not need a multiple of its own memory."""

_fast = compiled("raster")


def rotation(angle_deg: float) -> Pair:
    """Return cosine and sine of an angle in degrees; quarter turns only swap them."""
    quarter, rest = divmod(angle_deg, 90.0)
    cos, sin = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    return ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))[int(quarter) % 4]


def wrap_deg(angle_deg: float) -> float:
    """Bring an angle into [-180, 180)."""
    return (angle_deg + 180.0) % 360.0 - 180.0


def turned_boxes(points: Floats, turns: Floats) -> Floats:
    """Return left, bottom, right and top (m, 4) of points (n, 2), turned about the origin.

    Turns (m, 2) are cosines and sines, of :func:`rotation`.
    """
    if _fast is not None:
        boxes: Floats = _fast.turned_boxes(points, turns)
        return boxes
    cos, sin = turns[:, :1], turns[:, 1:]
    x = points[:, 0] * cos - points[:, 1] * sin
    y = points[:, 0] * sin + points[:, 1] * cos
    return np.column_stack([x.min(axis=1), y.min(axis=1), x.max(axis=1), y.max(axis=1)])


def mirrored(pixels: Mask) -> Mask:
    """Return the mirror image about a vertical line."""
    return np.ascontiguousarray(pixels[:, ::-1])


def quantise(value: float) -> float:
    """Round to the nearest multiple of 1/64 px."""
    return math.floor(value * PHASE_STEPS + 0.5) / PHASE_STEPS


def rasterise(
    mask: Mask, centre: Pair, angle_deg: float, scale: float, phase: Pair
) -> tuple[Mask, int, int]:
    """Turn a mask about a point, reduce it, and rasterise it once by coverage >= 1/2.

    Row 0 is at the top; pixel (row, col) covers x in [col, col+1], y in [h-row-1, h-row].  The
    centre is (x, y) from the bottom-left corner of the mask; the angle is counter-clockwise as seen
    in the picture; `phase` is where the centre falls in the result, px right of and above a pixel
    corner. Returns the mask, cropped, and left and bottom of it from that pixel corner.

    Coverage is counted on k x k sample points a pixel, k the power of two from 4 on that is at
    least 1/scale, so every source pixel is seen; of a mask of a pixel or two that falls between the
    points, on more.  Nothing is resampled twice.  A stone neither vanishes nor falls apart at a
    coarse resolution: where a thin neck would break, pixels covered to a quarter are taken, or all
    that are touched.
    """
    return rasterise_to_area(mask, centre, angle_deg, scale, phase, (0.0, math.inf))[:3]


def rasterise_to_area(
    mask: Mask, centre: Pair, angle_deg: float, scale: float, phase: Pair, area: Pair
) -> tuple[Mask, int, int, Pair]:
    """Rasterise a mask where its area comes out right, at one of 16 sub-pixel positions.

    The first is `phase`, multiples of 1/64 px; the others are up to 3/4 px further right, then
    further up.  `area` is what is wanted, px of the result covered to a half, and how far off it
    may be.  The first position within that is taken, else the first of those where the area comes
    nearest; it is returned, too, measured from the same pixel corner.
    """
    way = rotation(angle_deg)
    left, bottom, right, top = _box_px(mask.shape, centre, way, scale, phase)
    corner, size = (left - phase[0], top - phase[1]), (right - left, top - bottom)
    # A power of two: sample points are then exact in floats at every phase.
    k = 1 << max(2, math.ceil(math.log2(1.0 / scale) - 1e-9))
    while True:
        kernel = fitted_numpy if _fast is None or k > FINEST else _fast.fitted
        found = kernel(mask, centre, way, scale, corner, (*size, k), area)
        if found is not None:
            turned, col, row, number = found
            up, aside = divmod(number, 4)
            return turned, left + col, top + 1 - row, (phase[0] + aside / 4, phase[1] + up / 4)
        if not mask.any():
            raise ValueError("the mask has no pixel")
        k *= 2


def _box_px(
    shape: tuple[int, ...], centre: Pair, way: Pair, scale: float, phase: Pair
) -> tuple[int, int, int, int]:
    """Return the pixel corners left, below, right of and above a turned, reduced mask."""
    (height, width), (x, y), (cos, sin) = shape, centre, way
    corners = [(u, v) for u in (-x, width - x) for v in (-y, height - y)]
    across = [(u * cos - v * sin) * scale + phase[0] for u, v in corners]
    upwards = [(u * sin + v * cos) * scale + phase[1] for u, v in corners]
    return (
        math.floor(min(across) + 1e-9),
        math.floor(min(upwards) + 1e-9),
        math.ceil(max(across) - 1e-9),
        math.ceil(max(upwards) - 1e-9),
    )


def fitted_numpy(
    mask: Mask,
    centre: Pair,
    way: Pair,
    scale: float,
    corner: Pair,
    grid: tuple[int, int, int],
    area: Pair,
) -> tuple[Mask, int, int, int] | None:
    """Sample a turned mask, and take its pixels where the area comes out right; None for no hit.

    `way` is cosine and sine, `corner` the top-left pixel corner of the samples, px of the result
    from the centre; `grid` their width and height in px, and samples along a pixel.  Returns the
    mask, cropped, how far its columns start right of the corner, how far its last row ends below a
    line one pixel above the corner, and the position n: n % 4 quarters of a pixel right, n // 4 up.
    """
    counts = _quarter_counts(mask, centre, way, scale, corner, grid)
    full = grid[2] * grid[2]
    best, least = 0, math.inf
    for number in range(16):
        error = abs(float(np.count_nonzero(2 * _covered(counts, number) >= full)) - area[0])
        if error < least:
            best, least = number, error
        if error <= area[1]:
            break
    taken = _in_one_piece(_covered(counts, best), full)
    rows, cols = np.flatnonzero(taken.any(axis=1)), np.flatnonzero(taken.any(axis=0))
    if not rows.size:
        return None
    cropped = taken[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    return np.ascontiguousarray(cropped), int(cols[0]), int(rows[-1]) + 1, best


def _quarter_counts(
    mask: Mask, centre: Pair, way: Pair, scale: float, corner: Pair, grid: tuple[int, int, int]
) -> NDArray[np.int32]:
    """Count the samples that hit, a quarter of a pixel wide and high; a free pixel all around."""
    (height, width), (cos, sin), (cols, rows, k) = mask.shape, way, grid
    side = k // 4
    padded = np.zeros((height + 2, width + 2), bool)
    padded[1:-1, 1:-1] = mask
    counts = np.zeros((4 * (rows + 2), 4 * (cols + 2)), np.int32)
    # Sample points of the result, from its centre, in source px; then turned back.
    u = ((np.arange(cols * k) + 0.5) / k + corner[0]) / scale
    v = (corner[1] - (np.arange(rows * k)[:, None] + 0.5) / k) / scale
    band = max(1, BAND // (cols * k * side)) * side
    for start in range(0, rows * k, band):
        lines = v[start : start + band]
        col = np.floor(cos * u + (sin * lines + centre[0])).astype(np.int32)
        row = np.floor(sin * u + (height - centre[1] - cos * lines)).astype(np.int32)
        np.clip(row, -1, height, out=row)
        np.clip(col, -1, width, out=col)
        hit = padded[row + 1, col + 1].reshape(lines.size // side, side, 4 * cols, side)
        at = 4 + start // side
        counts[at : at + len(hit), 4:-4] = hit.sum(axis=(1, 3))
    return counts


def _covered(counts: NDArray[np.int32], number: int) -> NDArray[np.int32]:
    """Return how many samples of each pixel hit at a sub-pixel position."""
    up, right = divmod(number, 4)
    rows, cols = counts.shape[0] // 4 - 1, counts.shape[1] // 4 - 1
    # A mask further right and up is a grid of pixels further left and down on the same samples.
    view = counts[up : up + 4 * rows, 4 - right : 4 - right + 4 * cols]
    lines = view.reshape(rows, 4, 4 * cols).sum(axis=1, dtype=np.int32)
    return np.asarray(lines.reshape(rows, cols, 4).sum(axis=2, dtype=np.int32))


def _in_one_piece(covered: NDArray[np.int32], full: int) -> Mask:
    """Return the pixels covered to a half, or to less where a thin neck would break otherwise."""
    for share in (2, 4):
        taken = share * covered >= full
        if ndimage.label(taken, np.ones((3, 3)))[1] == 1:
            return taken
    return np.asarray(covered > 0)
