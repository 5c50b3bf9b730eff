"""What can be set about finding stones in a photograph."""

from dataclasses import dataclass
from typing import Literal

Ground = Literal["auto", "light", "dark"]


@dataclass(frozen=True, kw_only=True)
class SegmentSettings:
    """How stones are told from the ground."""

    # The lightest or the darkest large area of the photograph; or the colour that is most frequent
    # along the borders and all over.
    ground: Ground = "auto"
    # Smaller areas are no stones; None for a fiftieth of a usual stone (and at least a five
    # thousandth of the picture).
    min_area_px: float | None = None
    split: bool = True  # cut touching stones apart at narrow necks
    split_below: float = 0.6  # necks narrower than this share of the thinner part are cut
    other_colour_below: float = 0.85  # the same between parts of different colours
    doubt_below: float = 0.8  # those that are not cut are reported below this share
    unusual: float = 6.0  # stones so many times larger or smaller than the median are reported
