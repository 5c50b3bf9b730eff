"""Settings of stabilisation."""

from dataclasses import dataclass
from typing import Literal

from drystone.model.settings import Ranged, ranged

Method = Literal["both", "rotation", "wedge", "none"]


@dataclass(frozen=True, kw_only=True)
class StabiliseSettings(Ranged):
    """How a trial placement that is not stable is made so (§3.7, Fig. 20).

    Parameters
    ----------
    method : {"both", "rotation", "wedge", "none"}
        Rotation first and wedging second, either alone, or neither.
    margin : float
        Distance of the centre of mass from the ends of the support polyline, as a share of the
        stone's width; 0 in the paper.
    step_deg : float
        Rotation step; 1 degree in the paper.
    max_turn_deg : float
        Largest total turn away from the trial pose.
    max_pivots : int
        How many points a stone may turn about, one after the other.
    new_pivot_px : int
        How far, working px, the end of the support must move to be a new point A.
    max_shift_px : int
        How far a turned stone may be moved up or down, working px, to rest on pixels again.
    min_wedge_px : int
        Smallest height and width of a wedge that is pixels, working px.
    max_wedge_height : float
        Largest height of a wedge that is pixels, as a share of the mean stone height.
    """

    method: Method = "both"
    margin: float = ranged(0.0, least=0, below=0.5)
    step_deg: float = ranged(1.0, above=0)
    max_turn_deg: float = ranged(15.0, least=0)
    max_pivots: int = ranged(4, least=0)
    new_pivot_px: int = ranged(3, least=0)
    max_shift_px: int = ranged(3, least=0)
    min_wedge_px: int = ranged(2, least=1)
    max_wedge_height: float = ranged(0.5, above=0)
