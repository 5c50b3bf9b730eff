"""NHR: how far a stone's top is from level with its neighbour (Eq. 6-8)."""

from drystone.kernels.boxes import left_neighbour as neighbour_place
from drystone.model.landscape import Box, Landscape


def left_neighbour(landscape: Landscape, box: Box) -> Box | None:
    """Return the nearest stone on the building side in the same course; None when there is none.

    Its rows overlap the stone's by at least half the smaller of the two heights, and it ends left
    of the stone's middle: outlines may interlock.
    """
    place = neighbour_place(landscape.box_table, box)
    return landscape.boxes[place] if place >= 0 else None


def neighbour_height_ratio(
    box: Box, neighbour: Box | None, course_height_px: float | None
) -> float:
    """Return NHR, 0 or larger; 0 is best (Eq. 6-8).

    Parameters
    ----------
    box : Box
        Of the stone where it is placed.
    neighbour : Box or None
        From :func:`left_neighbour`.
    course_height_px : float or None
        Mean height of the other candidates, which the first stone of a course is compared with;
        None when there are none.
    """
    if neighbour is not None:
        return abs(box.top - neighbour.top) / box.height
    if course_height_px is None:
        return 0.0
    return abs(box.height - course_height_px) / box.height
