"""Velocities of blocks and at contact points, from a mechanism."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import Mechanism

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ContactKind = Literal["closed", "opening", "sliding", "opening and sliding"]
_KINDS: tuple[ContactKind, ...] = ("closed", "opening", "sliding", "opening and sliding")


@dataclass(frozen=True, eq=False)
class Kinematics:
    """A mechanism on the contacts of its model."""

    ids: Ints
    """(n + 1,): of every block, the ground last; what the mechanism does not name stands still."""
    area: Floats  # (n + 1,)
    centroid: Floats  # (n + 1, 2)
    velocity: Floats  # (n + 1, 3)
    blocks: Ints
    """(m, 2): rows of the two blocks at every contact point, first the one that the normal points
    into."""
    point: Floats  # (m, 2): where, and the normal of its interface
    normal: Floats  # (m, 2)
    friction: Floats  # (m,): coefficient of friction
    length: float  # characteristic length: root of the mean area of a block
    tolerance: float  # share of the largest velocity below which one counts as none

    @cached_property
    def speed(self) -> Floats:
        """Of every block: of its centroid, or of its turning at the characteristic length."""
        centroid = np.hypot(self.velocity[:, 0], self.velocity[:, 1])
        return np.maximum(centroid, self.length * np.abs(self.velocity[:, 2]))

    @cached_property
    def least(self) -> float:
        """Velocity from which on one counts."""
        return self.tolerance * float(self.speed.max())

    @cached_property
    def relative(self) -> Floats:
        """Opening and sliding velocity at every contact point, sliding along (y, -x)."""
        first, second = (self._at_contacts(side) for side in (0, 1))
        apart = first - second
        tangent = np.column_stack((self.normal[:, 1], -self.normal[:, 0]))
        return np.column_stack(((apart * self.normal).sum(axis=1), (apart * tangent).sum(axis=1)))

    @cached_property
    def turning(self) -> Floats:
        """Turning of the first block against the second at every contact, times `length`."""
        first, second = self.velocity[self.blocks.T, 2]
        return np.asarray(self.length * (first - second))

    @cached_property
    def slips(self) -> Bools:
        """Whether the blocks slip along a contact point."""
        return np.asarray(np.abs(self.relative[:, 1]) > self.least)

    @cached_property
    def opens(self) -> Bools:
        """Whether a contact point opens by more than the dilatancy of its slip."""
        dilatancy = self.friction * np.abs(self.relative[:, 1])
        return np.asarray(self.relative[:, 0] - dilatancy > self.least)

    @property
    def kinds(self) -> tuple[ContactKind, ...]:
        """Opening and slip in words."""
        codes = self.opens.astype(int) + 2 * self.slips.astype(int)
        return tuple(_KINDS[code] for code in codes.tolist())

    def _at_contacts(self, side: int) -> Floats:
        rows = self.blocks[:, side]
        arm = self.point - self.centroid[rows]
        along_x, along_y, turning = self.velocity[rows].T
        return np.column_stack((along_x - turning * arm[:, 1], along_y + turning * arm[:, 0]))


def kinematics(model: RigidBlockModel, mechanism: Mechanism, tolerance: float) -> Kinematics:
    """Lay a mechanism over the contacts of its model; ValueError for a block that it lacks."""
    place = {block.id: row for row, block in enumerate(model.blocks)} | {GROUND: len(model.blocks)}
    missing = sorted(set(mechanism.block_ids) - place.keys())
    if missing:
        raise ValueError(f"the mechanism moves blocks that the model lacks: {missing}")
    velocity = np.zeros((len(place), 3))
    velocity[[place[block] for block in mechanism.block_ids]] = mechanism.velocity
    area = np.array([block.area for block in model.blocks])
    counts = [len(interface.points) for interface in model.interfaces]
    which = np.repeat(np.arange(len(counts)), np.array(counts, np.int64))
    pairs = [(place[i.block], place[i.other]) for i in model.interfaces]
    normals = np.array([i.normal for i in model.interfaces], float).reshape(-1, 2)
    friction = np.array([model.friction(i) for i in model.interfaces], float)
    return Kinematics(
        ids=np.array([*(block.id for block in model.blocks), GROUND], np.int64),
        area=np.append(area, 0.0),
        centroid=np.array([*(block.centroid for block in model.blocks), (0.0, 0.0)]),
        velocity=velocity,
        blocks=np.array(pairs, np.int64).reshape(-1, 2)[which],
        point=np.concatenate([np.empty((0, 2)), *(i.points for i in model.interfaces)]),
        normal=normals[which],
        friction=friction[which],
        length=float(np.sqrt(area.mean())) if len(area) else 1.0,
        tolerance=tolerance,
    )
