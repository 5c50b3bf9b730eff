"""The place where the wall goes up, and the lengths that turn it into pixels."""

import math
from dataclasses import dataclass, field

from drystone.errors import UsageError

MAX_SITE_PX = 50_000_000
"""A larger wall fills the memory; its stones are many times finer than planning needs."""


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
        wall = f"a wall of {self.width_px} x {self.height_px} working pixels"
        if self.width_px < 1 or self.height_px < 1:
            cure = "Give a larger wall or a larger --scale."
            raise UsageError("E121", f"{wall} has no room.", where="--wall", cure=cure)
        if self.width_px * self.height_px > MAX_SITE_PX:
            what = f"{wall} is too large; {MAX_SITE_PX} are the most."
            raise UsageError("E121", what, where="--wall", cure="Give a smaller --scale.")

    @classmethod
    def from_source(
        cls, width: float, height: float, scale: float = 1.0, px_per_m: float | None = None
    ) -> "Site":
        """Make the site of a wall given in source px: working size floor(size * scale + 0.5).

        UsageError: E121: it is too small or too large at this scale; E127: its size is not a finite
        number; E138: the px in a metre are not positive.
        """
        if not (math.isfinite(width) and math.isfinite(height)):
            what = f"{width} x {height} px is not a wall size."
            cure = "Give a positive, finite width and height."
            raise UsageError("E127", what, where="--wall", cure=cure)
        if px_per_m is not None and not 0 < px_per_m < math.inf:
            what = f"{px_per_m} px in a metre is not a scale."
            cure = "Give a positive number, or none for a wall in px."
            raise UsageError("E138", what, where="--px-per-m", cure=cure)
        size = working_px(width, scale), working_px(height, scale)
        # Floats of 32 bits would round what is divided by the scale.
        px_per_m = None if px_per_m is None else float(px_per_m)
        return cls(*size, float(scale), px_per_m, (float(width), float(height)))

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
