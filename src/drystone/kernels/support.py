"""Where a mask stands on a landscape: the ends of its support, and the row where it rests."""

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.raster import Mask

_fast = compiled("support")

Ends = tuple[int, int, int, int]


def support_ends(occupied: Mask, mask: Mask, row: int, col: int) -> Ends | None:
    """Return the outermost pixels on which a mask stands.

    A pixel stands where the mask moved down by one would overlap something or the ground.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape without the mask, row 0 at the top; the ground is below its last row.
    mask : (h', w') bool array
        Cropped.
    row, col : int
        Its top-left corner; it overlaps nothing there.

    Returns
    -------
    left_x, right_x, left_row, right_row : int
        Outer edges of the outermost of these pixels, and the rows of the edges on which they
        stand: of a column's pixels the lowest counts.  None when it stands on nothing.

    Raises
    ------
    ValueError
        When the mask leaves the landscape.

    Examples
    --------
    >>> support_ends(np.zeros((2, 5), bool), np.array([[1, 1, 1], [0, 1, 0]], bool), 0, 1)
    (2, 3, 2, 2)
    """
    check_inside(occupied, mask, row, col)
    kernel = support_ends_numpy if _fast is None else _fast.support_ends
    ends: Ends | None = kernel(occupied, mask, row, col)
    return ends


def support_ends_numpy(occupied: Mask, mask: Mask, row: int, col: int) -> Ends | None:
    """Return what :func:`support_ends` returns, by NumPy."""
    height, width = mask.shape
    below = occupied[row + 1 : row + height + 1, col : col + width]
    hit = np.zeros(mask.shape, bool)
    hit[: below.shape[0]] = mask[: below.shape[0]] & below
    if row + height == occupied.shape[0]:
        hit[-1] = mask[-1]
    columns = np.flatnonzero(hit.any(axis=0))
    if columns.size == 0:
        return None
    first, last = int(columns[0]), int(columns[-1])
    lowest = height - np.argmax(hit[::-1, [first, last]], axis=0)
    return col + first, col + last + 1, row + int(lowest[0]), row + int(lowest[1])


def resting_place(
    occupied: Mask, mask: Mask, row: int, col: int, reach_px: int
) -> tuple[int, Ends] | None:
    """Return the row nearest to a given one at which a mask rests in its column.

    Parameters
    ----------
    occupied : (h, w) bool array
        The landscape.
    mask : (h', w') bool array
        Cropped.
    row, col : int
        Where its top-left corner should go.
    reach_px : int
        How far up or down it may be moved; of two rows equally far the lower one is taken.

    Returns
    -------
    row : int
        Where it overlaps nothing, and would one row lower or stands on the ground.
    ends : (int, int, int, int)
        Of its support there (:func:`support_ends`).

    None when it overlaps something, leaves the landscape, or hangs in the air in all these rows.
    """
    if col < 0 or col + mask.shape[1] > occupied.shape[1]:
        return None
    kernel = resting_place_numpy if _fast is None else _fast.resting_place
    place: tuple[int, Ends] | None = kernel(occupied, mask, row, col, reach_px)
    return place


def resting_place_numpy(
    occupied: Mask, mask: Mask, row: int, col: int, reach_px: int
) -> tuple[int, Ends] | None:
    """Return what :func:`resting_place` returns, by NumPy; the mask's columns must be inside."""
    height, width = mask.shape
    lowest = occupied.shape[0] - height
    window = occupied[:, col : col + width]

    def fits(at: int) -> bool:
        return 0 <= at <= lowest and not np.any(window[at : at + height] & mask)

    for shift in sorted(range(-reach_px, reach_px + 1), key=lambda shift: (abs(shift), -shift)):
        if fits(row + shift) and not fits(row + shift + 1):
            ends = support_ends_numpy(occupied, mask, row + shift, col)
            return None if ends is None else (row + shift, ends)
    return None


def check_inside(occupied: Mask, mask: Mask, row: int, col: int) -> None:
    """Raise ValueError when a mask at a position leaves the landscape."""
    height, width = mask.shape
    if min(row, col) < 0 or row + height > len(occupied) or col + width > occupied.shape[1]:
        raise ValueError(f"a mask of {height} x {width} px at ({row}, {col}) leaves the landscape")
