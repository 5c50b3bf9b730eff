"""Binary masks: which pictures are masks, and their stones (DESIGN 4.1)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.io.checks import blended
from drystone.io.file_errors import unfit
from drystone.io.labels import Census, IdImage, take_census
from drystone.kernels.raster import Mask

_USUAL_STONE_VALUES = (1, 255, 65535, 2**32 - 1)
_WHOLE = np.ones((3, 3), bool)
_LOST = 0.2
"""Largest share of plain areas that a mask may lose: of ids 1 to 30 it is about a half."""
_NOISE = 1 / 16
"""Of the way from the background to the stones: what JPEG makes of a plain background."""


@dataclass(frozen=True, eq=False)
class BinaryMask:
    """A picture read as stone and background."""

    mask: Mask  # (h, w), True where there is stone
    background: int  # this and the next: the two values of the picture
    stone: int
    between_px: int  # pixels with values between them (anti-aliasing), given to the nearer one


def find_mask(
    image: IdImage, ids: Census, wanted: bool | None, *, lossy: bool = False
) -> BinaryMask | None:
    """Read a picture as a binary mask if it is one; ids that are to be read as one are refused.

    `ids` is the census of the ids, of at least two values.  `wanted` forces a mask, or forbids it;
    None decides: two values, one of them the background, are a mask, and so is a picture of two
    values and blended edges.  Compression (`lossy`) left noise in the background.
    """
    if wanted is False:
        return None
    if len(ids.values) == 2 and (wanted or image.background in ids.values):
        binary = _split(ids, image.background)
        return binary if wanted or not _is_one_id(binary) else None
    if image.brightness is None:
        grey = ids
    elif wanted or image.nearly_grey:
        grey = take_census(image.brightness)
    else:
        return None
    if len(grey.values) > 1 and wanted:
        binary = _split(grey, image.background)
        _check_lost(_lost(grey, binary, _NOISE if lossy else 0.0), binary)
        return binary
    if len(grey.values) > 1 and _is_antialiased(grey, image.background):
        return _split(grey, image.background)
    return None


def _check_lost(lost: float, binary: BinaryMask) -> None:
    """Refuse ids that are to be read as a mask (E118): many stones would be background."""
    if lost > _LOST:
        raise unfit(
            f"{lost:.0%} of its plain areas are neither background "
            f"({binary.background}) nor near to stone ({binary.stone}), and would be lost.",
            "If the values are ids, leave --mask (mask=True in Python) out, and export them "
            "as PNG where they are in a JPEG.",
        )


def _lost(census: Census, binary: BinaryMask, noise: float) -> float:
    """Return how much of the plain areas off the background is taken for background.

    Blurred edges of a mask have values between, too, but they are not plain.
    """
    low = binary.background
    share = np.abs(census.values - low) / abs(binary.stone - low)
    off = census.pixels(share > noise) & census.solid
    between = census.pixels((share > noise) & (2 * share < 1)) & census.solid
    return float(between.sum()) / max(1, int(off.sum()))


def components(mask: Mask) -> tuple[NDArray[np.int32], int]:
    """Label the 8-connected components of a mask, from 1 in row order."""
    found, count = ndimage.label(mask, _WHOLE)
    return np.asarray(found, np.int32), int(count)


def _split(census: Census, background: int) -> BinaryMask:
    """Give every value to the nearer end of the range, halves to the stones."""
    low, high = int(census.values[0]), int(census.values[-1])
    if abs(low - background) > abs(high - background):
        low, high = high, low
    stone = 2 * np.abs(census.values - low) >= abs(high - low)
    ends = census.counts[0] + census.counts[-1]
    return BinaryMask(census.pixels(stone), low, high, int(census.index.size - ends))


def _is_one_id(binary: BinaryMask) -> bool:
    """Tell a label image of a single stone (0 and 300, in one piece) from a mask."""
    if binary.stone in _USUAL_STONE_VALUES or binary.stone == 0:
        return False
    found, count = components(binary.mask)
    areas = np.sort(np.bincount(found.ravel())[1:])
    return count == 1 or int(areas[:-1].sum()) < 0.02 * int(areas.sum())


def _is_antialiased(census: Census, background: int) -> bool:
    """Tell a mask with grey edges: all other values lie between two plain ones, at edges."""
    if len(census.values) < 3:
        return False
    ends = np.zeros(len(census.values), bool)
    ends[[0, -1]] = True
    most = set(np.argsort(census.counts)[-2:].tolist())
    if most != {0, len(ends) - 1} or background not in census.values[ends]:
        return False
    between: NDArray[Any] = census.pixels(~ends)
    at_edge = blended(census, between)
    plain = census.solid[between]
    return bool(at_edge.mean() >= 0.8 and at_edge[plain].all())
