"""Settings of exact settling."""

from dataclasses import dataclass
from typing import Literal

from drystone.model.settings import Ranged, ranged

Method = Literal["energy", "pivot"]


@dataclass(frozen=True, kw_only=True)
class SettleSettings(Ranged):
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
    joint_px : float
        Gap to the neighbour on the building side that a stone keeps where it rests with it too: in
        closed joints the errors of a builder add up along a course.
    margin : float
        How far gravity may lean at least until the settled stone moves on rigid neighbours, over
        mu.
    steep : float
        When it is asked whether a stone rests, contacts whose normal goes up by less than this have
        no friction, and those whose normal goes down by more than 0.1 do not count: upright faces
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
    trials : int
        How often a place is tried again with a quarter more than the errors of a hand
        (:mod:`drystone.planner.seats`); where something falls, a stone is laid elsewhere.
    """

    method: Method = "energy"
    outline_px: float = ranged(0.75, above=0, most=1)
    clearance_px: float = ranged(0.01, least=1e-4, within=(0.25, "contact_px"))
    contact_px: float = ranged(0.1, least=0, most=0.5)
    setback: float = ranged(0.01, least=0, most=0.1)
    lean: float = ranged(0.3, least=0)
    joint_px: float = ranged(0.0, least=0)
    margin: float = ranged(0.4, least=0)
    steep: float = ranged(0.3, least=0, below=1)
    beyond_px: float = ranged(0.25, least=0, most=1)
    max_turn_deg: float = ranged(12.0, least=0)
    max_shift: float = ranged(0.5, least=0)
    max_steps: int = ranged(60, least=1)
    spots: int = ranged(3, least=1)
    apart: float = ranged(0.2, least=0)
    shortlist: int = ranged(24, least=1)
    per_stone: int = ranged(4, least=1)
    trials: int = ranged(20, least=0)
