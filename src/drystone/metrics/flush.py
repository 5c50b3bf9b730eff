"""How well a wall ends in two straight vertical lines (DESIGN 5)."""

import numpy as np
from numpy.typing import NDArray

from drystone.metrics.frame import WallFrame


def end_gaps(frame: WallFrame) -> NDArray[np.float64]:
    """Return the horizontal gap between the wall's ends and its end lines, row by row.

    Parameters
    ----------
    frame : WallFrame
        The wall.

    Returns
    -------
    gap_px : (n, 2) float array
        At the left and at the right end, for each row in which there is a stone or wedge; a stone
        that sticks out over the end line has a gap as well, the length by which it does.

    Examples
    --------
    >>> wall = np.array([[0, 1, 1, 0], [0, 0, 0, 0], [2, 2, 2, 0]], np.uint32)
    >>> end_gaps(WallFrame(wall, 0.0, 4.0)).tolist()
    [[1.0, 1.0], [0.0, 1.0]]
    """
    filled = frame.labels > 0
    filled = filled[filled.any(axis=1)]
    left_end = filled.argmax(axis=1)
    right_end = filled.shape[1] - filled[:, ::-1].argmax(axis=1)
    gaps = np.column_stack([left_end - frame.left_px, frame.right_px - right_end])
    return np.asarray(np.abs(gaps))


def flush_deviation(frame: WallFrame, mean_stone_width_px: float) -> float:
    """Return E_FLUSH, how ragged the ends are in units of a stone's width.

    The mean over both ends and all rows, from the wall's top to its foot, of the gap between the
    outermost stone pixel and the end line, over the mean width of the stones' bounding boxes as
    they lie in the wall.  Rows without any stone, open bed joints, have no end and are left out.
    0 is two straight ends; a wall that lacks half a stone at one end of every other course has
    .125.  Lower is better.  It exposes walls whose F_AV is high because of ragged ends.

    Parameters
    ----------
    frame : WallFrame
        The wall and its end lines.
    mean_stone_width_px : float
        Positive, wedges left out.

    Examples
    --------
    >>> wall = np.array([[1, 1, 1, 0], [2, 2, 2, 2]], np.uint32)
    >>> flush_deviation(WallFrame(wall, 0.0, 4.0), 2.0)
    0.125
    """
    return float(end_gaps(frame).mean()) / mean_stone_width_px
