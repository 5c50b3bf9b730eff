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
    """A mechanism, described.

    Parameters
    ----------
    moving : tuple of int
        Blocks that move, in the order of the mechanism.
    contact_velocity : (m, 2) float array
        Opening and sliding velocity at every contact point, in the order of the interfaces and
        their points; sliding of the block that the normal (x, y) points into, along (y, -x).
    contact_kinds : tuple of {"closed", "opening", "sliding", "opening and sliding"}
        The same in words.  The associated flow rule opens a sliding contact by mu times its
        slip: that is "sliding".
    groups : tuple of MovingGroup
        By momentum (area times speed), largest first.
    words : str
        A sentence for an engineer.
    """

    moving: tuple[int, ...]
    contact_velocity: Floats
    contact_kinds: tuple[ContactKind, ...]
    groups: tuple[MovingGroup, ...]
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
    """Tell how a wall fails.

    Parameters
    ----------
    model : RigidBlockModel
        The wall.
    mechanism : Mechanism
        Of this model.
    falls : bool
        True when the wall does not stand by itself and the mechanism is its fall.
    noun : {"block", "stone"}
        What the words call a block.
    wedges : collection of int
        Blocks that the words call wedges.
    tolerance : float
        Share of the largest velocity below which one counts as none.

    Returns
    -------
    Failure

    Raises
    ------
    ValueError
        When the mechanism moves a block that the model does not have.

    Examples
    --------
    >>> from drystone.contacts.given import model_from_json
    >>> from drystone.statics.limit import limit_load
    >>> tower = model_from_json({"blocks_xywh": [[0, 0, 6, 1], [2, 1, 1, 2], [2, 3, 1, 2]]})
    >>> result = limit_load(tower, "right", mechanism=True)
    >>> describe_mechanism(tower, result.mechanism).words
    'Rocking of blocks 2 and 3 about the right toe of 2, on 1.'
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
