"""How a wall fails, told from its mechanism: contacts, bodies that move as one, and words."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from drystone.statics.model import GROUND, Direction, RigidBlockModel
from drystone.statics.result import Floats, Mechanism

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ContactKind = Literal["closed", "opening", "sliding", "opening and sliding"]
_KINDS: tuple[ContactKind, ...] = ("closed", "opening", "sliding", "opening and sliding")
MotionKind = Literal["rocking", "sliding", "falling", "mixed"]

_STILL = -1

TOLERANCE = 1e-4
"""Velocities below this share of the largest one count as none: an interior point method leaves
blocks creeping that a vertex of the program holds still."""

BED = 0.1
"""A joint bears what is above it when its normal points up by at least this much."""


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

    @cached_property
    def speed(self) -> Floats:
        """Of every block: of its centroid, or of its turning at the characteristic length."""
        centroid = np.hypot(self.velocity[:, 0], self.velocity[:, 1])
        return np.maximum(centroid, self.length * np.abs(self.velocity[:, 2]))

    @cached_property
    def least(self) -> float:
        """Velocity from which on one counts."""
        return TOLERANCE * float(self.speed.max())

    @cached_property
    def relative(self) -> Floats:
        """Opening and sliding velocity at every contact point.

        Sliding is that of the block that the normal (x, y) points into, along (y, -x).
        """
        velocities = []
        for rows in self.blocks.T:
            arm = self.point - self.centroid[rows]
            along_x, along_y, turning = self.velocity[rows].T
            at = np.column_stack((along_x - turning * arm[:, 1], along_y + turning * arm[:, 0]))
            velocities.append(at)
        apart = velocities[0] - velocities[1]
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


def kinematics(model: RigidBlockModel, mechanism: Mechanism) -> Kinematics:
    """Lay a mechanism over the contacts of its model; ValueError for a block that it lacks."""
    place = {block.id: row for row, block in enumerate(model.blocks)} | {GROUND: len(model.blocks)}
    missing = sorted(set(mechanism.block_ids) - place.keys())
    if missing:
        raise ValueError(f"the mechanism moves blocks that the model lacks: {missing}")
    velocity = np.zeros((len(place), 3))
    velocity[[place[block] for block in mechanism.block_ids]] = mechanism.velocity
    area = np.array([block.area for block in model.blocks])
    which = model.contact_interfaces
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
    )


@dataclass(frozen=True)
class Toe:
    """The end of a joint about which a body turns."""

    point: tuple[float, float]  # wall frame
    block: int  # of the body
    other: int  # stays in touch with it there; may be GROUND
    side: Direction | None
    """To which side the body tips over it; None when it hangs there rather than stands."""


@dataclass(frozen=True)
class MovingGroup:
    """Blocks that move as one rigid body.

    Two blocks are of one body when a contact point between them neither opens nor slides and they
    do not turn against each other, and through other blocks.
    """

    blocks: tuple[int, ...]  # ids, ascending
    motion: MotionKind
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
    slips: bool  # whether it slips along one of them

    @property
    def momentum(self) -> float:
        """Area times speed of the centroid."""
        return self.area * float(np.hypot(*self.velocity[:2]))


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

    # Its contact points with others: rows of their blocks, and how it turns against the other one.
    first, second = body[kin.blocks.T]
    contact = np.flatnonzero((first == number) != (second == number))
    is_first = first[contact] == number
    pairs = np.where(is_first[:, None], kin.blocks[contact], kin.blocks[contact, ::-1])
    inside, outside = pairs.T
    sign = np.where(is_first, 1.0, -1.0)
    turning = sign * kin.turning[contact]
    bears = sign * kin.normal[contact, 1] > BED  # it stands on these
    opens, slips = kin.opens[contact], kin.slips[contact]
    turns = np.abs(turning) > kin.least
    pivots, slides, kept = ~opens & ~slips & turns, ~opens & slips & ~turns, ~opens & turns
    other = body[outside]
    still = other == _STILL

    def on_one(pivots: Bools) -> Bools:
        """Return the pivots when they are all on one other body, otherwise none."""
        return pivots & (len(np.unique(other[pivots])) == 1)

    # What stands still says more than what moves, and what is below more than what is beside.
    ways: tuple[tuple[MotionKind, Bools], ...] = (
        ("rocking", pivots & still & bears),
        ("rocking", pivots & still),
        ("sliding", slides & still & bears),
        ("sliding", slides & bears),
        ("rocking", on_one(pivots & bears)),
        ("mixed", kept & bears),
        ("sliding", slides),
        ("rocking", on_one(pivots)),
        ("mixed", kept),
    )
    motion: MotionKind = "falling" if velocity[1] < 0 else "mixed"
    at, toe = np.empty(0, np.int64), None
    for kind, those in ways:
        # A body that does not turn itself does not rock, though what touches it may.
        if those.any() and (velocity[2] != 0.0 or kind != "rocking"):
            motion, at = kind, np.flatnonzero(those)
            break
    if motion == "rocking":  # about the lowest point
        points = kin.point[contact[at]]
        k = at[np.lexsort((points[:, 0], points[:, 1]))[0]]
        x, y = kin.point[contact[k]].tolist()
        side: Direction = "left" if turning[k] > 0 else "right"
        block, neighbour = (int(kin.ids[row[k]]) for row in (inside, outside))
        toe = Toe((x, y), block, neighbour, side if bears[k] else None)
    vx, vy, turn = velocity.tolist()
    return MovingGroup(
        blocks=tuple(sorted(kin.ids[rows].tolist())),
        motion=motion,
        velocity=(vx, vy, turn),
        centroid=(float(centroid[0]), float(centroid[1])),
        area=float(area.sum()),
        speed=float(kin.speed[rows].max() / kin.speed.max()),
        toe=toe,
        against=tuple(np.unique(kin.ids[outside[at]]).tolist()),
        on_bed=bool(bears[at].any()),
        slips=bool(slips[at].any()),
    )


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

    contact_kinds: tuple[ContactKind, ...]
    """What contact points do, in the order of the interfaces and their points.  The associated flow
    rule opens a sliding contact by mu times its slip: that is "sliding"."""
    groups: tuple[MovingGroup, ...]  # by momentum (area times speed), largest first
    words: str


def describe_mechanism(
    model: RigidBlockModel,
    mechanism: Mechanism,
    *,
    falls: bool = False,
    names: "Names | None" = None,
) -> Failure:
    """Tell how a wall fails, or falls by itself, in words that call blocks by their names.

    A mechanism of a block that the model does not have is a ValueError.
    """
    kin = kinematics(model, mechanism)
    body = _bodies(kin)
    groups = [_group(kin, body, number) for number in range(int(body.max(initial=_STILL)) + 1)]
    # In shares of the largest and rounded, so that equal ones keep the order of their ids.
    largest = max((group.momentum for group in groups), default=0.0) or 1.0
    groups.sort(key=lambda group: (-round(group.momentum / largest, 9), group.blocks))
    return Failure(
        contact_kinds=tuple(_KINDS[code] for code in (kin.opens + 2 * kin.slips).tolist()),
        groups=tuple(groups),
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
        words = [
            f"{'wedge ' * (i in self.wedges)}{self._number(i)}" for i in ordered if i != GROUND
        ]
        return _shortened(["the ground"] * (GROUND in ordered) + words)

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
    verb, along = "sliding", "along" if group.slips or len(group.against) == 1 else "between"
    if group.motion == "mixed":
        rocks = "rocking and sliding" if group.slips else "tipping" if falls else "rocking"
        verb = rocks if group.velocity[2] else "carried"
    return verb, f" {'on' if group.on_bed else along} {names.place(group.against)}"


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
