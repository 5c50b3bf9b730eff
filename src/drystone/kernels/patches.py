"""Pieces of label images with a margin, and new parts painted into them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.boundary import EMPTY, Cells
from drystone.kernels.raster import Mask

GROUND = 0
"""Label of the ground in cells."""

MARGIN_PX = 3
"""How far around a contact at a point the two regions are looked at for its normal."""

Part = tuple[int, int, int, Mask]
"""What is new: label, row and col of the top-left corner in the image, pixels."""

Box = tuple[int, int, int, int]
"""Rows and columns of an image: top, bottom, left, right."""

_fast = compiled("patches")


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of an image with its margin.

    Parameters
    ----------
    cells : (h, w) int64 array
        Labels; EMPTY where nothing is, GROUND below the image.
    fresh : (h, w) bool array or None
        True where something was painted; None when all is fresh.
    origin : (int, int)
        (x, y) of the upper left corner of the cells.
    """

    cells: Cells
    fresh: Mask | None
    origin: tuple[int, int]


def whole_patch(labels: NDArray[np.integer]) -> Patch:
    """Return all of an image as a patch.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is.
    """
    height, width = labels.shape
    cells = _cut(labels, (0, height, 0, width))
    return Patch(cells, None, (-MARGIN_PX, height + MARGIN_PX))


def painted_patch(
    labels: NDArray[np.integer], parts: Sequence[Part]
) -> tuple[Patch, list[tuple[int, int, int]]]:
    """Return what is around new parts of an image, with the parts in it.

    Parameters
    ----------
    labels : (h, w) integer array
        0 where nothing is.
    parts : sequence of (label, row, col, mask)
        At least one; with labels that the image does not have.

    Returns
    -------
    patch : Patch
        Around all parts.
    sums : list of (int, int, int)
        For each part: its number of pixels, and the sums of their columns and of their rows in
        the mask.
    """
    box = (
        min(row for _, row, _, _ in parts),
        max(row + mask.shape[0] for _, row, _, mask in parts),
        min(col for _, _, col, _ in parts),
        max(col + mask.shape[1] for _, _, col, mask in parts),
    )
    cells = _cut(labels, box)
    fresh = np.zeros(cells.shape, bool)
    top, left = box[0] - MARGIN_PX, box[2] - MARGIN_PX
    paint = paint_numpy if _fast is None else _fast.paint
    sums = [
        paint(mask, label, row - top, col - left, cells, fresh) for label, row, col, mask in parts
    ]
    return Patch(cells, fresh, (left, labels.shape[0] - top)), sums


def _cut(labels: NDArray[np.integer], box: Box) -> Cells:
    """Cut a box and its margin out of an image."""
    top, bottom, left, right = box
    margin = 2 * MARGIN_PX
    cells = np.empty((bottom - top + margin, right - left + margin), np.int64)
    if _fast is None or labels.dtype != np.uint32:
        cut_out_numpy(labels, cells, top - MARGIN_PX, left - MARGIN_PX)
    else:
        _fast.cut_out(labels, cells, top - MARGIN_PX, left - MARGIN_PX)
    return cells


def cut_out_numpy(labels: NDArray[np.integer], cells: Cells, top: int, left: int) -> None:
    """Fill cells with what is in an image from a row and column on, and around the image."""
    row, end_row = _inside(top, labels.shape[0], cells.shape[0])
    col, end_col = _inside(left, labels.shape[1], cells.shape[1])
    seen = labels[row + top : end_row + top, col + left : end_col + left]
    cells[:] = EMPTY
    np.copyto(cells[row:end_row, col:end_col], seen, where=seen > 0, casting="unsafe")
    cells[max(labels.shape[0] - top, 0) :] = GROUND


def _inside(first: int, size: int, count: int) -> tuple[int, int]:
    """Of so many rows, the first of which is row `first` of an image, return those inside."""
    begin = min(max(-first, 0), count)
    return begin, max(min(size - first, count), begin)


def paint_numpy(
    mask: Mask, label: int, row: int, col: int, cells: Cells, fresh: Mask
) -> tuple[int, int, int]:
    """Paint a mask into cells; return its pixels, and the sums of their columns and rows."""
    height, width = mask.shape
    window = np.s_[row : row + height, col : col + width]
    cells[window][mask] = label
    fresh[window][mask] = True
    in_cols, in_rows = np.count_nonzero(mask, axis=0), np.count_nonzero(mask, axis=1)
    return (
        int(in_rows.sum()),
        int((in_cols * np.arange(width)).sum()),
        int((in_rows * np.arange(height)).sum()),
    )
