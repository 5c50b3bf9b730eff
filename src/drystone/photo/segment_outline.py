"""Outlines of stones: half way between the colours on both sides."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask
from drystone.photo.segment_ground import Planes

BAND_PX = 4
"""How far an outline may be moved at a time."""

_WINDOW_PX = 11
_LEAST_CONTRAST = 3.0


def refine_outlines(lab: Planes, stone: Mask, usable: Mask, rounds: int = 2) -> Mask:
    """Move outlines to where the colour is half way between stone and ground.

    `stone` is where stones are, about; `usable` what the photograph shows of ground and stones.
    """
    for _ in range(rounds):
        inner = ndimage.distance_transform_edt(stone)
        outer = ndimage.distance_transform_edt(~stone)
        band = (inner <= BAND_PX) & (outer <= BAND_PX) & usable
        here, there = _sides(lab, inner > BAND_PX, (outer > BAND_PX) & usable)
        way = here - there
        contrast = np.sqrt((way**2).sum(axis=-1))
        share = ((lab - there) * way).sum(axis=-1) / np.maximum(contrast, 1e-6) ** 2
        moved = np.where(band & (contrast > _LEAST_CONTRAST), share > 0.5, stone)
        stone = ndimage.median_filter(moved.astype(np.uint8), 5).astype(bool)
    return stone


def contrast_along(lab: Planes, labels: NDArray[np.int32], count: int) -> NDArray[np.float64]:
    """Return the contrast in Lab along the weakest quarter of every outline, 1 ... count."""
    stone = labels > 0
    inner = ndimage.distance_transform_edt(stone)
    outer = ndimage.distance_transform_edt(~stone)
    here, there = _sides(lab, inner > 2, outer > 2)
    contrast = np.sqrt(((here - there) ** 2).sum(axis=-1))
    rim = np.where(inner == 1, labels, 0)
    return np.array(
        [
            float(np.percentile(contrast[rim == number], 25)) if (rim == number).any() else 0.0
            for number in range(1, count + 1)
        ]
    )


def _sides(lab: Planes, inside: Mask, outside: Mask) -> tuple[Planes, Planes]:
    """Return the mean colours nearby of what is inside and of what is outside."""
    sides = []
    for part in (inside, outside):
        weight = _near(part.astype(np.float32))
        colour = [
            _near(np.where(part, lab[..., k], np.float32(0))) / np.maximum(weight, 1e-4)
            for k in range(3)
        ]
        sides.append(np.where((weight > 1e-3)[..., None], np.stack(colour, axis=-1), lab))
    return sides[0], sides[1]


def _near(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the mean nearby; twice a box is nearly a Gaussian, and faster."""
    once = ndimage.uniform_filter(values, _WINDOW_PX)
    return np.asarray(ndimage.uniform_filter(once, _WINDOW_PX))
