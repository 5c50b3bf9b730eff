"""From an outline to the pixels of one stone."""

from collections.abc import Iterable
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import UsageError
from drystone.kernels.outline import rasterise_polygon
from drystone.kernels.raster import Mask

Outline = NDArray[np.float64]
"""Corners (n, 2) of a closed polygon, x right, y up, px; the last joins the first."""

_WITH_CORNERS = np.ones((3, 3))

ATTEMPTS = 1000
"""Draws after which a generator gives up on its settings."""


def polygon_area(outline: Outline) -> float:
    """Return the area of a simple polygon, px."""
    x, y = outline.T
    return abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2


def outline_mask(outline: Outline) -> Mask:
    """Rasterise a polygon: the pixels whose centre is inside, by the even-odd rule.

    Cropped to its pixels, row 0 at the top; of shape (0, 0) when no centre is inside.  A centre on
    the outline is inside when the polygon lies to its right or above it, so polygons that share a
    side share no pixel.
    """
    return rasterise_polygon(outline)[0]


def is_whole(mask: Mask) -> bool:
    """Return True when a mask is one 8-connected piece without holes, so it reads as one stone."""
    if ndimage.label(mask, _WITH_CORNERS)[1] != 1:
        return False
    # A hole is a piece of its own among what is not stone, with a rim around it.
    return int(ndimage.label(np.pad(~mask, 1, constant_values=True))[1]) == 1


def draw_stone(draws: Iterable[Outline | None], what: str) -> Mask:
    """Take outlines, None for those to be rejected, until one gives the mask of a whole stone.

    E130 when a thousand draws in a row are rejected.
    """
    for outline in islice(draws, ATTEMPTS):
        if outline is not None and is_whole(mask := outline_mask(outline)):
            return mask
    raise no_stone(what)


def no_stone(what: str) -> UsageError:
    """Return the error (E130) of a generator whose draws are all rejected."""
    why = f"no stone in {ATTEMPTS} draws is one piece: the settings allow none."
    cure = "Ask for larger stones or for less irregular ones."
    return UsageError("E130", why, where=f"generate {what}", cure=cure)


def check_setting(ok: bool, what: str, where: str) -> None:
    """Raise UsageError (E130) that says what a generator's setting must be, unless it is ok."""
    if not ok:
        raise UsageError("E130", f"{what}.", where=f"generate {where}", cure="Change this setting.")
