"""A plan built again with a builder's errors, by exact settling (DESIGN 4.10).

Each run draws errors of its own for every block (:mod:`drystone.model.builder`).  A block is put
down and let go (:mod:`drystone.settle.putting`).  It has fallen when it ends far from the plan, or
not at rest.
"""

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from drystone.kernels.as_built import Built, BuiltWall
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.raster import wrap_deg
from drystone.model.builder import BuilderErrors, as_planned, put_down_with, stratified
from drystone.model.outlines import Outlined
from drystone.model.wall import Wall, outlined
from drystone.physics.building import ROUNDED, BuildSettings, build_up, tilt_of
from drystone.physics.scatter import Variation
from drystone.physics.tilt import TiltSettings
from drystone.settle.putting import astray, bare_wall, fallen_share, lost
from drystone.settle.settings import SettleSettings

Groups = Sequence[Sequence[Outlined]]
"""Stones with their wedges, the stone of each first, in the order of placement.

Corners, (n, 2), are in the wall frame, source px.
"""

Put = list[list[tuple[int, Built]]]
"""The same blocks as they are and where they are put in a run, the stone of each first."""

IN_ENGINE = BuildSettings(
    moved_share=math.inf,  # where a stone ends is asked, not what it did on the way
    turned_deg=math.inf,
    resting_time=0.5,
    longest_rest=3.0,
)
"""How the engine is asked: whether stones go astray by percents, sooner than to the last digit."""

PATIENT = replace(IN_ENGINE, longest_rest=20.0, apart_share=0.0)
TILT = Variation("as built", ROUNDED, TiltSettings(coarse=0.13, fine=0.02, longest_hold=20))
"""How a wall as it was built is let go, as it lies and all at once, and tilted: stones that rest at
a few points go on to roll for a while, and errors of percents leave no digits to look for."""


@dataclass(frozen=True)
class StoneEnd:
    """What became of a stone in a run."""

    stone: int
    fallen: bool
    share: float | None  # distance of its centroid from the plan, over its size; None: not at rest
    turn_deg: float | None

    @property
    def nearness(self) -> float:
        """How near it is to having fallen, from 0 to 1."""
        if self.fallen or self.share is None or self.turn_deg is None:
            return 1.0
        return fallen_share(self.share, 0.0, self.turn_deg, 1.0)


@dataclass(frozen=True, eq=False)
class RehearsalRun:
    """One wall that was built with errors."""

    stones: tuple[StoneEnd, ...]  # in the order of placement
    blocks: tuple[Outlined, ...]  # where all that has not fallen lies
    # Of a wall that stands in the engine: by how much it may be tilted, over mu; None without.
    tilt: float | None = None
    # The stone that was laid when one fell first, that one or another below; None: not known.
    laid_last: int | None = None

    @property
    def first_fall(self) -> int | None:
        """The first stone that fell, in the order of placement; None when none did."""
        return next((end.stone for end in self.stones if end.fallen), None)

    @property
    def begins(self) -> int | None:
        """The stone with which falls begin, as far as that is known; None when none fell."""
        fell = self.first_fall
        return fell if fell is None or self.laid_last is None else self.laid_last


def groups_of(wall: Wall) -> Groups:
    """Return the stones of a wall of outlines with their wedges."""
    return [outlined(group.placement, group.wedges) for group in wall.groups]


def mean_size(groups: Groups) -> float:
    """Return the mean over the stones of the root of their area, source px."""
    return float(np.mean([area_and_centroid(group[0][1])[0] ** 0.5 for group in groups]))


def errors_of(groups: Groups, errors: BuilderErrors, rng: np.random.Generator) -> Put:
    """Return the blocks of a plan as they are and where they are put in a run."""
    ends = np.cumsum([len(group) for group in groups])
    numbers = np.split(stratified(rng, 1, int(ends[-1])), ends[:-1], axis=1)
    return [put_down_with(errors, *one)[0] for one in zip(groups, numbers, strict=True)]


def rehearse(
    groups: Groups, errors: BuilderErrors, rng: np.random.Generator, *, mu: float = 0.58
) -> RehearsalRun:
    """Build a wall once, stone after stone as planned, each with its own errors (open loop).

    Stones may stand out over the ends of the wall.
    """
    return put_up(groups, errors_of(groups, errors, rng), mu, SettleSettings())


@dataclass(frozen=True, eq=False)
class RunState:
    """How far a wall is built in a run."""

    wall: BuiltWall
    laid_last: int | None = None  # see `RehearsalRun`


def put_up(
    groups: Groups,
    put: Put,
    mu: float,
    settle: SettleSettings,
    states: list[RunState] | None = None,
) -> RehearsalRun:
    """Build a wall once of blocks with their errors.

    `states` are those of the run after its first stones, from none on, where that was built
    before; those after the others are added to them.
    """
    states = [RunState(bare_wall(mu, settle))] if states is None else states
    planned = {group[0][0]: as_planned(group[0][1]) for group in groups}
    steps = list(zip(planned.items(), put, strict=True))
    for (block, at), (stone, *wedges) in steps[len(states) - 1 :]:
        before = states[-1]
        wall = laid = before.wall.put((*wedges, stone))
        rest = laid.get(block)
        fell = rest is None or astray(rest, at)
        if rest is not None:
            wall = laid.loaded(block)
        # Wedges alone may be lost.
        falls = fell or not planned.keys().isdisjoint(lost(laid, wall))
        begins = block if falls and before.laid_last is None else before.laid_last
        states.append(RunState(wall, begins))
    wall = states[-1].wall
    ends = tuple(end_of(block, at, wall.get(block)) for block, at in planned.items())
    fallen = {end.stone for end in ends if end.fallen}
    lies = tuple((i, b.corners) for i, b in wall.laid.items() if i not in fallen)
    return RehearsalRun(ends, lies, laid_last=states[-1].laid_last)


def end_of(block: int, at: Built, built: Built | None) -> StoneEnd:
    """Say what became of a stone that was planned at a place; None where it does not rest."""
    if built is None:
        return StoneEnd(block, True, None, None)
    share = math.hypot(built.x - at.x, built.y - at.y) / built.size
    return StoneEnd(block, astray(built, at), share, built.angle_deg)


def moved(built: Built, corners: Points) -> Built:
    """Return a block that came from one place to where its corners are now."""
    _, x, y = area_and_centroid(corners)
    # As complex numbers: the angle between the two outlines about their means.
    before, after = ((one - one.mean(axis=0)) @ (1, 1j) for one in (built.corners, corners))
    turn_deg = wrap_deg(built.angle_deg + math.degrees(cmath.phase(np.vdot(before, after))))
    return replace(built, x=x, y=y, angle_deg=turn_deg)


def rehearse_in_engine(
    groups: Groups, errors: BuilderErrors, rng: np.random.Generator, *, mu: float = 0.58
) -> RehearsalRun:
    """Build a wall once with the same errors in a rigid-body engine (extra `physics`)."""
    put = errors_of(groups, errors, rng)
    found = build_up([[(i, one.corners) for i, one in group] for group in put], mu, IN_ENGINE)
    ends = [
        end_of(block, as_planned(corners), moved(built, found.outlines[block]))
        for ((_, corners), *_), ((block, built), *_) in zip(groups, put, strict=True)
    ]
    fallen = {end.stone for end in ends if end.fallen}
    lies = tuple((i, corners) for i, corners in found.outlines.items() if i not in fallen)
    if fallen:
        return RehearsalRun(tuple(ends), lies)
    alphas = [one.alpha for one in tilt_of(found) or () if one.alpha is not None]
    return RehearsalRun(tuple(ends), lies, min(alphas) / mu if alphas else None)


def tilt_as_built(groups: Groups, run: RehearsalRun, mu: float = 0.58) -> float:
    """Return by how much what has not fallen of a wall may be tilted, over mu: the smaller side.

    Its outlines as they lie are let go in the rigid-body engine (extra `physics`) and tilted from
    where they come to rest.  0 where they do not, or a stone falls: it ends far from where it lay,
    and from where it is planned.  Wedges alone may be lost.
    """
    lies, owner = dict(run.blocks), {i: group[0][0] for group in groups for i, _ in group}
    planned = {stone: as_planned(corners) for (stone, corners), *_ in groups}
    turns_deg = {end.stone: end.turn_deg or 0.0 for end in run.stones}
    while True:
        built, gone = build_up([list(lies.items())], mu, PATIENT), set[int]()
        for block, corners in lies.items():
            lay = replace(as_planned(corners), size=planned[owner[block]].size)
            now = moved(lay, built.outlines[block])
            if block in planned and astray(now, lay):
                now, lay = replace(now, angle_deg=now.angle_deg + turns_deg[block]), planned[block]
            if astray(now, lay):
                gone.add(block)
        if not gone or gone & planned.keys():
            break
        lies = {i: corners for i, corners in lies.items() if i not in gone}
    tilts = () if gone else tilt_of(built, (TILT,)) or ()
    alphas = [one.alpha for one in tilts if one.alpha is not None]
    return min(alphas) / mu if alphas else 0.0
