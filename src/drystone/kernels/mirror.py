"""The mirror image of a picture."""

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask

_fast = compiled("mirror")


def mirrored(pixels: Mask) -> Mask:
    """Return the mirror image about a vertical line.

    Examples
    --------
    >>> mirrored(np.array([[True, False, False]])).tolist()
    [[False, False, True]]
    """
    if _fast is None or not pixels.flags.c_contiguous:
        return mirrored_numpy(pixels)
    image = np.empty(pixels.shape, bool)
    _fast.mirror(pixels, image)
    return image


def mirrored_numpy(pixels: Mask) -> Mask:
    """Twin of :func:`mirrored`."""
    return np.ascontiguousarray(pixels[:, ::-1])
