"""What placement asks of a mask, prepared once: its runs, its underside, what its rays sweep."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask

Ints = NDArray[np.int32]

_fast = compiled("silhouette")


@dataclass(frozen=True, eq=False)
class RayPattern:
    """What the rays of a mask sweep inside its bounding box (Eq. 4), row by row.

    A pixel is swept when some pixel of the mask lies to the right of it in its row, or above it
    in its column, and none on it; rays pass through stones.

    Parameters
    ----------
    left : (height,) int array
        Number of swept pixels at the beginning of each row: the mask begins after them.
    runs : (n, 3) int array
        The other swept pixels: row, first column and the column after the last of every run.
    area : int
        How many pixels that is altogether.
    """

    left: Ints
    runs: Ints
    area: int


@dataclass(frozen=True, eq=False)
class Silhouette:
    """A mask in one piece as rows of runs.

    Parameters
    ----------
    height, width : int
        Size of the mask.
    runs : (n, 3) int array
        Row, first column and length of every run of set pixels in a row, the lowest row first:
        a stone that is put where it cannot be mostly meets something with its foot.
    bottom : (width,) int array
        Row of the lowest pixel of each column.
    area_from : (height + 1,) int array
        Number of set pixels from each row down.
    rays : RayPattern
        What its rays sweep.
    """

    height: int
    width: int
    runs: Ints
    bottom: Ints
    area_from: Ints
    rays: RayPattern


def silhouette(mask: Mask) -> Silhouette:
    """Return the runs, the underside and the rays of a mask; every row and column has a pixel.

    Examples
    --------
    >>> outline = silhouette(np.array([[1, 1, 0, 1], [0, 1, 1, 1]], bool))
    >>> outline.runs.tolist(), outline.bottom.tolist(), outline.area_from.tolist()
    ([[1, 1, 3], [0, 0, 2], [0, 3, 1]], [0, 1, 1, 1], [6, 3, 0])
    >>> outline.rays.left.tolist(), outline.rays.runs.tolist(), outline.rays.area
    ([0, 1], [[0, 2, 3]], 2)
    """
    if _fast is None:
        return silhouette_numpy(mask)
    runs, bottom, area_from = _fast.runs(mask)
    height, width = mask.shape
    return Silhouette(height, width, runs, bottom, area_from, RayPattern(*_fast.rays(mask)))


def silhouette_numpy(mask: Mask) -> Silhouette:
    """Twin of :func:`silhouette`."""
    height, width = mask.shape
    rows, starts, stops = _runs(mask[::-1])
    runs = np.column_stack([height - 1 - rows, starts, stops - starts]).astype(np.int32)
    bottom = (height - 1 - np.argmax(mask[::-1], axis=0)).astype(np.int32)
    area_from = np.zeros(height + 1, np.int32)
    area_from[:-1] = np.cumsum(np.count_nonzero(mask, axis=1)[::-1])[::-1]
    return Silhouette(height, width, runs, bottom, area_from, _ray_pattern(mask))


def _ray_pattern(mask: Mask) -> RayPattern:
    left_of = np.logical_or.accumulate(mask[:, ::-1], axis=1)[:, ::-1]
    below = np.logical_or.accumulate(mask, axis=0)
    swept = (left_of | below) & ~mask
    rows, starts, stops = _runs(swept)
    first = starts == 0
    left = np.zeros(mask.shape[0], np.int32)
    left[rows[first]] = stops[first]
    runs = np.column_stack([rows, starts, stops])[~first].astype(np.int32)
    return RayPattern(left, runs, int(np.count_nonzero(swept)))


def _runs(pixels: Mask) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Return row, first column and column after the last of every run of set pixels in a row."""
    edges = np.diff(np.pad(pixels, ((0, 0), (1, 1))).view(np.int8), axis=1)
    rows, starts = np.nonzero(edges == 1)
    return rows, starts, np.nonzero(edges == -1)[1]
