"""How a polygon settles on others, and how that ends."""

from enum import IntEnum
from typing import NamedTuple


class Status(IntEnum):
    """How settling ended."""

    RESTS = 0
    FALLS = 1
    """Nothing is to be gained without friction, but with it the stone would move."""
    OVERLAPS = 2
    FAR = 3
    """It turned or slid further than it may."""
    UNFINISHED = 4
    """It still moved after the last step."""


class Rules(NamedTuple):
    """How a stone settles; lengths in the unit of the polygons."""

    lean: float  # gravity towards -x over gravity downwards
    # stop as soon as the stone rests with this margin; below 0: only where nothing is gained
    stop: float
    mu: float  # coefficient of friction of the rest test, above 0
    clearance: float  # gap that is left, above 0
    tolerance: float  # gaps up to this one touch, in the rest test
    corner: float  # two corners nearer than this meet with the face that parts them best
    near: float  # first and largest radius of a step
    far: float
    turn: float  # largest turn, radians
    shift: float  # largest shift aside
    gain: float  # settling ends where a step would go down by no more; not below 0
    overlap: float  # so deep a stone may overlap at the start; it is then brought apart first
    # contacts whose normal goes up by less than this have no friction in the rest test; -1:
    # all have
    steep: float
    beyond: float  # how far the stone may stand out over the ends of the wall
    # the supporting point nearest to the centroid does not slide: the stone rolls about it
    sticks: bool
    turns: bool  # whether the stone may turn
    steps: int  # most steps


class Settling(NamedTuple):
    """Outcome of settling."""

    status: Status
    x: float  # of the centroid
    y: float
    angle: float  # radians
    gap: float  # smallest gap there
    # how far gravity may lean until the stone moves, over mu; -1 when it does not rest
    margin: float
    steps: int
    touching: int  # contacts
