"""Settings of exact settling."""

from dataclasses import dataclass
from typing import Literal

Method = Literal["energy", "pivot"]


@dataclass(frozen=True, kw_only=True)
class SettleSettings:
    """How stones settle on the outlines of others (§3.7; DESIGN 4.9).

    Lengths in source px; `size` is the root of a stone's area.

    Parameters
    ----------
    method : {"energy", "pivot"}
        ``"energy"``: down to the least energy without friction, gravity leaning to the building
        side; ``"pivot"``: as the paper words it, a stone rolls about its supporting point without
        slipping until it rests.
    outline_px : float
        How far outlines may stay away from the contour of the pixels.
    clearance_px : float
        Gap that settled stones are left, and keep at least half of.
    contact_px : float
        Gaps up to this one are contacts, in the rest test and in the limit analysis.
    setback : float
        Contacts of the limit analysis stay away from the ends of faces by this share of the size
        of the smaller stone (DESIGN 4.8).
    lean : float
        Gravity to the building side over gravity downwards, for ``"energy"``.
    margin : float
        How far gravity may lean at least until the settled stone moves on rigid neighbours, over
        mu.
    steep : float
        When it is asked whether a stone rests, contacts whose normal goes up by less than this have
        no friction, and those whose normal goes down by more than .1 do not count: upright faces
        and hooks hold only what was pressed in between before.
    beyond_px : float
        How far a stone may stand out over the ends and the top of the wall: the clearances of a
        course add up.
    max_turn_deg : float
        Largest turn while settling.
    max_shift : float
        Largest shift aside, over the stone's size.
    max_steps : int
        Most steps.
    spots : int
        Places that are proposed for each pose.
    apart : float
        Least distance between these, over the stone's size.
    shortlist : int
        Proposals that are settled in a step, the cheapest ones.
    per_stone : int
        Most of them of one stone.
    """

    method: Method = "energy"
    outline_px: float = 0.35
    clearance_px: float = 0.01
    contact_px: float = 0.1
    setback: float = 0.01
    lean: float = 0.3
    margin: float = 0.2
    steep: float = 0.3
    beyond_px: float = 0.25
    max_turn_deg: float = 12.0
    max_shift: float = 0.5
    max_steps: int = 60
    spots: int = 3
    apart: float = 0.2
    shortlist: int = 24
    per_stone: int = 4

    def __post_init__(self) -> None:
        if self.method not in ("energy", "pivot"):
            raise ValueError(f"unknown way of settling {self.method!r}")
        if not 1e-4 <= self.clearance_px or not 4 * self.clearance_px <= self.contact_px <= 0.5:
            raise ValueError("clearance_px must be .0001 or more, contact_px 4 times it to .5")
        # Beyond these a plan would no longer speak of the stones of the picture.
        if not 0 < self.outline_px <= 0.5 or not 0 <= self.beyond_px <= 1:
            raise ValueError("outline_px must be in (0, .5], beyond_px in [0, 1]")
        if not 0 <= self.setback <= 0.1:
            raise ValueError("setback must be in [0, .1]")
        if not 0 <= self.steep < 1:
            raise ValueError("steep must be in [0, 1)")
        if (
            min(
                self.lean,
                self.margin,
                self.max_turn_deg,
                self.max_shift,
                self.apart,
            )
            < 0
        ):
            raise ValueError("lean, margin and limits must not be negative")
        if min(self.max_steps, self.spots, self.shortlist, self.per_stone) < 1:
            raise ValueError("steps, spots and the shortlist must be positive")
