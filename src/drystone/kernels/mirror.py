"""The mirror image of a picture."""

import numpy as np

from drystone.kernels.raster import Mask


def mirrored(pixels: Mask) -> Mask:
    """Return the mirror image about a vertical line.

    Examples
    --------
    >>> mirrored(np.array([[True, False, False]])).tolist()
    [[False, False, True]]
    """
    return np.ascontiguousarray(pixels[:, ::-1])
