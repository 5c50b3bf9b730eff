"""Words for how a wall fails, as an engineer would say them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from drystone.statics.failing.bodies import MovingGroup
from drystone.statics.model import GROUND

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


@dataclass(frozen=True)
class Names:
    """What blocks are called."""

    noun: Noun = "block"
    wedges: frozenset[int] = frozenset()

    def listed(self, ids: Iterable[int]) -> str:
        """Name blocks: "stones 3, 7 and wedge 301"; long lists are shortened."""
        ordered = sorted(ids, key=lambda i: (i in self.wedges, i))
        wedges = sum(block in self.wedges for block in ordered)
        words = [str(block) for block in ordered]
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
        return f"wedge {block}" if block in self.wedges else str(block)


@dataclass(frozen=True)
class _Clause:
    """One motion of one body, or of several that move alike."""

    verb: str
    blocks: tuple[int, ...]
    how: str
    bodies: int


def in_words(groups: Sequence[MovingGroup], names: Names, *, falls: bool = False) -> str:
    """Say how bodies move, or fall by themselves, in a sentence, in their order."""
    clauses = _clauses([group for group in groups if group.speed >= VISIBLE], names, falls)
    if not clauses:
        return "Nothing moves."
    told = [_verb_form(clause, names) for clause in clauses[:MOST_CLAUSES]]
    if not falls:
        first = clauses[0]
        told[0] = f"{_VERBS[first.verb][0]} of {names.listed(first.blocks)}{_how(first)}"
    left = sum(len(clause.blocks) for clause in clauses[MOST_CLAUSES:])
    if left:
        told.append(f"{left} others move with them" if left > 1 else "1 other moves with them")
    return ("Falls by itself: " if falls else "") + "; ".join(told) + "."


def _clauses(groups: Iterable[MovingGroup], names: Names, falls: bool) -> list[_Clause]:
    clauses: dict[tuple[str, str], _Clause] = {}
    for group in groups:
        verb, how = _motion(group, names, falls)
        known = clauses.get((verb, how), _Clause(verb, (), how, 0))
        blocks = (*known.blocks, *group.blocks)
        clauses[verb, how] = _Clause(verb, blocks, how, known.bodies + 1)
    return list(clauses.values())


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


def _verb_form(clause: _Clause, names: Names) -> str:
    verb = _VERBS[clause.verb][1 if len(clause.blocks) == 1 else 2]
    return f"{names.listed(clause.blocks)} {verb}{_how(clause)}"


def _how(clause: _Clause) -> str:
    if clause.bodies > 1:
        return clause.how.replace(" about its ", ", each about its ")
    return clause.how


def _shortened(words: Sequence[str]) -> str:
    if len(words) > MOST_IDS:
        shown = MOST_IDS - 1
        return ", ".join(words[:shown]) + f" ... and {len(words) - shown} more"
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
