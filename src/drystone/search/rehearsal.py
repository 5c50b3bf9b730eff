"""A plan built again with a builder's errors, by exact settling (DESIGN 4.10).

Each run draws errors of its own for every block (:mod:`drystone.model.builder`).  A block is put
down and let go (:mod:`drystone.settle.putting`).  It has fallen when it ends far from the plan, or
not at rest.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from drystone.kernels.polygons import Points, area_and_centroid, no_polygons
from drystone.model.builder import WEDGE_SHARE, BuilderErrors, Built
from drystone.model.outlines import Outlined
from drystone.settle.putting import FALLEN_DEG, FALLEN_SHARE, moved, put_down
from drystone.settle.settings import SettleSettings


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
    laid: dict[int, Built] = {}
    polygons = no_polygons()
    for group in errors_of(groups, errors, rng):
        for block, built in (*group[1:], group[0]):
            rest, pushed = put_down(built, polygons, mu, settle)
            if rest is not None:
                ids = list(laid)
                for place, shift in pushed.items():
                    one = laid[ids[place]]
                    laid[ids[place]] = replace(one, x=one.x + shift)
                laid[block] = rest
                polygons = moved(polygons, pushed).added([rest.corners])
    planned = {block: corners for group in groups for block, corners in group}
    return RehearsalRun(
        tuple(_end(group[0], laid.get(group[0][0])) for group in groups),
        tuple((i, one.corners) for i, one in laid.items() if _share(one, planned[i]) <= FALLEN_SHARE),
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
