"""Profiles without the slots of open joints."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Floats = NDArray[np.float64]


def without_slots(profile: Floats, widest: float) -> Floats:
    """Fill the slots of a profile that are no wider than a joint to their lower brink.

    Parameters
    ----------
    profile : (n,) float array
        Heights.
    widest : float
        Width of a slot, in steps of the profile.

    Examples
    --------
    >>> without_slots(np.array([3.0, 3.0, 0.0, 2.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0]), 1.2).tolist()
    [3.0, 3.0, 2.0, 2.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0]
    """
    size = int(widest) + 1
    if size < 2 or profile.size < 2:
        return profile
    # Beyond both ends nothing is: what is low there is no slot.
    around = np.pad(profile, size, constant_values=float(profile.min()))
    raised = ndimage.maximum_filter1d(around, size, origin=0)
    # The same window turned about, so that what has no slots stays.
    closed = ndimage.minimum_filter1d(raised, size, origin=-((size + 1) % 2))
    return np.asarray(closed[size:-size])
