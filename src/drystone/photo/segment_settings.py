"""What can be set about finding stones in a photograph."""

from dataclasses import dataclass
from typing import Literal

Ground = Literal["auto", "light", "dark"]


@dataclass(frozen=True, kw_only=True)
class SegmentSettings:
    """How stones are told from the ground.

    Parameters
    ----------
    ground : str
        ``"light"`` or ``"dark"`` when the ground is the lightest or the darkest large area of the
        photograph; ``"auto"``: the colour that is most frequent along the borders and all over.
    min_area_px : float or None
        Smaller areas are no stones; None for a fiftieth of a usual stone (and at least a five
        thousandth of the picture).
    split : bool
        Cut touching stones apart at narrow necks.
    split_below : float
        A neck is cut when its width is less than this share of the thickness of the thinner
        part.
    other_colour_below : float
        The same between parts of different colours.
    doubt_below : float
        A neck that is not cut is reported when its width is below this share.
    unusual : float
        Stones this many times larger or smaller than the median area are reported.
    """

    ground: Ground = "auto"
    min_area_px: float | None = None
    split: bool = True
    split_below: float = 0.6
    other_colour_below: float = 0.85
    doubt_below: float = 0.8
    unusual: float = 6.0
