"""How large a stone is, as a person with a rule would say: the one measure of all that is told."""

from collections.abc import Iterable
from dataclasses import dataclass
from statistics import median

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask


@dataclass(frozen=True)
class StoneSize:
    """Size of a stone."""

    id: int
    at_px: tuple[float, float]  # its middle, column and row
    # longer and shorter side of the smallest rectangle around it, turned in any way
    length_px: float
    width_px: float
    area_px: int


def sizes_of(labels: NDArray[np.uint16]) -> tuple[StoneSize, ...]:
    """Return the sizes of the stones of a label image, in the order of their numbers."""
    sizes = []
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        if box is None:
            continue
        mask = labels[box] == number
        rows, cols = np.nonzero(mask)
        x, y = float(cols.mean()) + box[1].start + 0.5, float(rows.mean()) + box[0].start + 0.5
        sizes.append(StoneSize(number, (x, y), *sides_px(mask), len(rows)))
    return tuple(sizes)


def sides_px(mask: Mask) -> tuple[float, float]:
    """Return the longer and the shorter side of the smallest rectangle around a stone."""
    rows = np.flatnonzero(mask.any(axis=1))
    # The ends of the rows have all corners of the stone.
    first = mask[rows].argmax(axis=1)
    last = mask.shape[1] - 1 - mask[rows, ::-1].argmax(axis=1)
    ends = np.concatenate([np.column_stack([first, rows]), np.column_stack([last, rows])])
    corners = shapely.get_coordinates(shapely.oriented_envelope(shapely.MultiPoint(ends)))
    # One px is a point, a row of them a line: they have fewer sides.
    sides = np.hypot(*np.diff(corners, axis=0)[:2].T).tolist()
    shorter, longer = sorted([0.0, 0.0, *sides])[-2:]
    # From the middles of px to their borders.
    return round(longer + 1.0, 6), round(shorter + 1.0, 6)


def median_sides(sides: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Return the median of the longer and that of the shorter sides of one stone or more."""
    longer, shorter = zip(*sides, strict=True)
    return median(longer), median(shorter)
