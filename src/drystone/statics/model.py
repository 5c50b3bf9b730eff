"""Rigid blocks, the interfaces between them, and what the limit analysis returns (§4.1)."""

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

GROUND = 0
"""Id of the ground in interfaces; it is fixed and carries no load."""

Direction = Literal["left", "right"]


class LimitStatus(StrEnum):
    """How a limit analysis ended; a status is never a number."""

    OPTIMAL = "optimal"
    UNSTABLE = "unstable"
    """The blocks do not stand under their own weight."""
    UNBOUNDED = "unbounded"
    FAILED = "failed"
    """The solver gave up."""


@dataclass(frozen=True)
class Block:
    """One rigid block.

    Parameters
    ----------
    id : int
        Positive.
    area : float
        In squared lengths of the wall frame.
    centroid : (float, float)
        (x, y) in the wall frame, y up.
    density : float
        Weight of a unit of area.
    fixed : bool
        A fixed block is part of the ground: it does not move and its weight does not matter.
    """

    id: int
    area: float
    centroid: tuple[float, float]
    density: float = 1.0
    fixed: bool = False

    @property
    def weight(self) -> float:
        """Area times density."""
        return self.area * self.density


@dataclass(frozen=True, eq=False)
class Interface:
    """A straight piece of boundary on which two blocks touch.

    Parameters
    ----------
    block : int
        Id of the block that the normal points into.
    other : int
        Id of the block on the other side, or GROUND.
    points : (n, 2) float array
        Contact points in the wall frame: the two ends of the interface, one for a contact at a
        point.
    normal : (float, float)
        Unit vector, from `other` into `block`.
    """

    block: int
    other: int
    points: NDArray[np.float64]
    normal: tuple[float, float]

    @cached_property
    def length(self) -> float:
        """Distance between its ends; 0 for a contact at a point."""
        return float(np.hypot(*(self.points[-1] - self.points[0])))


@dataclass(frozen=True, eq=False)
class RigidBlockModel:
    """Blocks and interfaces; immutable.

    Parameters
    ----------
    blocks : tuple of Block
        With different ids.
    interfaces : tuple of Interface
        Between blocks, or between a block and the ground.
    mu : float
        Coefficient of friction, the same everywhere.
    """

    blocks: tuple[Block, ...]
    interfaces: tuple[Interface, ...]
    mu: float = 0.58

    @cached_property
    def contact_count(self) -> int:
        """Number of contact points."""
        return sum(len(interface.points) for interface in self.interfaces)


@dataclass(frozen=True, eq=False)
class Mechanism:
    """How the wall fails: the velocity of each block, up to a common factor.

    Parameters
    ----------
    block_ids : tuple of int
        Free blocks in the order of the rows of `velocity`.
    velocity : (n, 3) float array
        Horizontal and vertical velocity of the centroid (wall frame) and rate of turning,
        counter-clockwise, per block; the largest displacement of a centroid is 1.
    """

    block_ids: tuple[int, ...]
    velocity: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LimitResult:
    """Outcome of one limit analysis.

    Parameters
    ----------
    status : LimitStatus
        How it ended.
    direction : {"left", "right"}
        The live load points to -x for "left".
    alpha : float or None
        Load multiplier; None unless the status is "optimal".
    mechanism : Mechanism or None
        From the dual solution, when it was asked for and exists.
    message : str
        What the solver said, for people.
    """

    status: LimitStatus
    direction: Direction
    alpha: float | None = None
    mechanism: Mechanism | None = None
    message: str = ""

    @property
    def success(self) -> bool:
        """True when the status is "optimal"."""
        return self.status is LimitStatus.OPTIMAL


@dataclass(frozen=True, eq=False)
class LateralResistance:
    """Both directions of the tilting table (Eq. 28).

    Parameters
    ----------
    left, right : LimitResult
        Live load towards -x and towards +x.
    mu : float
        Coefficient of friction.
    """

    left: LimitResult
    right: LimitResult
    mu: float

    @property
    def value(self) -> float | None:
        """min(alpha_left, alpha_right) / mu (Eq. 11, Eq. 28).

        None unless both are optimal, and without friction.
        """
        if self.left.alpha is None or self.right.alpha is None or self.mu == 0:
            return None
        return min(self.left.alpha, self.right.alpha) / self.mu

    @property
    def failed(self) -> bool:
        """True when the solver gave up on either direction: nothing is known then."""
        return LimitStatus.FAILED in (self.left.status, self.right.status)

    @property
    def stable(self) -> bool:
        """True when the wall stands under its own weight, by both analyses."""
        return self.left.success and self.right.success
