"""What is asked of a mask, prepared once: its runs, underside, rays, and its convex hull."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.raster import Mask

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import flags, flags_out, ints_out, longs_out

Ints = NDArray[np.int32]
Longs = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RayPattern:
    """What the rays of a mask sweep inside its bounding box (Eq. 4), row by row.

    A pixel is swept when some pixel of the mask lies to the right of it in its row, or above it in
    its column, and none on it; rays pass through stones.
    """

    # (height,) number of swept pixels at the beginning of each row: the mask begins after
    # them
    left: Ints
    # (n, 3) the other swept pixels: row, first column and the column after the last of every
    # run
    runs: Ints
    area: int  # how many pixels that is altogether

    def looks(self, across: int) -> tuple[Longs, Longs]:
        """Return where the other runs begin, and where they and the beginnings of rows end.

        Pixels are numbered row by row, so many to a row; rows begin left of the image.
        """
        row, start, stop = self.runs.T * np.array([[across], [1], [1]])
        rows = np.arange(0, across * len(self.left), across)
        return row + start, np.concatenate([rows + self.left, row + stop])


@dataclass(frozen=True, eq=False)
class Silhouette:
    """A mask in one piece as rows of runs."""

    height: int
    width: int
    # (n, 3) row, first column and length of every run of set pixels in a row, the lowest row
    # first: a stone that is put where it cannot be mostly meets something with its foot
    runs: Ints
    bottom: Ints  # (width,) row of the lowest pixel of each column
    area_from: Ints  # (height + 1,) number of set pixels from each row down
    rays: RayPattern


def silhouette(mask: Mask) -> Silhouette:
    """Return the runs, the underside and the rays of a mask; every row and column has a pixel."""
    mask = np.ascontiguousarray(mask)
    height: cython.Py_ssize_t = mask.shape[0]
    width: cython.Py_ssize_t = mask.shape[1]
    # No row has more runs than every second pixel.
    runs = np.empty((height * (width // 2 + 1), 3), np.int32)
    bottom = np.full(width, -1, np.int32)
    area_from = np.zeros(height + 1, np.int32)
    pixels: cython.p_uchar = flags(mask)
    found: cython.p_int = ints_out(runs)
    lowest: cython.p_int = ints_out(bottom)
    areas: cython.p_int = ints_out(area_from)
    n: cython.Py_ssize_t = 0
    area: cython.int = 0
    for row in range(height - 1, -1, -1):
        at, col = row * width, 0
        while col < width:
            start = col
            while col < width and pixels[at + col]:
                if lowest[col] < 0:
                    lowest[col] = row
                col += 1
            if col > start:
                found[n], found[n + 1], found[n + 2] = row, start, col - start
                area += col - start
                n += 3
            col += 1
        areas[row] = area
    return Silhouette(height, width, runs[: n // 3].copy(), bottom, area_from, _rays(mask))


def _rays(mask: Mask) -> RayPattern:
    """Return what the rays of a mask sweep."""
    height: cython.Py_ssize_t = mask.shape[0]
    width: cython.Py_ssize_t = mask.shape[1]
    runs = np.empty((height * (width // 2 + 1), 3), np.int32)
    first, above = np.zeros(height, np.int32), np.zeros(width, np.uint8)
    pixels: cython.p_uchar = flags(mask)
    found: cython.p_int = ints_out(runs)
    left: cython.p_int = ints_out(first)
    under: cython.p_uchar = flags_out(above)
    n: cython.Py_ssize_t = 0
    area: cython.Py_ssize_t = 0
    for row in range(height):
        at, col, last = row * width, 0, width - 1
        while last >= 0 and not pixels[at + last]:
            last -= 1
        while col < width:
            start = col
            while col < width and not pixels[at + col] and (col < last or under[col]):
                col += 1
            if col > start:
                area += col - start
                if start == 0:
                    left[row] = col
                else:
                    found[n], found[n + 1], found[n + 2] = row, start, col
                    n += 3
            while col < width and (pixels[at + col] or not (col < last or under[col])):
                if pixels[at + col]:
                    under[col] = 1
                col += 1
    return RayPattern(first, runs[: n // 3].copy(), area)


def pixel_hull(mask: Mask) -> Longs:
    """Return the corners of the convex hull of the pixel squares of a mask.

    x to the right and y up, px from the mask's bottom-left corner; counter-clockwise from the right
    end of the lowest edge, no three of them on one line.
    """
    mask = np.ascontiguousarray(mask)
    height: cython.Py_ssize_t = mask.shape[0]
    width: cython.Py_ssize_t = mask.shape[1]
    # As many as there could ever be on the way: two a row on one side, then on the other.
    corners = np.empty((2 * height + 2, 2), np.int64)
    pixels: cython.p_uchar = flags(mask)
    chain: cython.p_longlong = longs_out(corners)
    count: cython.Py_ssize_t = 0
    for row in range(height - 1, -1, -1):
        col = width
        while col > 0 and not pixels[row * width + col - 1]:
            col -= 1
        if col:
            count = put(chain, count, col, height - row - 1)
            count = put(chain, count, col, height - row)
    for row in range(height):
        col = 0
        while col < width and not pixels[row * width + col]:
            col += 1
        if col < width:
            count = put(chain, count, col, height - row)
            count = put(chain, count, col, height - row - 1)
    return corners[:count].copy()


def put(at, count, x, y):
    """Add a point to the chain of corners (Andrew's); return how many there are then."""
    x1: cython.longlong
    y1: cython.longlong
    while count > 1:
        k = 2 * count - 4
        x1, y1 = at[k + 2], at[k + 3]
        # Corners at which the way around does not turn left are left out.
        if (x1 - at[k]) * (y - y1) > (y1 - at[k + 1]) * (x - x1):
            break
        count -= 1
    at[2 * count], at[2 * count + 1] = x, y
    return count + 1
