"""How a wall fails, told from its mechanism: contacts, bodies that move as one, and words."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from drystone.statics.failing.bodies import (
    ContactKind,
    Floats,
    MovingGroup,
    kinematics,
    moving_groups,
)
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.result import Mechanism

TOLERANCE = 1e-4
"""Velocities below this share of the largest one count as none: an interior point method leaves
blocks creeping that a vertex of the program holds still."""


Noun = Literal["block", "stone"]

MOST_IDS = 6
"""Longer lists of blocks are shortened to this length."""

MOST_CLAUSES = 4
"""More motions than this are not spelled out."""

VISIBLE = 0.01
"""Bodies slower than this share of the fastest block are left out of the words."""

_VERBS = {
    "rocking": ("Rocking", "rocks", "rock"),
    "tipping": ("Tipping", "tips", "tip"),
    "sliding": ("Sliding", "slides", "slide"),
    "rocking and sliding": ("Rocking and sliding", "rocks and slides", "rock and slide"),
    "carried": ("Shifting", "shifts", "shift"),
    "falling": ("Fall", "falls", "fall"),
    "free": ("Loosening", "comes loose", "come loose"),
}
"""As noun, of one block, of several."""


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
    names: "Names | None" = None,
    tolerance: float = TOLERANCE,
) -> Failure:
    """Tell how a wall fails, or falls by itself, in words that call blocks by their names.

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
        words=in_words(groups, names or Names(), falls=falls),
    )


@dataclass(frozen=True)
class Names:
    """What blocks are called; those that a plan places have their steps by id.

    >>> Names("stone", steps={12: 7}).listed([12])
    'stone 12 (step 7)'
    """

    noun: Noun = "block"
    wedges: frozenset[int] = frozenset()
    steps: Mapping[int, int] = field(default_factory=dict)

    def listed(self, ids: Iterable[int]) -> str:
        """Name blocks: "stones 3, 7 and wedge 301"; long lists are shortened."""
        ordered = sorted(ids, key=lambda i: (i in self.wedges, i))
        wedges = sum(block in self.wedges for block in ordered)
        words = [self._number(block) for block in ordered]
        for noun, first, count in (
            (self.noun, 0, len(words) - wedges),
            ("wedge", len(words) - wedges, wedges),
        ):
            if count:
                words[first] = f"{noun}{'s' if count > 1 else ''} {words[first]}"
        return _shortened(words)

    def place(self, ids: Iterable[int]) -> str:
        """Name what something moves on: "4", "the ground and 4", "wedge 301"."""
        ordered = sorted(ids, key=lambda i: (i != GROUND, i in self.wedges, i))
        return _shortened([self._one(block) for block in ordered])

    def _one(self, block: int) -> str:
        if block == GROUND:
            return "the ground"
        return f"{'wedge ' * (block in self.wedges)}{self._number(block)}"

    def _number(self, block: int) -> str:
        step = self.steps.get(block)
        return str(block) if step is None else f"{block} (step {step})"


def in_words(groups: Iterable[MovingGroup], names: Names, *, falls: bool = False) -> str:
    """Say how bodies move, or fall by themselves, in a sentence, in their order."""
    clauses: dict[tuple[str, str], list[MovingGroup]] = {}
    for group in groups:
        if group.speed >= VISIBLE:
            clauses.setdefault(_motion(group, names, falls), []).append(group)
    if not clauses:
        return "Nothing moves."
    said: list[str] = []
    left = 0
    for (verb, how), alike in clauses.items():
        blocks = [block for group in alike for block in group.blocks]
        if len(said) == MOST_CLAUSES:
            left += len(blocks)
            continue
        manner = how.replace(" about its ", ", each about its ") if len(alike) > 1 else how
        noun, one, several = _VERBS[verb]
        subject = f"{names.listed(blocks)} {one if len(blocks) == 1 else several}"
        if not (said or falls):
            subject = f"{noun} of {names.listed(blocks)}"
        said.append(subject + manner)
    if left:
        said.append(f"{left} others move with them" if left > 1 else "1 other moves with them")
    return ("Falls by itself: " if falls else "") + "; ".join(said) + "."


def _motion(group: MovingGroup, names: Names, falls: bool) -> tuple[str, str]:
    """Return a key of _VERBS, and the rest of the clause."""
    if group.motion == "rocking":
        return "tipping" if falls else "rocking", _about(group, names)
    if group.motion == "falling":
        return "falling", ""
    if not group.against:
        return "free", ""
    verb = "sliding"
    if group.motion == "mixed":
        verb = "rocking and sliding" if group.velocity[2] else "carried"
    return verb, f" {'on' if group.on_bed else 'along'} {names.place(group.against)}"


def _about(group: MovingGroup, names: Names) -> str:
    toe = group.toe
    assert toe is not None  # noqa: S101 - every rocking body has one
    alone = len(group.blocks) == 1
    if toe.side is None:
        member = "it" if alone else names.place([toe.block])
        meets = "touches" if alone else "meets"
        return f" about the point where {member} {meets} {names.place([toe.other])}"
    on = "" if toe.other == GROUND else f", on {names.place([toe.other])}"
    if alone:
        return f" about its {toe.side} toe{on}"
    return f" about the {toe.side} toe of {names.place([toe.block])}{on}"


def _shortened(words: Sequence[str]) -> str:
    if len(words) > MOST_IDS:
        shown = MOST_IDS - 1
        return ", ".join(words[:shown]) + f" ... and {len(words) - shown} more"
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
