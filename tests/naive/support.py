"""Slow, obvious twins of the support polyline and of wedges (§3.7, Fig. 9)."""

import numpy as np

from drystone.kernels.raster import Mask


def supported_columns(occupied: Mask, mask: Mask, row: int, col: int) -> dict[int, list[int]]:
    """Wall columns in which some pixel of the stone stands on something: rows of those edges."""
    found: dict[int, list[int]] = {}
    for i, j in zip(*np.nonzero(mask), strict=True):
        r, c = int(row + i + 1), int(col + j)
        if r == occupied.shape[0] or occupied[r, c]:
            found.setdefault(c, []).append(r)
    return found


def support_ends(
    occupied: Mask, mask: Mask, row: int, col: int
) -> tuple[tuple[int, int], tuple[int, int]] | None:
    """A and B as (x, row of the edge); None when nothing supports."""
    columns = supported_columns(occupied, mask, row, col)
    if not columns:
        return None
    first, last = min(columns), max(columns)
    return (first, max(columns[first])), (last + 1, max(columns[last]))


def rests_stably(
    occupied: Mask, mask: Mask, row: int, col: int, x_c: float, margin_px: float
) -> bool:
    """Whether the centre of mass projects inside the support, by a margin."""
    ends = support_ends(occupied, mask, row, col)
    return ends is not None and ends[0][0] + margin_px <= x_c <= ends[1][0] - margin_px
