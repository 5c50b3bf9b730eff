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
    """How a stone settles; lengths in the unit of the polygons.

    Parameters
    ----------
    lean : float
        Gravity towards -x over gravity downwards.
    stop : float
        Stop as soon as the stone rests with this margin; below 0: only where nothing is gained.
    mu : float
        Coefficient of friction of the rest test, above 0.
    clearance : float
        Gap that is left, above 0.
    tolerance : float
        Gaps up to this one touch, in the rest test.
    corner : float
        Two corners nearer than this meet with the face that parts them best.
    near, far : float
        First and largest radius of a step.
    turn : float
        Largest turn, radians.
    shift : float
        Largest shift aside.
    gain : float
        Settling ends where a step would go down by no more; not below 0.
    overlap : float
        So deep a stone may overlap at the start; it is then brought apart first.
    steep : float
        Contacts whose normal goes up by less than this have no friction in the rest test; -1:
        all have.
    beyond : float
        How far the stone may stand out over the ends of the wall.
    sticks : bool
        The supporting point nearest to the centroid does not slide: the stone rolls about it.
    turns : bool
        Whether the stone may turn.
    steps : int
        Most steps.
    """

    lean: float
    stop: float
    mu: float
    clearance: float
    tolerance: float
    corner: float
    near: float
    far: float
    turn: float
    shift: float
    gain: float
    overlap: float
    steep: float
    beyond: float
    sticks: bool
    turns: bool
    steps: int


class Settling(NamedTuple):
    """Outcome of settling.

    Parameters
    ----------
    status : Status
        How it ended.
    x, y, angle : float
        Where: the centroid, and the turn in radians.
    gap : float
        Smallest gap there.
    margin : float
        How far gravity may lean until the stone moves, over mu; -1 when it does not rest.
    steps : int
        How many were made.
    touching : int
        Contacts.
    """

    status: Status
    x: float
    y: float
    angle: float
    gap: float
    margin: float
    steps: int
    touching: int
