"""A plan built again with a builder's errors, by exact settling (DESIGN 4.10).

Each run draws errors of its own for every block: how its outline differs from what was seen, and
how far from the plan it is put down.  A block is brought apart from what it overlaps there, let
go, and rests; it has fallen when it ends far from the plan, or not at rest.  What stands is judged
by the limit analysis after the last stone, and after those before it where the last does not stand.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from drystone.contacts.settled import PlacedPolygons, model_of_outlines
from drystone.kernels.gaps import crosses_any
from drystone.kernels.polygons import Points, Polygons, area_and_centroid, no_polygons
from drystone.model.outlines import Outlined
from drystone.model.placement import Side
from drystone.settle.rest import SettlingScene, Turned, lay
from drystone.settle.settings import SettleSettings
from drystone.statics.limit import lateral_resistance

ROBOT, HAND = 0.015, 0.03
"""Precision p of a good robot, and of a hand."""

FALLEN_SHARE, FALLEN_DEG = 0.25, 12.0
"""A stone has fallen when it ends farther from the plan, over its size, or turned by more."""

WEDGE_SHARE = 1 / 3
"""Errors of a wedge over those of a stone: it is small, and cut to its place."""

MODES = range(2, 7)
"""Waves around an outline; 0 would change its size, 1 only shift it."""

LONGEST_EDGE = 0.12
"""Edges are cut into pieces no longer than this, over the size, so that errors bend them too."""

APART = (0.0, 0.005, 0.01, 0.02, 0.03, 0.045, 0.065, 0.09, 0.12, 0.16, 0.2, 0.25)
"""Distances, over the size, at which a block that overlaps others is tried; it is lifted first."""

DIRECTIONS = 16


class PlannedGroup(NamedTuple):
    """A stone and its wedges, in the order of placement: outlines, (n, 2), source px, wall frame."""

    side: Side
    stone: Outlined
    wedges: tuple[Outlined, ...] = ()


@dataclass(frozen=True, kw_only=True)
class BuilderErrors:
    """Standard deviations of what a builder misses by; lengths in the unit of the wall."""

    placement: float  # along the wall
    angle_deg: float
    outline: float  # of the distance from the centroid, all around

    @classmethod
    def of_precision(cls, precision: float, mean_size: float) -> "BuilderErrors":
        """Return the errors of a precision p (DESIGN 4.10): p = .015 is a good robot, .03 a hand."""
        return cls(
            placement=precision * mean_size,
            angle_deg=100 * precision * 2 / 3,
            outline=0.5 * precision * mean_size,
        )

    def times(self, share: float) -> "BuilderErrors":
        """Return errors of a share of these."""
        return BuilderErrors(
            placement=share * self.placement,
            angle_deg=share * self.angle_deg,
            outline=share * self.outline,
        )


@dataclass(frozen=True)
class StoneEnd:
    """What became of a stone in a run."""

    stone: int
    fallen: bool
    share: float  # distance of its centroid from the plan, over its size
    turn_deg: float


@dataclass(frozen=True, eq=False)
class RehearsalRun:
    """One wall that was built with errors."""

    stones: tuple[StoneEnd, ...]  # in the order of placement
    first_fall: int | None  # the stone at which something fell first; None when nothing did
    F_LR: float | None  # of what stands at the end; None when it does not stand
    blocks: tuple[Outlined, ...]  # where all that has not fallen lies

    @property
    def whole(self) -> bool:
        """Nothing fell, and the wall stands."""
        return self.first_fall is None


def rehearse(
    groups: Sequence[PlannedGroup],
    width_px: float,
    errors: BuilderErrors,
    rng: np.random.Generator,
    *,
    mu: float = 0.58,
    settle: SettleSettings | None = None,
) -> RehearsalRun:
    """Build a wall once, stone after stone as planned, each with its own errors (open loop)."""
    settle = settle or SettleSettings()
    # Errors are larger than what a search lets a stone move by while it settles.
    settle = replace(settle, max_shift=FALLEN_SHARE, max_turn_deg=FALLEN_DEG)
    # Stones may stand out over the ends of the wall, which are lines on the ground.
    aside = np.array((width_px, 0.0))
    polygons, laid = no_polygons(), list[Outlined]()
    ends: list[StoneEnd] = []
    after: list[int] = []  # how many blocks lie after each stone
    for group in groups:
        end = StoneEnd(group.stone[0], fallen=True, share=math.inf, turn_deg=math.inf)
        for block_id, corners in (*group.wedges, group.stone):
            wedge = block_id != group.stone[0]
            own = errors.times(WEDGE_SHARE) if wedge else errors
            scene = SettlingScene.of(polygons, 3.0 * width_px, group.side, mu)
            found = _put_down(corners + aside, scene, own, rng, settle)
            if found is None:
                continue
            placed, share, turn_deg = found
            if not wedge:
                fallen = share > FALLEN_SHARE or abs(turn_deg) > FALLEN_DEG
                end = StoneEnd(block_id, fallen, share, turn_deg)
            if share <= FALLEN_SHARE and abs(turn_deg) <= FALLEN_DEG:
                polygons = polygons.added([placed])
                laid.append((block_id, placed))
        ends.append(end)
        after.append(len(laid))
    fallen = next((end.stone for end in ends if end.fallen), None)
    resistance, last = _judged(laid, after, mu, settle)
    if last is not None and (fallen is None or last < [e.stone for e in ends].index(fallen)):
        fallen = ends[last].stone
    blocks = tuple((block_id, corners - aside) for block_id, corners in laid)
    return RehearsalRun(tuple(ends), fallen, resistance, blocks)


def _judged(
    laid: Sequence[Outlined], after: Sequence[int], mu: float, settle: SettleSettings
) -> tuple[float | None, int | None]:
    """Return F_LR of what lies, and the number of the stone with which it stands no longer."""

    def value(count: int) -> float | None:
        if not count:
            return 0.0
        placed = PlacedPolygons.of(laid[:count])
        return lateral_resistance(
            model_of_outlines(placed, mu, settle.contact_px, settle.setback)
        ).value

    whole = value(len(laid))
    if whole is not None:
        return whole, None
    stands, falls = -1, len(after) - 1  # a stone may be held by a later one: the first is sought
    while falls - stands > 1:
        middle = (stands + falls) // 2
        if value(after[middle]) is None:
            falls = middle
        else:
            stands = middle
    return None, falls


def _put_down(
    corners: Points,
    scene: SettlingScene,
    errors: BuilderErrors,
    rng: np.random.Generator,
    settle: SettleSettings,
) -> tuple[Points, float, float] | None:
    """Return where a block with errors comes to rest: corners, distance over size, turn.

    None when it does not rest anywhere near.
    """
    area, x, y = area_and_centroid(corners)
    size = math.sqrt(area)
    outline = misjudged(corners - (x, y), errors.outline, size, rng)
    x_put = x + rng.normal(0.0, errors.placement) if errors.placement else x
    angle_deg = rng.normal(0.0, errors.angle_deg) if errors.angle_deg else 0.0
    turned = Turned.of(outline, angle_deg, scene.side, size)
    seen_x = x_put if scene.side == "left" else scene.width_px - x_put
    for start in _apart(turned, scene.polygons, (seen_x, y), size):
        found = lay(turned, scene, start, settle)
        if found is not None:
            at = found.settled
            away = math.hypot(at.x_px - x, at.y_px - y) / size
            return at.corners, away, found.angle_deg
        break
    return None


def _apart(
    turned: Turned, around: Polygons, start: tuple[float, float], size: float
) -> Iterator[tuple[float, float]]:
    """List places near one where a block overlaps nothing, the nearest first, higher ones before."""
    lowest = -float(turned.corners[:, 1].min())
    for share in APART:
        for k in range(DIRECTIONS if share else 1):
            # Straight up, then more and more aside, to the left and to the right by turns.
            angle = math.pi / 2 + (k + 1) // 2 * (-1) ** k * 2 * math.pi / DIRECTIONS
            x = start[0] + share * size * math.cos(angle)
            y = max(start[1] + share * size * math.sin(angle), lowest)
            if not crosses_any(turned.corners + np.array((x, y)), around):
                yield x, y


def misjudged(
    outline: Points, sigma: float, size: float, rng: np.random.Generator
) -> Points:
    """Return an outline about its centroid as it really is: a smooth error of what was seen.

    The error is along the way from the centroid, of Fourier modes 2 to 6 over the polar angle with
    equal weights; `sigma` is its standard deviation at any angle.
    """
    waves = rng.normal(0.0, sigma / math.sqrt(len(MODES)), (len(MODES), 2))
    if not sigma:
        return outline
    fine = _refined(outline, LONGEST_EDGE * size)
    angle = np.arctan2(fine[:, 1], fine[:, 0])
    error = sum(
        a * np.cos(mode * angle) + b * np.sin(mode * angle)
        for mode, (a, b) in zip(MODES, waves.tolist(), strict=True)
    )
    moved = fine * (1.0 + error / np.hypot(*fine.T))[:, None]
    _, x, y = area_and_centroid(moved)
    return np.asarray(moved - (x, y))


def _refined(outline: Points, longest: float) -> Points:
    """Return an outline with corners added so that no edge is longer."""
    after = np.roll(outline, -1, axis=0)
    counts = np.maximum(1, np.ceil(np.hypot(*(after - outline).T) / longest)).astype(int)
    pieces = [
        a + (b - a) * (np.arange(count) / count)[:, None]
        for a, b, count in zip(outline, after, counts, strict=True)
    ]
    return np.concatenate(pieces)
