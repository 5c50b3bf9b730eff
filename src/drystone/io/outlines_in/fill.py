"""Areas to pixels: a pixel belongs to an area when its centre does."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError
from drystone.io.outlines_in.model import Area, OutlinedStone, PlacedMask
from drystone.kernels.polygons import Points


def box_of(area: Area) -> tuple[int, int, int, int]:
    """Return the rows and columns (first, end, first, end) that an area can fill."""
    points = np.concatenate(area.rings)
    (left, top), (right, bottom) = points.min(axis=0), points.max(axis=0)
    return int(np.floor(top)), int(np.ceil(bottom)), int(np.floor(left)), int(np.ceil(right))


def check_reach(stones: Iterable[OutlinedStone], where: str, max_px: int) -> None:
    """Refuse outlines, in px, that would fill the memory (E110), naming the stone."""
    for stone in stones:
        for area in stone.areas:
            top, bottom, left, right = box_of(area)
            if (right - left) * (bottom - top) > max_px:
                raise InputError(
                    "E110",
                    f"stone {stone.name or stone.id} reaches over {right - left} x {bottom - top} "
                    f"px; the limit is {max_px / 1e6:g} million.",
                    where=where,
                    cure="Is a corner of it far away from the picture? Correct it; only in Python "
                    "can the limit be raised (max_image_mpx).",
                )


def filled_area(area: Area) -> PlacedMask | None:
    """Return the pixels whose centres lie in an area; None when there are none.

    Parameters
    ----------
    area : Area
        In px, y down; pixel (row, col) is the unit square from (x, y) = (col, row).  A centre on
        a left or upper edge is inside, on a right or lower edge outside, so areas that meet share
        no pixel.

    Examples
    --------
    >>> square = np.array([[0, 0], [3, 0], [3, 2], [0, 2]], float)
    >>> filled_area(Area((square,))).mask.shape
    (2, 3)
    """
    top, bottom, left, right = box_of(area)
    height, width = bottom - top, right - left
    if height < 1 or width < 1:
        return None
    turns = np.zeros((height, width + 1), np.int32)
    for ring in area.rings:
        _add_crossings(turns, ring, top, left)
    winding = np.cumsum(turns, axis=1)[:, :-1]
    mask = winding % 2 == 1 if area.rule == "evenodd" else winding != 0
    return trimmed(PlacedMask(np.asarray(mask), top, left))


def trimmed(placed: PlacedMask) -> PlacedMask | None:
    """Cut a mask to its bounding box; None when it has no pixel."""
    rows = np.flatnonzero(placed.mask.any(axis=1))
    if not len(rows):
        return None
    cols = np.flatnonzero(placed.mask.any(axis=0))
    inside = placed.mask[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    return PlacedMask(
        np.ascontiguousarray(inside), placed.row + int(rows[0]), placed.col + int(cols[0])
    )


def united(masks: list[PlacedMask]) -> PlacedMask | None:
    """Return the union of masks; None without any."""
    if len(masks) < 2:
        return masks[0] if masks else None
    top, left = min(m.row for m in masks), min(m.col for m in masks)
    bottom = max(m.row + m.mask.shape[0] for m in masks)
    right = max(m.col + m.mask.shape[1] for m in masks)
    whole = np.zeros((bottom - top, right - left), bool)
    for one in masks:
        height, width = one.mask.shape
        row, col = one.row - top, one.col - left
        whole[row : row + height, col : col + width] |= one.mask
    return PlacedMask(whole, top, left)


def _add_crossings(turns: NDArray[np.int32], ring: Points, top: int, left: int) -> None:
    """Add, row by row, where edges cross the line of pixel centres, and in which sense."""
    height, width = turns.shape[0], turns.shape[1] - 1
    ends = np.roll(ring, -1, axis=0)
    sense = np.where(ends[:, 1] > ring[:, 1], 1, -1)
    # From the upper end whichever way it runs, and not from the box: an edge that two areas have
    # in common is crossed at the same number in both.
    down = (sense > 0)[:, None]
    (x0, y0), (x1, y1) = np.where(down, ring, ends).T, np.where(down, ends, ring).T
    first = np.ceil(y0 - 0.5).astype(np.int64)
    number = np.ceil(y1 - 0.5).astype(np.int64) - first
    edge = np.repeat(np.arange(len(ring)), number)
    row = first[edge] + np.arange(len(edge)) - (np.cumsum(number) - number)[edge]
    x = x0[edge] + (row + 0.5 - y0[edge]) / (y1 - y0)[edge] * (x1 - x0)[edge]
    col = np.clip(np.ceil(x - 0.5).astype(np.int64) - left, 0, width)
    row -= top
    inside = (row >= 0) & (row < height)
    np.add.at(turns, (row[inside], col[inside]), sense[edge][inside])
