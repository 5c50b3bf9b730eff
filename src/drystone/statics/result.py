"""What the limit analysis returns: load multipliers, how the wall fails, and their certificate."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from drystone.statics.model import Direction

Floats = NDArray[np.float64]

CERTIFIED = 1e-8
"""Largest error of a certificate that holds, relative to the mean weight of a block."""


class LimitStatus(StrEnum):
    """How a limit analysis ended; a status is never a number."""

    OPTIMAL = "optimal"
    UNSTABLE = "unstable"
    """The blocks do not stand under their dead load."""
    UNBOUNDED = "unbounded"
    FAILED = "failed"
    """The solver gave up, or no answer of it could be certified."""


@dataclass(frozen=True, eq=False)
class Mechanism:
    """How the wall fails: the velocity of each block, up to a common factor."""

    block_ids: tuple[int, ...]  # free blocks in the order of the rows of `velocity`
    velocity: Floats
    """(n, 3): horizontal and vertical velocity of the centroid (wall frame) and rate of turning,
    counter-clockwise, per block; the largest displacement of a centroid is 1."""


@dataclass(frozen=True)
class Certificate:
    """Proof of an answer: a state of forces bounds alpha on one side, a mechanism on the other.

    Forces in equilibrium and within friction show that the wall carries `lower`.  A mechanism that
    closes no contact and dilates as the associated flow rule says shows that it carries no more
    than `upper`, its balance of work.  The wall falls by itself when its dead load does work on
    such a mechanism.  All errors are in mean weights of a block and relative to the largest
    velocity.
    """

    residual: float = 0.0  # largest force or moment on a block that is not balanced
    violation: float = 0.0  # largest force by which a contact point leaves its cone of friction
    inadmissible: float = 0.0
    """Largest rate at which the mechanism closes a contact or slides without dilating."""
    lower: float | None = None
    """Load multiplier of the forces, signed along the live load (below 0 to the left); infinite
    when a growing state of self-stress carries any load."""
    upper: float | None = None  # that of the mechanism
    slack: float | None = None
    """How far alpha could lie beyond `upper` because the mechanism closes contacts by
    `inadmissible`, with forces as large in sum as those found.  `holds` does not look at it."""
    fall_work: float | None = None
    """Work of the dead load on the mechanism, for walls that do not stand."""

    @property
    def gap(self) -> float | None:
        """|upper - lower| / max(1, |lower|); None unless there are both."""
        if self.lower is None or self.upper is None:
            return None
        return abs(self.upper - self.lower) / max(1.0, abs(self.lower))

    @property
    def balances(self) -> bool:
        """True when the forces balance the loads within friction, up to `CERTIFIED`."""
        return self.residual <= CERTIFIED and self.violation <= CERTIFIED

    @property
    def holds(self) -> bool:
        """True when every error is at most `CERTIFIED`; never for what is no number."""
        if not (self.balances and self.inadmissible <= CERTIFIED):
            return False
        if self.fall_work is not None:
            return self.fall_work > self.inadmissible
        if self.lower is not None and np.isinf(self.lower):
            return True
        return self.gap is not None and self.gap <= CERTIFIED


@dataclass(frozen=True, eq=False)
class LimitResult:
    """Outcome of one limit analysis."""

    status: LimitStatus
    direction: Direction
    """"right" for a load along the live load (towards +x on the tilting table), "left" against."""
    alpha: float | None = None
    """Load multiplier; None unless the status is "optimal"."""
    mechanism: Mechanism | None = field(default=None, repr=False)
    """How the blocks move at that load, or fall by themselves when the status is "unstable"; when
    it was asked for."""
    forces: Floats | None = field(default=None, repr=False)
    """(m, 2): normal and tangential force at every contact point, in the order of the interfaces
    and their points, on the block that the normal points into; the tangent of a normal (x, y) is
    (y, -x).  In weights of the model; when it was asked for."""
    certificate: Certificate | None = None
    """None when the solver gave up."""
    message: str = ""  # what the solver said, for people
    solver: str = ""  # which one answered

    @property
    def success(self) -> bool:
        """True when the status is "optimal"."""
        return self.status is LimitStatus.OPTIMAL


@dataclass(frozen=True, eq=False)
class LoadRange:
    """All alpha for which dead + alpha live can be carried: an interval."""

    least: LimitResult
    """Its ends, `alpha` of either sign along the live load.  Both are "unstable" when there is no
    such alpha."""
    greatest: LimitResult


@dataclass(frozen=True, eq=False)
class LateralResistance:
    """Both directions of the tilting table (Eq. 28)."""

    left: LimitResult  # live load towards -x
    right: LimitResult
    mu: float  # coefficient of friction; 0 where every interface has one of its own

    @property
    def value(self) -> float | None:
        """min(alpha_left, alpha_right) / mu (Eq. 11, Eq. 28).

        None unless both are optimal, and without friction.
        """
        if self.left.alpha is None or self.right.alpha is None or self.mu == 0:
            return None
        return min(self.left.alpha, self.right.alpha) / self.mu

    @property
    def one_sided(self) -> bool:
        """True when one side is only proved to carry `alpha`, as much as the weaker one.

        A search asks no more of candidates.
        """
        proofs = (side.certificate for side in (self.left, self.right) if side.success)
        return any(proof is not None and proof.upper is None for proof in proofs)

    @property
    def failed(self) -> bool:
        """True when the solver gave up on either direction: nothing is known then."""
        return LimitStatus.FAILED in (self.left.status, self.right.status)

    @property
    def stable(self) -> bool:
        """True when the wall stands under its own weight, by both analyses.

        It does where nothing limits the load in a direction, too.
        """
        stands = (LimitStatus.OPTIMAL, LimitStatus.UNBOUNDED)
        return self.left.status in stands and self.right.status in stands
