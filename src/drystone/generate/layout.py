"""From outlines to the pixels of stones, and stones side by side in one image of labels."""

import math
from collections.abc import Iterable, Sequence
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import UsageError
from drystone.kernels.outline import rasterise_polygon
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask
from drystone.model.settings import typed
from drystone.model.stone import Source, Stone, StoneSet
from drystone.model.wall import Labels

GAP_PX = 4
"""Empty pixels between two stones, and between stones and the edge of the image."""

WIDTH_TO_HEIGHT = 1.6
"""Shape of the image of stones, about."""

LARGEST_PX = 500_000_000
"""Of the image of stones: with more, most machines run out of memory half way."""


def check_room(
    count: int, size_px: tuple[float, float], settings: Sequence[str], where: str
) -> None:
    """Refuse stones that no image has room for, before any is made."""
    width, height = (side + GAP_PX for side in size_px)
    if not count * width * height <= LARGEST_PX:
        what = f"the stones would fill an image of more than {LARGEST_PX // 1_000_000} million px."
        cure = f"Make {', '.join(settings[:-1])} or {settings[-1]} smaller."
        raise UsageError("E130", what, where=f"generate {where}", cure=cure)


@typed
def lay_out(stones: StoneSet) -> Labels:
    """Draw stones in rows, in the order of their ids, without turning or touching any.

    Reading the image gives the same stones, but for holes, which are filled, and specks, which are
    left out.  One stone alone may be read as a mask, and is then number 1.  Those of a generator
    lie where their `left_px` and `bottom_px` say.

    Parameters
    ----------
    stones : StoneSet
        Any stones; where they lay in their own source does not matter.

    Returns
    -------
    labels : (h, w) uint32 array
        0 where nothing is, otherwise the stones' ids; row 0 at the top.

    Examples
    --------
    >>> lay_out(StoneSet((Stone(1, np.ones((2, 4), bool)),))).shape
    (10, 12)
    """
    corners, shape = _rows([stone.mask.shape for stone in stones])
    labels = np.zeros(shape, np.uint32)
    for stone, (row, col) in zip(stones, corners, strict=True):
        height, width = stone.mask.shape
        labels[row : row + height, col : col + width][stone.mask] = stone.id
    return labels


def stones_of(masks: Sequence[Mask]) -> StoneSet:
    """Make stones 1 ... n of masks, lying where :func:`lay_out` draws them."""
    corners, (height, width) = _rows([mask.shape for mask in masks])
    stones = (
        Stone(number, mask, left_px=col, bottom_px=height - row - mask.shape[0])
        for number, (mask, (row, col)) in enumerate(zip(masks, corners, strict=True), start=1)
    )
    return StoneSet(tuple(stones), Source(width_px=width, height_px=height))


def _rows(shapes: Sequence[tuple[int, ...]]) -> tuple[list[tuple[int, int]], tuple[int, int]]:
    """Return the top-left corner of every box and the shape of the image."""
    area = sum((height + GAP_PX) * (width + GAP_PX) for height, width in shapes)
    row_width = math.isqrt(int(WIDTH_TO_HEIGHT * area))
    corners = []
    row = col = GAP_PX
    below, right = row, col
    for height, width in shapes:
        if col > GAP_PX and col + width > row_width:
            row, col = below, GAP_PX
        corners.append((row, col))
        col += width + GAP_PX
        below, right = max(below, row + height + GAP_PX), max(right, col)
    return corners, (below, right)


ATTEMPTS = 1000
"""Draws after which a generator gives up on its settings."""


def polygon_area(outline: Points) -> float:
    """Return the area of a simple polygon, px."""
    x, y = outline.T
    return abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2


def is_whole(mask: Mask) -> bool:
    """Return True when a mask is one 8-connected piece without holes, so it reads as one stone."""
    if ndimage.label(mask, np.ones((3, 3)))[1] != 1:
        return False
    # A hole is a piece of its own among what is not stone, with a rim around it.
    return int(ndimage.label(np.pad(~mask, 1, constant_values=True))[1]) == 1


def whole_mask(outline: Points | None) -> Mask | None:
    """Return the pixels of a stone with an outline, px, y up; None when they are not whole."""
    if outline is None:
        return None
    mask = rasterise_polygon(outline)[0]
    return mask if is_whole(mask) else None


def accepted(draws: Iterable[NDArray[Any] | None], where: str) -> NDArray[Any]:
    """Return the first draw that is not None; UsageError (E130) when a thousand in a row are."""
    for drawn in islice(draws, ATTEMPTS):
        if drawn is not None:
            return drawn
    why = f"no stone in {ATTEMPTS} draws is one piece: the settings allow none."
    cure = "Ask for larger stones or for less irregular ones."
    raise UsageError("E130", why, where=f"generate {where}", cure=cure)


def check_setting(ok: bool, what: str, where: str) -> None:
    """Raise UsageError (E130) that says what a generator's setting must be, unless it is ok."""
    if not ok:
        raise UsageError("E130", f"{what}.", where=f"generate {where}", cure="Change this setting.")
