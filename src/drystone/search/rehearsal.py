"""A plan built again with a builder's errors, by exact settling (DESIGN 4.10).

Each run draws errors of its own for every block (:mod:`drystone.model.builder`).  A block is
brought apart from what it overlaps where it is put, as are its neighbours on which nothing rests
yet; it is let go, and rests.  It has fallen when it ends far from the plan, or not at rest.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from drystone.kernels.gaps import crosses_any
from drystone.kernels.polygons import Points, area_and_centroid, no_polygons
from drystone.kernels.profiles import extremes
from drystone.kernels.settling import Status
from drystone.model.builder import WEDGE_SHARE, BuilderErrors, Built
from drystone.model.outlines import Outlined
from drystone.settle.rest import OVERLAP_PX, SettlingScene, Turned, let_go, repose, ways
from drystone.settle.settings import SettleSettings

TOUCHING = 0.5
"""Blocks that are nearer, source px, touch."""

FALLEN_SHARE, FALLEN_DEG = 0.25, 12.0
"""A stone has fallen when it ends farther from the plan, over its size, or turned by more."""

BEARS = 0.3
"""A contact whose normal goes up by more than this bears what is above it."""

NEAR,TOUCHES,STEPS,STEEP,LIFT,MOST,GAP=.01,.003,300,-1.,.02,.3,.05
REACH = 0.3
"""So far around a stone, over its size, gaps are looked at when it is brought apart."""

BESIDE = 0.3
"""Stones no farther than this, over the size of a stone that is put down, may be pushed aside."""

PUSHED = 2.0
"""Cost of moving another stone, over that of moving the one that is put down."""

ROUNDS = 4
"""So often, at most, gaps are made linear until nothing overlaps."""

LIFTS = (0.0, 0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2)
"""So much higher, over the size, a stone is let go where it still overlaps others."""


@dataclass(frozen=True)
class StoneEnd:
    """What became of a stone in a run."""

    stone: int
    fallen: bool
    share: float | None  # distance of its centroid from the plan, over its size; None: not at rest
    turn_deg: float | None


@dataclass(frozen=True, eq=False)
class RehearsalRun:
    """One wall that was built with errors."""

    stones: tuple[StoneEnd, ...]  # in the order of placement
    blocks: tuple[Outlined, ...]  # where all that has not fallen lies

    @property
    def first_fall(self) -> int | None:
        """The first stone that fell; None when none did."""
        return next((end.stone for end in self.stones if end.fallen), None)


def errors_of(
    groups: Sequence[Sequence[Outlined]], errors: BuilderErrors, rng: np.random.Generator
) -> list[list[tuple[int, Built]]]:
    """Return the blocks of a plan as they are and where they are put, the stone of each first."""
    wedge = errors.times(WEDGE_SHARE)
    return [
        [(i, (wedge if k else errors).built(corners, rng)) for k, (i, corners) in enumerate(group)]
        for group in groups
    ]


def rehearse(
    groups: Sequence[Sequence[Outlined]],
    errors: BuilderErrors,
    rng: np.random.Generator,
    *,
    mu: float = 0.58,
    settle: SettleSettings | None = None,
) -> RehearsalRun:
    """Build a wall once, stone after stone as planned, each with its own errors (open loop).

    `groups` are stones with their wedges, the stone first, in the order of placement: (n, 2)
    corners in the wall frame, source px.  Stones may stand out over the ends of the wall.
    """
    settle = settle or SettleSettings()
    # Errors are larger than what a search lets a stone move by while it settles, and friction
    # holds on upright faces too: what is put down with errors is pressed in.
    settle = replace(settle, max_shift=FALLEN_SHARE, max_turn_deg=FALLEN_DEG, steep=0.0)
    planned = {block: corners for group in groups for block, corners in group}
    ends = np.concatenate(list(planned.values()))[:, 0]
    # The ends of the wall are no ends of what is built: it stands in the middle of a wider one.
    width = float(np.ptp(ends))
    aside = width - float(ends.min())
    scene = SettlingScene(no_polygons(), 3.0 * width, "left", mu)
    laid: dict[int, Built] = {}
    for group in errors_of(groups, errors, rng):
        for block, built in (*group[1:], group[0]):
            laid = _with(laid, block, replace(built, x=built.x + aside), scene, settle)
    laid = {block: replace(built, x=built.x - aside) for block, built in laid.items()}
    near = {i: built for i, built in laid.items() if _share(built, planned[i]) <= FALLEN_SHARE}
    return RehearsalRun(
        tuple(_end(group[0], laid.get(group[0][0])) for group in groups),
        tuple((block, built.corners) for block, built in near.items()),
    )


def _share(built: Built, planned: Points) -> float:
    """Return how far a block is from the plan, over its size."""
    _, x, y = area_and_centroid(planned)
    return math.hypot(built.x - x, built.y - y) / built.size


def _end(planned: Outlined, built: Built | None) -> StoneEnd:
    if built is None:
        return StoneEnd(planned[0], True, None, None)
    share = _share(built, planned[1])
    fallen = share > FALLEN_SHARE or abs(built.angle_deg) > FALLEN_DEG
    return StoneEnd(planned[0], fallen, share, built.angle_deg)


def _with(
    laid: dict[int, Built], block: int, built: Built, scene: SettlingScene, settle: SettleSettings
) -> dict[int, Built]:
    """Return what lies once a block is put down and let go; the same where it rests nowhere."""
    built, after = _squeezed_in(built, laid)
    polygons = no_polygons().added(one.corners for one in after.values())
    scene, size = replace(scene, polygons=polygons), built.size
    turned = Turned.of(built.outline, built.angle_deg, scene.side, size)
    usual = ways(turned, scene, settle)[-1]._replace(
        stop=0.0, near=NEAR * size, far=2.0 * NEAR * size, tolerance=TOUCHES * size, steps=STEPS,
        overlap=LIFT*size, steep=STEEP,
    )
    for sticks in (True, False):
        for lift in LIFTS:
            start = built.x, built.y + lift * size
            found = let_go(turned, scene, start, usual._replace(sticks=sticks))
            if found.status is Status.RESTS:
                rest = repose(turned, scene, found)
                at = rest.settled
                return {**after, block: Built(built.outline, at.x_px, at.y_px, rest.angle_deg)}
    return laid


def _squeezed_in(built: Built, laid: dict[int, Built]) -> tuple[Built, dict[int, Built]]:
    """Move a block aside to where it has room between its neighbours, or push these apart."""
    left, right = (max((_into(built, one, sign) for one in laid.values()), default=0.0) for sign in (-1.0,1.0))
    if left<=0 and right<=0: return built, laid
    if left>0 and right>0: shift=.5*(left-right)
    else:
        # all the way, as far as there is room
        want=left if left>0 else right
        sign=1. if left>0 else -1.
        moved=replace(built,x=built.x+sign*want)
        over=max((_into(moved, one, sign) for one in laid.values()), default=0.0)
        shift=sign*(want-.5*max(over,0.))
    if abs(shift) > MOST*built.size:
        return built, laid
    built = replace(built, x=built.x+shift)
    after = dict(laid)
    for sign in (-1.0, 1.0):
        todo=[built]
        while todo:
            by = todo.pop()
            for i, one in after.items():
                if one is not by:
                    over=_into(by, one, sign)
                    if over>0 and over<MOST*one.size:
                        after[i]=replace(one,x=one.x+sign*over)
                        todo.append(after[i])
    return built, after


def _into(built: Built, other: Built, sign: float) -> float:
    """Return how far another block, beside this one, has to move along x until it clears this one; 0 where need not"""
    if (other.x-built.x)*sign<=0 or abs(other.x-built.x)>2*(built.size+other.size): return 0.0
    a, b = built.corners, other.corners
    low, high = np.maximum(a.min(0),b.min(0)), np.minimum(a.max(0),b.max(0))
    if (high-low).min()<=0: return 0.0
    if high[1]-low[1]<BESIDE*min(np.ptp(a[:,1]),np.ptp(b[:,1])): return 0.0
    if not crosses_any(a,no_polygons().added([b])): return 0.0
    across=_depth(a[:,::-1],b[:,::-1],sign)
    return across if across < _depth(a,b,1. if other.y>built.y else -1.) else 0.0


def _depth(a,b, sign: float) -> float:
    low=max(a[:,0].min(),b[:,0].min()); high=min(a[:,0].max(),b[:,0].max())
    rows=32; cell=(high-low)/rows
    al,ar=extremes(a,low,cell,rows); bl,br=extremes(b,low,cell,rows)
    return float((ar-bl if sign>0 else br-al).max())
