"""How level the top of a wall is (DESIGN 5)."""

import numpy as np
from numpy.typing import NDArray

from drystone.model.wall import Labels


def top_profile(labels: Labels) -> NDArray[np.intp]:
    """Return the height of the highest stone pixel over the last row, per column.

    Parameters
    ----------
    labels : (h, w) integer array
        The wall, cut out by :func:`drystone.metrics.frame.frame_wall`, standing on its last row.

    Returns
    -------
    height_px : (w,) int array
        Upper edge of the highest stone or wedge pixel of a column; 0 where there is none, be it a
        joint from top to bottom or an end that the wall does not reach.

    Examples
    --------
    >>> top_profile(np.array([[0, 1, 0], [2, 0, 0]], np.uint32)).tolist()
    [1, 2, 0]
    """
    filled = labels > 0
    return np.where(filled.any(axis=0), labels.shape[0] - filled.argmax(axis=0), 0)


def level_deviation(labels: Labels, mean_stone_height_px: float) -> float:
    """Return T_LEVEL, how far the top is from level in units of a stone's height.

    The mean over all columns of |top profile - mean of the top profile|, over the mean height of
    the stones' bounding boxes as they lie in the wall.  0 is a level top; a wall of which one
    half is a whole stone higher than the other has .5.  Lower is better.  It exposes walls whose
    F_AV is high because of towers.

    Parameters
    ----------
    labels : (h, w) integer array
        The wall, cut out by :func:`drystone.metrics.frame.frame_wall`.
    mean_stone_height_px : float
        Positive, wedges left out.

    Notes
    -----
    The profile is the plain one: in a head joint that is open at the top it drops to what lies
    below, so walls traced with wide joints read higher (the masons' level wall R: .12).

    Examples
    --------
    >>> level_deviation(np.array([[1, 1, 0, 0], [2, 2, 3, 3]], np.uint32), 1.0)
    0.5
    """
    profile = top_profile(labels)
    return float(np.abs(profile - profile.mean()).mean()) / mean_stone_height_px
