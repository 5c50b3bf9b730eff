"""A plan built by someone who looks at the wall after every stone (DESIGN 4.10, closed loop).

The builder knows where everything lies, but not what he misses by next: neither the outline of the
stone in his hand nor his own slip.  So the rest is planned again after every stone.  Only the next
stone of a plan is ever laid, so only that one is: it is let go where it was planned, and tried
there with errors that he may make.  Where it would fall he tries beside it and turned a little.  A
stone without a sure place stays in the heap, and what falls goes back there with what lies on it.
The heap comes last, the largest stone first: each goes to its own place if it rests there now, else
to the lowest one on the wall where it rests surely.  Where there is none, what lies over its own
place is taken up, and goes into the heap.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from drystone.kernels.as_built import Built, BuiltWall
from drystone.kernels.profiles import HeightProfile, bare, hanging, raised
from drystone.model.builder import BuilderErrors, as_planned, stratified
from drystone.model.outlines import Outlined
from drystone.planner.vary import TRIAL_DRAWS
from drystone.search.letting_go import cheapest_apart
from drystone.search.rehearsal import Groups, RehearsalRun, end_of, errors_of, mean_size
from drystone.settle.putting import astray, bare_wall, lost
from drystone.settle.settings import SettleSettings

TRIALS = 8
"""So often a place is tried before a stone is put there."""

SURE = 0.75
"""A planned place is used when the stone rests there in this share of the trials; others wait."""

OTHERS = 0.5
"""A trial in which others fall counts as so much of one in which the stone itself falls."""

TRIES = 3
"""So often a stone that falls is put down again before it goes back into the heap."""

BESIDE = [(aside, turn) for turn in (0.0, -5.0, 5.0) for aside in (0.0, -0.1, 0.1, -0.2, 0.2)]
"""Places that are tried for a stone: from the planned one, over its size, and degrees."""

ROUNDS = 4
"""So often the heap is gone through."""

ROOMS = 2
"""So often what lies over the place of a stone of the heap is taken up for it."""

QUARTERS = (0.0, 180.0, 90.0, 270.0)
"""Turns in which a stone of the heap is tried, degrees."""

SPOTS, APART, COLUMNS = 8, 0.3, 16
"""Places of the heap for each turn, their least distance over the size, columns in a mean size."""

OVER_TOP = 0.25
"""A stone of the heap may stand out over the plan by so much, mean sizes."""


@dataclass(frozen=True, eq=False)
class ClosedRun(RehearsalRun):
    """A wall that was built with errors, looked at after every stone.

    A stone is fallen when it does not lie in the finished wall.
    """

    again: int = 0  # how often a stone fell on the way, and was taken up


class _Aim(NamedTuple):
    """A place for a stone: where its outline as it was seen rests, and how surely."""

    sure: float  # share of the trials in which it rests there
    start: Built
    rest: Built


class _Stone:
    """A stone of a plan with its wedges, as they were seen."""

    def __init__(self, group: Sequence[Outlined], errors: BuilderErrors) -> None:
        self.ids = [i for i, _ in group]
        self.id = self.ids[0]
        rng = np.random.default_rng([TRIAL_DRAWS, self.id])
        self.seen, *wedges = [as_planned(corners) for _, corners in group]
        self.wedges = [(i, one) for (i, _), one in zip(group[1:], wedges, strict=True)]
        # How it may be put down, the same wherever that is.
        self.trials = errors.all_built(group[0][1], stratified(rng, TRIALS, 1)[:, 0])

    def pieces(
        self, start: Built, put: Sequence[tuple[int, Built]] | None = None
    ) -> list[tuple[int, Built]]:
        """Return what is put down, the stone last: at its planned height the wedges come too."""
        if abs(start.y - self.seen.y) > 1e-9:
            return [(self.id, start)]
        aside = start.x - self.seen.x
        wedges = self.wedges if put is None else put
        return [*((i, replace(one, x=one.x + aside)) for i, one in wedges), (self.id, start)]

    def missed(self, start: Built, real: Built) -> Built:
        """Return where it is put instead of at a place: as far off as from the planned one."""
        aside, turn = real.x - self.seen.x, real.angle_deg
        return replace(real, x=start.x + aside, y=start.y, angle_deg=start.angle_deg + turn)

    def aim(self, wall: BuiltWall, start: Built, least: float) -> _Aim | None:
        """Let it go at a place, and try that; None where it rests less surely than `least`."""
        rest = wall.put(self.pieces(start)).get(self.id)
        if rest is None or astray(rest, start):
            return None
        falls = 0.0
        for trial in self.trials:
            put = wall.put(self.pieces(self.missed(start, trial)))
            after = put if put.get(self.id) is None else put.loaded(self.id)
            ended = after.get(self.id)
            if ended is None or astray(ended, rest):
                falls += 1.0
            elif lost(put, after):
                falls += OTHERS
            if TRIALS - falls < least * TRIALS:
                return None
        return _Aim(1.0 - falls / TRIALS, start, rest)

    def surest(self, wall: BuiltWall, starts: Iterator[Built], least: float) -> _Aim | None:
        """Return the first sure place of some, or the surest of all; None when all are unsure."""
        best: _Aim | None = None
        for start in starts:
            found = self.aim(wall, start, least if best is None else best.sure + 1 / TRIALS)
            best = found or best
            if best is not None and best.sure == 1.0:
                break
        return best

    def planned(self) -> Iterator[Built]:
        """List places at the planned one and beside it."""
        for aside, turn in BESIDE:
            yield replace(self.seen, x=self.seen.x + aside * self.seen.size, angle_deg=turn)

    def anywhere(
        self, wall: BuiltWall, box: tuple[float, float, float], cell: float
    ) -> list[Built]:
        """List places on top of what is built, the lowest first; box: left, right, top."""
        left, right, top = box
        profile = bare(math.floor((right - left) / cell))
        for i, built in enumerate(wall.laid.values()):
            profile = raised(profile, built.corners - (left, 0.0), i, cell)
        found = []
        for turn in QUARTERS:
            start = replace(self.seen, angle_deg=turn)
            for x, y, high in _lowest(start, profile, cell):
                if high <= top:
                    found.append((high, replace(start, x=left + x, y=y)))
        return [start for _, start in sorted(found, key=lambda one: round(one[0], 9))]


def _lowest(
    start: Built, profile: HeightProfile, cell: float
) -> Iterator[tuple[float, float, float]]:
    """List where the centroid of a block may be let go on a profile, and how high its top is."""
    hung = hanging(start.corners - (start.x, start.y), cell)
    count = len(hung.bottoms)
    if count > len(profile.tops):
        return
    under = np.lib.stride_tricks.sliding_window_view(profile.tops, count)
    lift = (under - hung.bottoms).max(axis=1)
    for at in cheapest_apart(lift, APART * start.size / cell, SPOTS):
        yield at * cell - hung.left, float(lift[at]), float(lift[at]) + hung.top


def rehearse_closed(
    groups: Groups, errors: BuilderErrors, rng: np.random.Generator, *, mu: float = 0.58
) -> ClosedRun:
    """Build a wall once with errors, and plan the rest again after every stone.

    The outlines and the first slip with every stone are those of
    :func:`drystone.search.rehearsal.rehearse` for the same random numbers.
    """
    work = _Work(groups, errors, rng, bare_wall(mu, SettleSettings()))
    for stone in work.stones:
        work.lay(stone, stone.planned(), SURE)
    rooms = Counter[int]()
    while True:
        for _ in range(ROUNDS):
            before = work.wall, work.again
            for stone in work.heap:
                work.lay(stone, work.places(stone), 1 / TRIALS)
            if (work.wall, work.again) == before:
                break
        lacking = next((one for one in work.heap if rooms[one.id] < ROOMS), None)
        if lacking is None:
            break
        rooms[lacking.id] += 1
        work.make_room(lacking)
    laid = work.wall.laid
    ends = (end_of(one.id, one.seen, laid.get(one.id)) for one in work.stones)
    stones = tuple(replace(end, fallen=end.stone not in laid) for end in ends)
    return ClosedRun(stones, tuple((i, b.corners) for i, b in laid.items()), again=work.again)


class _Work:
    """A wall that is being built of a plan."""

    def __init__(
        self, groups: Groups, errors: BuilderErrors, rng: np.random.Generator, wall: BuiltWall
    ) -> None:
        self.wall, self.again = wall, 0
        self.stones = [_Stone(group, errors) for group in groups]
        self.rested: dict[int, Built] = {}
        self._errors, self._rng = errors, rng
        real = errors_of(groups, errors, rng)
        self._real = {blocks[0][0]: blocks for blocks in real}
        corners = np.concatenate([group[0][1] for group in groups])
        (x0, _), (x1, y1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        size = mean_size(groups)
        self._box, self._cell = (x0, x1, y1 + OVER_TOP * size), size / COLUMNS

    @property
    def heap(self) -> list[_Stone]:
        """Stones that do not lie in the wall, the largest first: small ones find a place later."""
        heap = [one for one in self.stones if self.wall.get(one.id) is None]
        return sorted(heap, key=lambda one: -one.seen.size)

    def make_room(self, stone: _Stone) -> None:
        """Take up all that comes later than a stone and lies at its place or above."""
        left, right = _reach(stone.seen)
        later = {i for one in self.stones[self.stones.index(stone) + 1 :] for i in one.ids}
        reaches = {i: _reach(at) for i, at in self.wall.laid.items() if i in later}
        over = [i for i, (start, end) in reaches.items() if start < right and end > left]
        self.again += len(self.wall.with_burden(over))
        self.wall = self.wall.without(over)

    def places(self, stone: _Stone) -> Iterator[Built]:
        """List where a stone of the heap may go."""
        yield from stone.planned()
        yield from stone.anywhere(self.wall, self._box, self._cell)

    def lay(self, stone: _Stone, starts: Iterator[Built], least: float) -> None:
        """Put a stone where it rests most surely, or back into the heap with all that falls."""
        aim = stone.surest(self.wall, starts, least)
        if aim is None:
            return
        (_, real), *wedges = self._real[stone.id]
        for _ in range(TRIES):
            wall = self.wall.put(stone.pieces(stone.missed(aim.start, real), wedges))
            rest = wall.get(stone.id)
            if rest is not None:
                # What lies near to where it came to rest stays: the rest is planned from there.
                after = wall.loaded(stone.id)
                self.rested[stone.id], now = rest, after.laid
                fallen = [i for i, at in self.rested.items() if i in now and astray(now[i], at)]
                self.again += astray(rest, aim.rest) + len(wall.laid) - len(now) + len(fallen)
                self.wall = after.without(fallen)
                return
            self.again += 1
            aside, turn = self._rng.standard_normal(2).tolist()
            x = stone.seen.x + self._errors.placement * aside
            real = replace(real, x=x, angle_deg=self._errors.angle_deg * turn)


def _reach(built: Built) -> tuple[float, float]:
    """Return from where to where along the wall a block reaches."""
    return float(built.corners[:, 0].min()), float(built.corners[:, 0].max())
