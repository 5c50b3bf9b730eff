"""Touching stones: cut apart at their necks."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.feature import peak_local_max
from skimage.segmentation import watershed

from drystone.kernels.raster import Mask
from drystone.photo.segment_ground import Planes, SegmentSettings

Labels = NDArray[np.int32]

_OTHER_COLOUR = 14.0
"""Distance in CIELAB of stones that are of different rock."""


@dataclass(frozen=True)
class Neck:
    """A narrow place between two thicker parts of a piece."""

    at_px: tuple[float, float]  # its middle, column and row
    width_px: float
    share: float  # its width over the thickness of the thinner part
    cut: bool  # whether the parts became two stones


def split_stones(
    stone: Mask, lab: Planes, settings: SegmentSettings
) -> tuple[Labels, tuple[Neck, ...]]:
    """Label stones, and cut pieces apart at narrow necks.

    The watershed of the distance to the ground gives the parts of a piece; two neighbours stay
    one stone unless the line between them is short beside the thickness of both.

    Neighbours of different colours may have a wider neck between them.  The necks are those that
    were cut, and those in doubt.
    """
    pieces, _ = ndimage.label(stone, np.ones((3, 3)))
    labels = np.zeros(stone.shape, np.int32)
    necks: list[Neck] = []
    number = 0
    for piece, box in enumerate(ndimage.find_objects(pieces), start=1):
        parts, found = _parts(pieces[box] == piece, lab[box], settings)
        for neck in found:
            column, row = neck.at_px
            at_px = (column + box[1].start, row + box[0].start)
            necks.append(replace(neck, at_px=at_px))
        labels[box] += np.where(parts > 0, parts + number, 0).astype(np.int32)
        number += int(parts.max())
    return labels, tuple(necks)


def _parts(piece: Mask, lab: Planes, settings: SegmentSettings) -> tuple[Labels, list[Neck]]:
    """Return the stones of one piece, and its necks."""
    depth = ndimage.distance_transform_edt(np.pad(piece, 1))[1:-1, 1:-1]
    smooth = ndimage.gaussian_filter(depth, 1.0)
    least = max(2.0, 0.2 * float(depth.max()))
    peaks = peak_local_max(
        smooth, min_distance=max(2, int(0.25 * depth.max())), threshold_abs=least,
        labels=piece.astype(np.int32), exclude_border=False,
    )  # fmt: skip
    if len(peaks) < 2:
        return piece.astype(np.int32), []
    seeds = np.zeros(piece.shape, np.int32)
    seeds[tuple(peaks.T)] = np.arange(1, len(peaks) + 1)
    basins = watershed(-smooth, seeds, mask=piece).astype(np.int32)
    return _joined(basins, depth, lab, settings)


def _joined(
    basins: Labels, depth: NDArray[np.float64], lab: Planes, settings: SegmentSettings
) -> tuple[Labels, list[Neck]]:
    """Join basins across wide necks, the widest first; return stones and necks."""
    necks: list[Neck] = []

    def narrow(pair: tuple[int, int], neck: Neck) -> bool:
        below = settings.split_below
        if below <= neck.share < settings.other_colour_below:
            one, other = (np.median(lab[(basins == k) & (depth > 2)], axis=0) for k in pair)
            apart = float(np.hypot.reduce(one - other)) > _OTHER_COLOUR
            below = settings.other_colour_below if apart else below
        return settings.split and neck.share < below

    while True:
        thick = ndimage.maximum(depth, basins, np.arange(basins.max() + 1))
        measured = {}
        for pair, line in _lines(basins).items():
            # The line of a watershed wanders; the ground is as near on both sides as the neck is
            # wide.
            width = max(1.0, 2 * float(depth[tuple(line.T)].max()))
            row, column = line.mean(axis=0).tolist()
            thickness = max(2 * float(min(thick[pair[0]], thick[pair[1]])), 1e-9)
            measured[pair] = Neck((column, row), width, width / thickness, False)
        kept = {pair: neck for pair, neck in measured.items() if narrow(pair, neck)}
        joined = [pair for pair in measured if pair not in kept]
        if not joined:
            break
        pair = max(joined, key=lambda key: measured[key].share)
        if measured[pair].share < settings.doubt_below:
            necks.append(measured[pair])
        basins[basins == pair[1]] = pair[0]
    necks += [replace(neck, cut=True) for neck in kept.values()]
    values = np.unique(basins)
    renumbered = np.searchsorted(values, basins) + (0 if values[0] == 0 else 1)
    return renumbered.astype(np.int32), necks


def _lines(basins: Labels) -> dict[tuple[int, int], NDArray[np.intp]]:
    """Return the px (n, 2) along the line between any two neighbours."""
    found: dict[tuple[int, int], list[NDArray[np.intp]]] = {}
    for axis in (0, 1):
        one = np.moveaxis(basins, axis, 0)[:-1]
        other = np.moveaxis(basins, axis, 0)[1:]
        where = np.argwhere((one != other) & (one > 0) & (other > 0))
        low = np.minimum(one[tuple(where.T)], other[tuple(where.T)])
        high = np.maximum(one[tuple(where.T)], other[tuple(where.T)])
        where = where[:, ::-1] if axis else where
        for pair in np.unique(np.stack([low, high], axis=-1), axis=0):
            at = where[(low == pair[0]) & (high == pair[1])]
            found.setdefault((int(pair[0]), int(pair[1])), []).append(at)
    return {pair: np.concatenate(parts) for pair, parts in found.items()}
