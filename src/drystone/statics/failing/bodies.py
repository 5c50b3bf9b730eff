"""Bodies of a mechanism: blocks that move as one, and how each body moves on the others."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from drystone.statics.failing.kinematics import Bools, Floats, Ints, Kinematics

Motion = Literal["rocking", "sliding", "falling", "mixed"]
Side = Literal["left", "right"]

_STILL = -1

BED = 0.1
"""A joint bears what is above it when its normal points up by at least this much."""


@dataclass(frozen=True)
class Toe:
    """The end of a joint about which a body turns."""

    point: tuple[float, float]  # wall frame
    block: int  # of the body
    other: int  # stays in touch with it there; may be GROUND
    side: Side | None
    """To which side the body tips over it; None when it hangs there rather than stands."""


@dataclass(frozen=True)
class MovingGroup:
    """Blocks that move as one rigid body."""

    blocks: tuple[int, ...]  # ids, ascending
    motion: Motion
    """"rocking": turns about a toe on what stands still, or on another body.  "sliding": slides
    without turning on what stands still, or on another body.  "falling": goes down and touches
    nothing any more.  "mixed": all else, as turning and sliding at once, or being carried by
    several bodies."""
    velocity: tuple[float, float, float]
    """To the right, up, and turning counter-clockwise, at the body's centroid."""
    centroid: tuple[float, float]
    area: float
    speed: float  # of its fastest block, as share of that of the mechanism's fastest
    toe: Toe | None  # what a rocking body turns about
    against: tuple[int, ...]
    """Blocks outside of the body on which it moves as `motion` says, ascending; GROUND among them.
    """
    on_bed: bool  # whether it does so on joints that bear it; False for joints at its sides

    @property
    def centre(self) -> tuple[float, float] | None:
        """Instantaneous centre of rotation in the wall frame; None for what does not turn."""
        vx, vy, turning = self.velocity
        if turning == 0.0:
            return None
        return self.centroid[0] - vy / turning, self.centroid[1] + vx / turning

    @property
    def momentum(self) -> float:
        """Area times speed of the centroid."""
        return self.area * float(np.hypot(*self.velocity[:2]))


def moving_groups(kin: Kinematics) -> tuple[MovingGroup, ...]:
    """Return the bodies of a mechanism by momentum, largest first.

    Two blocks are of one body when a contact point between them neither opens nor slides and they
    do not turn against each other, and through other blocks.
    """
    body = _bodies(kin)
    groups = [_group(kin, body, number) for number in range(int(body.max(initial=_STILL)) + 1)]
    # In shares of the largest and rounded, so that equal ones keep the order of their ids.
    largest = max((group.momentum for group in groups), default=0.0) or 1.0
    return tuple(sorted(groups, key=lambda g: (-round(g.momentum / largest, 9), g.blocks)))


def _bodies(kin: Kinematics) -> Ints:
    """Give every block the number of its body; -1 for all that stands still."""
    moves = kin.speed > kin.least
    rigid = ~(kin.opens | kin.slips) & (np.abs(kin.turning) <= kin.least)
    rigid &= moves[kin.blocks].all(axis=1)
    rows, cols = kin.blocks[rigid].T
    count = len(moves)
    joined = coo_array((np.ones(len(rows)), (rows, cols)), shape=(count, count))
    _, parts = connected_components(joined, directed=False)
    body = np.full(count, _STILL, np.int64)
    body[moves] = np.unique(parts[moves], return_inverse=True)[1]
    return body


def _group(kin: Kinematics, body: Ints, number: int) -> MovingGroup:
    rows = np.flatnonzero(body == number)
    area = kin.area[rows]
    centroid = area @ kin.centroid[rows] / area.sum()
    velocity = area @ kin.velocity[rows] / area.sum()
    if kin.length * abs(velocity[2]) <= kin.least:
        velocity[2] = 0.0
    border = _Border.of(kin, body, number)
    motion, at = border.motion(down=velocity[1] < 0, turning=velocity[2] != 0.0)
    toe = border.toe(at) if motion == "rocking" else None
    vx, vy, turning = velocity.tolist()
    return MovingGroup(
        blocks=tuple(sorted(kin.ids[rows].tolist())),
        motion=motion,
        velocity=(vx, vy, turning),
        centroid=(float(centroid[0]), float(centroid[1])),
        area=float(area.sum()),
        speed=float(kin.speed[rows].max() / kin.speed.max()),
        toe=toe,
        against=tuple(np.unique(kin.ids[border.outside[at]]).tolist()),
        on_bed=bool(border.bears[at].any()),
    )


@dataclass(frozen=True, eq=False)
class _Border:
    """The contact points of a body with others."""

    kin: Kinematics
    contact: Ints  # (k,): which contact points
    inside: Ints  # (k,): rows of their blocks
    outside: Ints  # (k,)
    other: Ints  # (k,): the other body, -1 for what stands still
    turning: Floats  # (k,): of the body against the other one, times the characteristic length
    bears: Bools  # (k,): whether the body stands on it

    @classmethod
    def of(cls, kin: Kinematics, body: Ints, number: int) -> "_Border":
        first, second = body[kin.blocks.T]
        contact = np.flatnonzero((first == number) != (second == number))
        is_first = first[contact] == number
        pairs = np.where(is_first[:, None], kin.blocks[contact], kin.blocks[contact, ::-1])
        sign = np.where(is_first, 1.0, -1.0)
        return cls(
            kin,
            contact,
            pairs[:, 0],
            pairs[:, 1],
            body[pairs[:, 1]],
            sign * kin.turning[contact],
            sign * kin.normal[contact, 1] > BED,
        )

    def motion(self, *, down: bool, turning: bool) -> tuple[Motion, Ints]:
        """Tell how the body moves, and at which of the contact points.

        A body that does not turn itself does not rock, though what touches it may.
        """
        kin, still = self.kin, self.other == _STILL
        opens, slips = kin.opens[self.contact], kin.slips[self.contact]
        turns = np.abs(self.turning) > kin.least
        pivots, slides, kept = ~opens & ~slips & turns, ~opens & slips & ~turns, ~opens & turns
        # What stands still says more than what moves, and what is below more than what is beside.
        for motion, at in (
            ("rocking", pivots & still & self.bears),
            ("rocking", pivots & still),
            ("sliding", slides & still & self.bears),
            ("sliding", slides & self.bears),
            ("rocking", self._on_one(pivots & self.bears)),
            ("mixed", kept & self.bears),
            ("sliding", slides),
            ("rocking", self._on_one(pivots)),
            ("mixed", kept),
        ):
            if at.any() and (turning or motion != "rocking"):
                return motion, np.flatnonzero(at)  # type: ignore[return-value]
        return "falling" if down else "mixed", np.empty(0, np.int64)

    def _on_one(self, pivots: Bools) -> Bools:
        """Return the pivots when they are all on one other body, otherwise none."""
        return pivots & (len(np.unique(self.other[pivots])) == 1)

    def toe(self, at: Ints) -> Toe:
        """Return the lowest of the contact points that a body rocks about."""
        points = self.kin.point[self.contact[at]]
        k = at[np.lexsort((points[:, 0], points[:, 1]))[0]]
        x, y = self.kin.point[self.contact[k]].tolist()
        side: Side | None = None
        if self.bears[k]:
            side = "left" if self.turning[k] > 0 else "right"
        block, other = (int(self.kin.ids[rows[k]]) for rows in (self.inside, self.outside))
        return Toe((x, y), block, other, side)
