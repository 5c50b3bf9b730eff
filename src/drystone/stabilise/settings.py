"""Settings of stabilisation."""

from dataclasses import dataclass
from typing import Literal

Method = Literal["both", "rotation", "wedge", "none"]


@dataclass(frozen=True, kw_only=True)
class StabiliseSettings:
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
    margin: float = 0.0
    step_deg: float = 1.0
    max_turn_deg: float = 15.0
    max_pivots: int = 4
    new_pivot_px: int = 3
    max_shift_px: int = 3
    min_wedge_px: int = 2
    max_wedge_height: float = 0.5

    def __post_init__(self) -> None:
        if self.method not in ("both", "rotation", "wedge", "none"):
            raise ValueError(f"unknown stabilisation method {self.method!r}")
        if not 0 <= self.margin < 0.5:
            raise ValueError("margin must be in [0, 0.5)")
        if self.step_deg <= 0 or self.max_turn_deg < 0 or self.max_pivots < 0:
            raise ValueError("rotation step must be positive, limits not negative")
        if (
            min(self.max_shift_px, self.new_pivot_px) < 0
            or self.min_wedge_px < 1
            or self.max_wedge_height <= 0
        ):
            raise ValueError("limits of shifts and wedges must be positive")
