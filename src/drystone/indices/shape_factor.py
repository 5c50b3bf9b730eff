"""SF: how much of its bounding box a stone fills (Eq. 3)."""

from drystone.model.pose import PosedStone
from drystone.poses import bounding_box_shape_factor


def shape_factor(posed: PosedStone) -> float:
    """Return SF of a posed stone, in (0, 1]; 1 for an upright rectangle (Eq. 3)."""
    return bounding_box_shape_factor(posed.stone, posed.angle_deg)
