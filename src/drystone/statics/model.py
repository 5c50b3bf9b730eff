"""Rigid blocks and the interfaces between them (§4.1)."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

GROUND = 0
"""Id of the ground in interfaces; it is fixed and carries no load."""

NO_SLIP = 1e4
"""Friction above this counts as this, an angle of 89.994 degrees: nothing slides, and beyond it
solvers lose their digits."""

Direction = Literal["left", "right"]

Freedom = Literal["x", "y", "turn"]
FREEDOMS: tuple[Freedom, Freedom, Freedom] = ("x", "y", "turn")
"""What a block may do: move to the right, move up, turn counter-clockwise."""


@dataclass(frozen=True)
class Block:
    """One rigid block."""

    id: int  # positive
    area: float  # in squared lengths of the wall frame
    centroid: tuple[float, float]  # (x, y) in the wall frame, y up
    density: float = 1.0  # weight of a unit of area
    fixed: bool = False
    """A fixed block is part of the ground: it does not move and its weight does not matter."""
    held: tuple[Freedom, ...] = ()
    """What a guide keeps the block from doing; a beam that stays level is held in "turn"."""

    @property
    def weight(self) -> float:
        """Area times density."""
        return self.area * self.density


@dataclass(frozen=True, eq=False)
class Interface:
    """A straight piece of boundary on which two blocks touch."""

    block: int  # id of the block that the normal points into
    other: int  # id of the block on the other side, or GROUND
    points: NDArray[np.float64]
    """(n, 2): contact points in the wall frame: the two ends of the interface, one for a contact at
    a point."""
    normal: tuple[float, float]  # unit vector, from `other` into `block`
    mu: float | None = None  # coefficient of friction here; None for that of the model

    @cached_property
    def length(self) -> float:
        """Distance between its ends; 0 for a contact at a point."""
        return float(np.hypot(*(self.points[-1] - self.points[0])))


@dataclass(frozen=True, eq=False)
class RigidBlockModel:
    """Blocks and interfaces; immutable."""

    blocks: tuple[Block, ...]  # with different ids
    interfaces: tuple[Interface, ...]  # between blocks, or between a block and the ground
    mu: float = 0.58  # coefficient of friction of the interfaces that have none of their own
    added: "Addition | None" = field(default=None, init=False)
    """How it was made from another model by :meth:`with_added`, for what grows along with it."""

    def __repr__(self) -> str:
        counts = f"{len(self.blocks)} blocks, {len(self.interfaces)} interfaces"
        return f"<RigidBlockModel: {counts}, mu {self.mu:g}>"

    def with_added(
        self,
        blocks: tuple[Block, ...],
        interfaces: tuple[Interface, ...],
        closed: tuple[int, ...] = (),
    ) -> "RigidBlockModel":
        """Return the model with a stone and its wedges: new ones come last.

        `closed` are ascending positions in `interfaces` of this model of those that are there no
        more.
        """
        kept = self.interfaces
        for position in reversed(closed):
            kept = kept[:position] + kept[position + 1 :]
        grown = RigidBlockModel(self.blocks + blocks, kept + interfaces, self.mu)
        # Not an argument: a model that `replace` makes of this one was not made by adding.
        object.__setattr__(grown, "added", Addition(self, blocks, interfaces, closed))
        return grown

    def forgetting(self) -> "RigidBlockModel":
        """Return the same model without knowledge of how it was made."""
        return self if self.added is None else replace(self)

    def in_order(self) -> "RigidBlockModel":
        """Return the same model with blocks and interfaces sorted, however it was put together."""
        blocks = sorted(self.blocks, key=lambda block: block.id)
        faces = sorted(self.interfaces, key=lambda f: (f.block, f.other, f.points.tolist()))
        return RigidBlockModel(tuple(blocks), tuple(faces), self.mu)

    def friction(self, interface: Interface) -> float:
        """Return the coefficient of friction of an interface, at most `NO_SLIP`."""
        return min(self.mu if interface.mu is None else interface.mu, NO_SLIP)

    @property
    def mu_idle(self) -> bool:
        """Whether every interface has a friction of its own, so that `mu` changes nothing."""
        return bool(self.interfaces) and all(face.mu is not None for face in self.interfaces)

    @cached_property
    def faces(self) -> Mapping[int, tuple[Interface, ...]]:
        """Interfaces of each block that touches anything, and those of the ground."""
        found = defaultdict[int, list[Interface]](list)
        for interface in self.interfaces:
            found[interface.block].append(interface)
            found[interface.other].append(interface)
        return {block: tuple(faces) for block, faces in found.items()}

    def touched_by(self, block: int) -> list[int]:
        """Return the ids that a block touches, ascending; 0 is the ground."""
        pairs = ((face.block, face.other) for face in self.faces.get(block, ()))
        return sorted({one for pair in pairs for one in pair} - {block})

    @cached_property
    def contact_interfaces(self) -> NDArray[np.int64]:
        """Place of the interface of every contact point (m,)."""
        counts = [len(interface.points) for interface in self.interfaces]
        return np.repeat(np.arange(len(counts)), np.array(counts, np.int64))

    @property
    def contact_count(self) -> int:
        """Number of contact points."""
        return len(self.contact_interfaces)


@dataclass(frozen=True, eq=False)
class Addition:
    """What a stone and its wedges add to a model."""

    base: RigidBlockModel
    blocks: tuple[Block, ...]
    interfaces: tuple[Interface, ...]  # new ones
    closed: tuple[int, ...] = ()
    """Ascending positions in ``base.interfaces`` of contacts at a point that were closed in."""
