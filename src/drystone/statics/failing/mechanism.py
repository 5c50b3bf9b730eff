"""How a wall fails, told from its mechanism: contacts, bodies that move as one, and words."""

from collections.abc import Collection
from dataclasses import dataclass

from drystone.statics.failing.bodies import MovingGroup, moving_groups
from drystone.statics.failing.kinematics import ContactKind, Floats, kinematics
from drystone.statics.failing.wording import Names, Noun, in_words
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import Mechanism

TOLERANCE = 1e-4
"""Velocities below this share of the largest one count as none: an interior point method leaves
blocks creeping that a vertex of the program holds still."""


@dataclass(frozen=True, eq=False)
class Failure:
    """A mechanism, described."""

    moving: tuple[int, ...]
    contact_velocity: Floats
    """(m, 2): opening and sliding velocity at every contact point, in the order of the interfaces
    and their points; sliding of the block that the normal (x, y) points into, along (y, -x)."""
    contact_kinds: tuple[ContactKind, ...]
    """The same in words.  The associated flow rule opens a sliding contact by mu times its slip:
    that is "sliding"."""
    groups: tuple[MovingGroup, ...]  # by momentum (area times speed), largest first
    words: str


def describe_mechanism(
    model: RigidBlockModel,
    mechanism: Mechanism,
    *,
    falls: bool = False,
    noun: Noun = "block",
    wedges: Collection[int] = (),
    tolerance: float = TOLERANCE,
) -> Failure:
    """Tell how a wall fails, or falls by itself; wedges are blocks that the words call so.

    A mechanism of a block that the model does not have is a ValueError.  A velocity below
    `tolerance`, a share of the largest, counts as none.
    """
    kin = kinematics(model, mechanism, tolerance)
    groups = moving_groups(kin)
    moving = {block for group in groups for block in group.blocks}
    return Failure(
        moving=tuple(block for block in mechanism.block_ids if block in moving),
        contact_velocity=kin.relative,
        contact_kinds=kin.kinds,
        groups=groups,
        words=in_words(groups, Names(noun, frozenset(wedges)), falls=falls),
    )
