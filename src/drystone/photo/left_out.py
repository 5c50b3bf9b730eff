"""What differs from the ground in a photograph and was not taken for a stone: where, and why."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask

EDGE = "at the edge of the photograph or cut by it"
PAPER = "beside a marker, which may be its paper"
SMALL = "too small (--min-area)"
SHADOW = "has the colour of shaded ground"
FAINT = "hardly differs from the ground"
THIN = "too thin"

_BESIDE_PX = 4
"""How far from a stone its blurred rim reaches, which is no shape of its own."""


@dataclass(frozen=True)
class LeftOut:
    """A shape that was not taken for a stone."""

    at_px: tuple[float, float]  # its middle, column and row
    area_px: int
    why: str

    @property
    def text(self) -> str:
        """What a notice says of it."""
        column, row = self.at_px
        return f"{self.area_px} px at ({column:.0f}, {row:.0f}), {self.why}"


def shapes(mask: NDArray[np.integer] | Mask, why: str) -> tuple[LeftOut, ...]:
    """Return the shapes of labels, or the pieces of a mask, the largest first."""
    labels = ndimage.label(mask)[0] if mask.dtype == bool else mask
    areas = np.bincount(labels.ravel())
    numbers = [int(k) for k in np.flatnonzero(areas) if k]
    middles = ndimage.center_of_mass(labels > 0, labels, numbers) if numbers else []
    found = [
        LeftOut((float(x) + 0.5, float(y) + 0.5), int(areas[k]), why)
        for k, (y, x) in zip(numbers, middles, strict=True)
    ]
    return tuple(sorted(found, key=lambda one: -one.area_px))


def lost(
    unlike: Mask, known: Mask, causes: Mapping[str, Mask], least_px: float
) -> tuple[LeftOut, ...]:
    """Return what is `unlike` the ground, as large as a stone, and in nothing that is `known`.

    `causes` say for what reason each px was taken away; without one it was too thin.
    """
    rest = unlike & ~ndimage.binary_dilation(known, iterations=_BESIDE_PX)
    pieces, count = ndimage.label(ndimage.binary_opening(rest, iterations=2))
    areas = np.bincount(pieces.ravel(), minlength=count + 1)
    near = np.zeros(count + 1, bool)
    near[np.unique(pieces[ndimage.binary_dilation(known, iterations=_BESIDE_PX + 3)])] = True
    found: list[LeftOut] = []
    for why, part in (*causes.items(), (THIN, None)):
        share = np.ones(count + 1)
        if part is not None:
            share = np.bincount(pieces[part], minlength=count + 1) / np.maximum(areas, 1)
        chosen = (areas >= least_px) & (share >= 0.5)
        chosen[0] = False
        areas = np.where(chosen, 0, areas)
        if why in (SHADOW, THIN):
            # The shadow of a stone and the rim of one are no shapes of their own.
            chosen &= ~near
        found += shapes(np.where(chosen[pieces], pieces, 0), why)
    return tuple(found)
