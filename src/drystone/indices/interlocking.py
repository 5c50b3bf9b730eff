"""IWR: how far a stone's ends are from the joints below (Eq. 9)."""

from drystone.kernels.boxes import nearest_joints
from drystone.model.landscape import Box, Landscape

NO_JOINT = 0.5
"""IWR of a stone on the ground, or with nothing below."""


def joints_below(landscape: Landscape, box: Box, end_px: float) -> tuple[Box | None, Box | None]:
    """Return the stones below1 and below2 of Eq. 9 (Fig. 7); None where there is none.

    below1 is the stone whose top right corner is closest to the box's bottom left corner, below2
    the one whose top left corner is closest to its bottom right corner, both among the stones
    whose top is not above the stone's vertical centre.

    Parameters
    ----------
    landscape, box, end_px
        As for :func:`interlocking_width_ratio`.
    """
    boxes, last = landscape.boxes, landscape.width_px - end_px
    below1, below2 = nearest_joints(landscape.box_table, box, end_px, last)
    return boxes[below1] if below1 >= 0 else None, boxes[below2] if below2 >= 0 else None


def interlocking_width_ratio(landscape: Landscape, box: Box, end_px: float) -> float:
    """Return IWR in [0, 1]; high where head joints are far from those of the course below (Eq. 9).

    Each term is the horizontal distance from the stone's end to the joint below
    (:func:`joints_below`), over the width of the stone that ends there; IWR is the mean of the
    terms that exist, each clipped to [0, 1].

    Parameters
    ----------
    landscape : Landscape
        Before the stone is placed.
    box : Box
        Of the stone where it is placed.
    end_px : float
        A corner nearer to an end of the wall than this is the wall's end, no joint.
    """
    if box.bottom == 0:
        return NO_JOINT
    below1, below2 = joints_below(landscape, box, end_px)
    terms = []
    if below1 is not None:
        terms.append(min(1.0, abs(box.left - below1.right) / below1.width))
    if below2 is not None:
        terms.append(min(1.0, abs(box.right - below2.left) / below2.width))
    return sum(terms) / len(terms) if terms else NO_JOINT
