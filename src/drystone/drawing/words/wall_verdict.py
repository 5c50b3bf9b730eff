"""The verdict on a wall, with which its report opens."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan, degrees
from types import MappingProxyType

from drystone.drawing.words.analysis import ModelledWall
from drystone.drawing.words.content import FALLS, TILTING, dead_load, is_horizontal
from drystone.statics.failing.mechanism import Failure
from drystone.statics.model import GROUND
from drystone.statics.result import LateralResistance


@dataclass(frozen=True)
class WallVerdict:
    """What is said first: whether a wall stands, and what brings it down.

    `stands` is None when no answer could be certified.
    """

    stands: bool | None
    words: str


def judge_wall(
    subject: str,
    wall: ModelledWall,
    resistance: LateralResistance,
    *,
    load_case: str = TILTING,
    without_dilatancy: Mapping[str, float | None] = MappingProxyType({}),
) -> WallVerdict:
    """Judge a wall of which `subject` says how large it is, such as "28 of 30 stones".

    `without_dilatancy` are load multipliers by Coulomb's law, by direction, where they are known:
    the least of all is what the wall is told to carry.
    """
    if resistance.failed:
        words = f"{subject}; not known whether it stands: no answer could be certified"
        return WallVerdict(None, words)
    failures = wall.failures((resistance.left, resistance.right))
    if not resistance.stable:
        why = wall.why_it_falls(failures).removeprefix("Falls by itself: ").rstrip(".")
        return WallVerdict(False, f"{subject}, {FALLS}: {why[:1].lower()}{why[1:]}")
    both = [(end.alpha, str(end.direction)) for end in (resistance.left, resistance.right)]
    both += [(alpha, direction) for direction, alpha in without_dilatancy.items()]
    known = [(alpha, direction) for alpha, direction in both if alpha is not None]
    if not known:
        return WallVerdict(True, f"{subject}, stands; no load of this kind brings it down")
    alpha, direction = min(known)
    words = f"{subject}, stands; {_load(alpha, load_case)}"
    if direction in failures:
        words += f"; weakest place: {_weakest_place(wall, failures[direction])}"
    return WallVerdict(True, words)


def _load(alpha: float, load_case: str) -> str:
    """Say what brings a wall down."""
    if load_case != TILTING:
        of = f"the {dead_load(load_case)}" if is_horizontal(load_case) else "the live load"
        return f"carries {alpha:.3f} times {of} ({load_case})"
    if alpha <= 0.0:
        return "can fall when it is let go"
    angle = degrees(atan(alpha))
    return f"falls when tilted by {angle:.{0 if angle >= 10.0 else 1}f} degrees"


def _weakest_place(wall: ModelledWall, failure: Failure) -> str:
    """Name what moves first where it turns about or slides: as the words of the failure begin."""
    if not failure.groups:
        return "not known"
    first = failure.groups[0]
    if first.toe is None and GROUND in first.against:
        return "the joint with the ground"
    return wall.names.listed(first.blocks if first.toe is None else [first.toe.block])
