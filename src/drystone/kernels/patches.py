"""Pieces of label images with a margin, and new parts painted into them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.boundary import EMPTY, Cells
from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import flags_out, labels_in, longs_out, pixels, stride

GROUND = 0
"""Label of the ground in cells."""

MARGIN_PX = 3
"""How far around a contact at a point the two regions are looked at for its normal."""

Part = tuple[int, int, int, Mask]
"""What is new: label, row and col of the top-left corner in the image, pixels."""

NOTHING = cython.declare(cython.longlong, EMPTY)
GROUND_LABEL = cython.declare(cython.longlong, GROUND)


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of an image with its margin."""

    cells: Cells  # (h, w) labels; EMPTY where nothing is, GROUND below the image
    fresh: Mask | None  # (h, w) true where something was painted; None when all is fresh
    origin: tuple[int, int]  # (x, y) of the upper left corner of the cells


def whole_patch(labels: NDArray[np.integer]) -> Patch:
    """Return all of an image as a patch; 0 where nothing is."""
    height, width = labels.shape
    cells = np.full((height + 2 * MARGIN_PX, width + 2 * MARGIN_PX), EMPTY, np.int64)
    inside = cells[MARGIN_PX : MARGIN_PX + height, MARGIN_PX : MARGIN_PX + width]
    np.copyto(inside, labels, where=labels > 0, casting="unsafe")
    cells[MARGIN_PX + height :] = GROUND
    return Patch(cells, None, (-MARGIN_PX, height + MARGIN_PX))


def painted_patch(
    labels: NDArray[np.uint32], parts: Sequence[Part]
) -> tuple[Patch, list[tuple[int, int, int]]]:
    """Return what is around new parts of an image, at least one, with the parts in it.

    Labels are new to the image.  Of each part the second value has its number of pixels, and the
    sums of their columns and of their rows in the mask.
    """
    top = min(row for _, row, _, _ in parts) - MARGIN_PX
    left = min(col for _, _, col, _ in parts) - MARGIN_PX
    end_row = max(row + mask.shape[0] for _, row, _, mask in parts) + MARGIN_PX
    end_col = max(col + mask.shape[1] for _, _, col, mask in parts) + MARGIN_PX
    cells = np.empty((end_row - top, end_col - left), np.int64)
    fresh = np.zeros(cells.shape, bool)
    cut_out(labels, cells, top, left)
    sums = [
        paint(mask, label, row - top, col - left, cells, fresh) for label, row, col, mask in parts
    ]
    return Patch(cells, fresh, (left, labels.shape[0] - top)), sums


def cut_out(labels, cells, top, left):
    """Fill cells with what is in an image from a row and column on, and around the image."""
    image: cython.p_uint = labels_in(labels)
    down: cython.Py_ssize_t = stride(labels, 0)
    across: cython.Py_ssize_t = stride(labels, 1)
    height: cython.Py_ssize_t = labels.shape[0]
    width: cython.Py_ssize_t = labels.shape[1]
    rows: cython.Py_ssize_t = cells.shape[0]
    count: cython.Py_ssize_t = cells.shape[1]
    out: cython.p_longlong = longs_out(cells)
    first: cython.Py_ssize_t = min(max(-left, 0), count)
    last: cython.Py_ssize_t = max(min(width - left, count), first)
    with cython.nogil:
        for row in range(top, top + rows):
            at: cython.Py_ssize_t = (row - top) * count
            if row < 0 or row >= height:
                for col in range(at, at + count):
                    out[col] = NOTHING if row < 0 else GROUND_LABEL
                continue
            for col in range(at, at + first):
                out[col] = NOTHING
            here: cython.Py_ssize_t = row * down + (first + left) * across
            for col in range(at + first, at + last):
                label: cython.longlong = image[here]
                out[col] = label if label else NOTHING
                here += across
            for col in range(at + last, at + count):
                out[col] = NOTHING
    return 0


def paint(mask, label, top, left, cells, fresh):
    """Paint a mask into cells; return its pixels, and the sums of their columns and rows."""
    pixel: cython.p_uchar = pixels(mask)
    down: cython.Py_ssize_t = stride(mask, 0)
    across: cython.Py_ssize_t = stride(mask, 1)
    rows: cython.Py_ssize_t = mask.shape[0]
    columns: cython.Py_ssize_t = mask.shape[1]
    width: cython.Py_ssize_t = cells.shape[1]
    out: cython.p_longlong = longs_out(cells)
    marks: cython.p_uchar = flags_out(fresh)
    area: cython.longlong = 0
    sum_cols: cython.longlong = 0
    sum_rows: cython.longlong = 0
    with cython.nogil:
        for row in range(rows):
            here: cython.Py_ssize_t = row * down
            at: cython.Py_ssize_t = (top + row) * width + left
            for col in range(columns):
                if pixel[here]:
                    out[at + col] = label
                    marks[at + col] = True
                    area += 1
                    sum_cols += col
                    sum_rows += row
                here += across
    return area, sum_cols, sum_rows
