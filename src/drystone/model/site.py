"""The place where the wall goes up, and the lengths that turn it into pixels."""

import math
from dataclasses import dataclass, field

from drystone.errors import UsageError
from drystone.model.settings import typed

MAX_SITE_PX = 50_000_000
"""A larger wall fills the memory; its stones are many times finer than planning needs."""

SHORTEST, LONGEST, LARGEST = 1e-9, 1e9, 1e12
"""Sides of a wall in metres and its area, as plan.schema.json has them: of an area, that of wedges.
"""


@typed
@dataclass(frozen=True)
class Site:
    """A wall's outer dimensions at the working resolution, on flat ground.

    The wall frame has x to the right from the wall's left end and y up from the ground.  The
    ends limit the space; they carry nothing.

    Parameters
    ----------
    width_px, height_px : int
        Size at the working resolution.
    scale : float
        Working resolution over source resolution.
    px_per_m : float or None
        Source px in a metre, when a scale is known.
    source_px : (float, float) or None
        Width and height in source px; None when they are those of the working px.

    Raises
    ------
    UsageError
        E121: it has no pixel, or too many; E125: the scale is not above 0; E138: the px in a metre
        are not above 0, more than 1e9, or make a wall that no plan can have.

    Examples
    --------
    >>> Site.from_source(560, 160, scale=0.5)
    Site(width_px=280, height_px=80, scale=0.5, px_per_m=None)
    """

    width_px: int
    height_px: int
    scale: float = 1.0
    px_per_m: float | None = None
    source_px: tuple[float, float] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if not 0 < self.scale < math.inf:
            cure = "Give a share of the source resolution such as 0.5."
            what = f"a scale of {self.scale} is not above 0."
            raise UsageError("E125", what, where="--scale", cure=cure)
        if self.px_per_m is not None and not 0 < self.px_per_m <= 1e9:
            what = f"{self.px_per_m} px in a metre is not a scale."
            cure = "Give a number above 0, up to 1e9, or none for a wall in px."
            raise UsageError("E138", what, where="--px-per-m", cure=cure)
        wall = f"a wall of {self.width_px} x {self.height_px} working pixels"
        if self.width_px < 1 or self.height_px < 1:
            cure = "Give a larger wall or a larger --scale."
            raise UsageError("E121", f"{wall} has no room.", where="--wall", cure=cure)
        if self.width_px * self.height_px > MAX_SITE_PX:
            what = f"{wall} is too large; {MAX_SITE_PX} are the most."
            raise UsageError("E121", what, where="--wall", cure="Give a smaller --scale.")
        least, most = sorted(side / (self.px_per_m or 1.0) for side in self.extent_px)
        if self.px_per_m and not (
            least >= SHORTEST and most <= LONGEST and least * most <= LARGEST
        ):
            what = f"with {self.px_per_m:g} px in a metre the wall is {most:g} x {least:g} m."
            cure = "Give the px of the source image in a metre of the wall."
            raise UsageError("E138", what, where="--px-per-m", cure=cure)

    @classmethod
    def from_source(
        cls, width: float, height: float, scale: float = 1.0, px_per_m: float | None = None
    ) -> "Site":
        """Make the site of a wall given in source px: working size floor(size * scale + 0.5).

        UsageError: E121: it is too small or too large at this scale; E127: its size is not a finite
        number; E125, E138: as of a :class:`Site`.
        """
        if not (math.isfinite(width) and math.isfinite(height)):
            what = f"{width} x {height} px is not a wall size."
            cure = "Give a positive, finite width and height."
            raise UsageError("E127", what, where="--wall", cure=cure)
        known = scale if math.isfinite(scale) else 1.0  # the site itself refuses others
        size = working_px(width, known), working_px(height, known)
        return cls(*size, scale, px_per_m, (width, height))

    @property
    def extent_px(self) -> tuple[float, float]:
        """Width and height in source px: what outlines must stay within."""
        return self.source_px or (self.width_px / self.scale, self.height_px / self.scale)

    @property
    def units_per_px(self) -> float:
        """Length of a working px in the units of the plan: source px, or metres."""
        return 1.0 / (self.scale * (self.px_per_m or 1.0))


def working_px(length_px: float, scale: float) -> int:
    """Turn a length in source px into whole working px: floor(length * scale + 0.5)."""
    return math.floor(length_px * scale + 0.5)
