"""Slow, obvious twins of placement: every position of the image, one after the other (§3.6)."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, signal

from drystone.kernels.raster import Mask
from tests.naive import indices
from tests.naive.overlap import lowered, overlaps
from tests.naive.rays import filling_on_images

OverlapAreas = Callable[[Mask, Mask], NDArray[np.int64]]


def all_positions(occupied, mask):
    rows = range(occupied.shape[0] - mask.shape[0] + 1)
    cols = range(occupied.shape[1] - mask.shape[1] + 1)
    return [(row, col) for row in rows for col in cols]


def resting_positions(occupied, mask):
    """Free, and one pixel lower not free or in the ground (DESIGN 4.4)."""
    return [
        (row, col)
        for row, col in all_positions(occupied, mask)
        if not overlaps(occupied, mask, row, col) and overlaps(occupied, mask, row + 1, col)
    ]


def positions_from_above(occupied, mask, clearance=0):
    """Where a mask comes to rest that is lowered from above (reach="above").

    With a clearance: widened to both sides by it, the mask comes down at least to one own height
    above that place; what is beyond the ends of the site is empty.
    """
    height, width = mask.shape
    wide = np.zeros((height, width + 2 * clearance), bool)
    for shift in range(2 * clearance + 1):
        wide[:, shift : shift + width] |= mask
    beside = np.zeros((occupied.shape[0], clearance), bool)
    scene = np.hstack([beside, occupied, beside])
    # The site is high enough for the widened mask to be lowered from above it.
    sky = np.zeros((2 * height, scene.shape[1]), bool)
    found = []
    for col in range(occupied.shape[1] - width + 1):
        row = lowered(occupied, mask, col)
        if row is None:
            continue
        comes_to = lowered(np.vstack([sky, scene]), wide, col)
        if comes_to is not None and comes_to - 2 * height >= row - height:
            found.append((row, col))
    return sorted(found)


def gap_beside(occupied, mask, at):
    """Empty pixels between a stone and the first thing to its left, row by row."""
    empty = 0
    for i in range(mask.shape[0]):
        col = at[1] + int(np.flatnonzero(mask[i])[0]) - 1
        while col >= 0 and not occupied[at[0] + i, col]:
            empty += 1
            col -= 1
    return empty


def void_below(occupied, mask, at):
    """Empty pixels between a stone and the first thing below it, for a stone open from above."""
    turned = at[1], len(occupied) - at[0] - len(mask)
    return gap_beside(np.rot90(occupied, -1), np.rot90(mask, -1), turned)


def areas_by_convolution(scene, mask):
    """Overlapping pixels at every position of a mask, by convolution of the whole image (§3.6)."""
    stone = mask[::-1, ::-1].astype(np.int64)
    areas = ndimage.convolve(scene.astype(np.int64), stone, mode="constant")
    # The middle of the stone, in an even number of pixels the one before it, is at each pixel.
    top, left = (mask.shape[0] - 1) // 2, (mask.shape[1] - 1) // 2
    rows, cols = scene.shape[0] - mask.shape[0] + 1, scene.shape[1] - mask.shape[1] + 1
    return np.asarray(areas[top : top + max(0, rows), left : left + max(0, cols)])


def areas_by_fft(scene, mask):
    """The same by Fourier transforms; the mask is not larger than the scene."""
    areas = signal.fftconvolve(scene.astype(float), mask[::-1, ::-1].astype(float), mode="valid")
    return np.asarray(np.rint(areas), np.int64)


def resting_by_areas(occupied, mask, areas):
    """`resting_positions` from two maps: of the landscape, and of all of it a row higher."""
    raised = np.vstack([occupied[1:], np.ones((1, occupied.shape[1]), bool)])
    free, rests = areas(occupied, mask) == 0, areas(raised, mask) > 0
    return [(int(row), int(col)) for row, col in np.argwhere(free & rests)]


def eq12(occupied, mask, anchor_x, at, beta):
    """Eq. 12a at one position, on whole images."""
    stone = indices.painted(occupied.shape, mask, *at)
    dice = indices.dice_score(occupied, stone)
    x_c = (at[1] + anchor_x) / occupied.shape[1]
    return filling_on_images(occupied, stone) + (dice if dice > beta else 0.0) - x_c


def best_by_eq12(occupied, mask, anchor_x, positions, beta):
    """The position of the largest merit; equal ones: the lower, then the one further left."""
    ranked = [
        (-round(eq12(occupied, mask, anchor_x, at, beta), 12), -at[0], at[1]) for at in positions
    ]
    if not ranked:
        return None
    _, row, col = min(ranked)
    return -row, col
