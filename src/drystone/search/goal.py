"""Finished walls, and how good they are: figures of merit, weighed into one number."""

import math
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from drystone.craft.bond import bond_faults
from drystone.craft.masonry import Masonry
from drystone.craft.settings import CraftSettings
from drystone.kernels.as_built import Built
from drystone.metrics.measure import measure_labels
from drystone.metrics.shape import top_profile
from drystone.model.builder import HAND, BuilderErrors, put_down_with, stratified
from drystone.model.outlines import Outlined
from drystone.model.wall import Group, Wall
from drystone.planner.build import Build, Solves
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.planner import Planner
from drystone.planner.search_settings import GoalSettings
from drystone.planner.sturdy import ROUNDS
from drystone.planner.vary import REHEARSAL_DRAWS
from drystone.planner.workshop import Workshop
from drystone.search.courses import CoursePlan
from drystone.search.rehearsal import RunState, groups_of, mean_size, put_up
from drystone.search.yard import Yard
from drystone.settle.putting import bare_wall
from drystone.statics.flow.flow_search import STARTS, NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.flow.release import fall_of
from drystone.statics.lp.program import assemble
from drystone.statics.result import LimitStatus, Mechanism

MISSING = 10.0
"""Units of merit that a pinned stone counts which is not in the wall."""

SCANNED = CraftSettings(sample=0.07, slot=0.3)
"""Bond is looked at along fewer lines than `craft` does, for every wall of a search.

A slot is no joint here: merit that counts slots takes walls of rubble that fall more often.
"""

QUICK = NonassociativeSettings(starts=STARTS[:1], random_starts=0, paths=(), let_go=False)
"""One start of twelve finds the least load without dilatancy of most walls."""

THOROUGH = NonassociativeSettings()
"""How the load without dilatancy is looked for in the best walls."""

STOPPED = 14
"""A builder who has to mend a wall loses as much as with so many stones."""

FILLED, FILLED_TOP = 0.99, 0.9
"""A wall is incomplete when its filling (DESIGN 2) and its mean top, over its height, are below."""

NEARLY = 4
"""Power of how near the worst stone of a run came to falling: so fewer runs tell as much."""

MOVES = 0.5
"""A stone takes part in a failure when it is at least so fast, over the fastest."""

RUNS, LAST_RUNS = 12, 60
"""So often a wall of a search is rehearsed at most, and the best ones at the end."""

ENOUGH = 16
"""So many runs in which stones fall tell as much as is needed."""

KNOWN_BYTES = 1 << 27
"""What is remembered of the runs of a wall at most, about: sixty of a wall of fifty stones."""


@dataclass(frozen=True)
class WallFigures:
    """Figures of merit of a finished wall; 0 where a figure is not defined.

    Their names are those of :class:`drystone.metrics.measure.WallMetrics`.
    """

    stones: int
    F_SF: float
    F_LR: float
    F_AV: float
    F_AH: float
    T_LEVEL: float
    E_FLUSH: float
    missing: int = 0  # how many pinned stones it lacks
    bond: float = 0.0  # `drystone.craft.bond.bond_faults`; 0 for a wall of pixels
    # F_LR without dilatancy, 0 where the wall can fall by itself; None where it was not asked for.
    F_LR_coulomb: float | None = None
    fallen: float = 0.0  # mean share of the stones that fall in a rehearsal, once it was judged

    @property
    def carried(self) -> float:
        """The smaller of both lateral resistances, as far as they are known."""
        return self.F_LR if self.F_LR_coulomb is None else min(self.F_LR, self.F_LR_coulomb)


def figures_of(build: Build, pinned: Collection[int] = ()) -> WallFigures | None:
    """Measure a wall, and count the pinned stones that it lacks; None when it is empty."""
    if not build.actions:
        return None
    site, outlines = build.wall.site, build.wall.outlines
    wedges = {wedge.id for wedge in build.wall.wedges}
    bond = 0.0
    if outlines is not None:
        bond = bond_faults(Masonry(dict(outlines.blocks), None, wedges, settings=SCANNED))
    measured = measure_labels(
        build.wall.labels, wedge_ids=wedges, wall_px=(site.width_px, site.height_px)
    )
    return WallFigures(
        stones=len(build.actions),
        F_SF=build.wall.filling,
        F_LR=build.actions[-1].resistance.value or 0.0,
        F_AV=measured.F_AV or 0.0,
        F_AH=measured.F_AH or 0.0,
        T_LEVEL=measured.T_LEVEL,
        E_FLUSH=measured.E_FLUSH,
        missing=len(set(pinned) - {action.stone_id for action in build.actions}),
        bond=bond,
    )


def usable_area_px(workshop: Workshop) -> int:
    """Return the area of all stones that fit and are not banned, source px."""
    return sum(workshop.stones.by_id(stone_id).area_px for stone_id in workshop.fitting)


def possible_filling(workshop: Workshop) -> float:
    """Return the area bound on F_SF: all stones that may be used, or a full wall."""
    site = workshop.site
    stones = usable_area_px(workshop) * site.scale**2
    return min(1.0, stones / (site.width_px * site.height_px))


def merit_of(figures: WallFigures | None, possible: float, goal: GoalSettings) -> float:
    """Weigh the figures of a wall."""
    if figures is None:
        return -math.inf
    return math.fsum(
        [
            goal.filling * _aimed(figures.F_SF, goal.F_SF, goal.urgent, min) / possible,
            goal.resistance * _aimed(min(1.0, figures.carried), goal.F_LR, goal.urgent, min),
            goal.vertical * _aimed(figures.F_AV, goal.F_AV, goal.urgent, min),
            -goal.horizontal * _aimed(figures.F_AH, goal.F_AH, goal.urgent, max),
            -goal.level * figures.T_LEVEL,
            -goal.flush * figures.E_FLUSH,
            -goal.bond * figures.bond,
            -goal.fallen * figures.fallen,
            -MISSING * figures.missing,
        ]
    )


def _aimed(value: float, aim: float, urgent: float, end: Callable[..., float]) -> float:
    """Return what a figure counts: no more (`min`) or no less (`max`) than its aim, if any."""
    return value if aim == 0.0 else urgent * end(value, aim)


class RehearsalFalls(NamedTuple):
    """What falls in some rehearsals of a wall of outlines."""

    # In the mean, over all its stones.  A run that is not whole counts as `STOPPED` more stones.
    # One that is counts as a part of these, the more the nearer a stone came to falling.
    share: float
    first: Counter[int]  # in how many runs which stone falls first, in the order of placement
    begins: Counter[int]  # in how many falls begin when which stone is laid

    @classmethod
    def none(cls) -> "RehearsalFalls":
        """Say that nothing falls."""
        return cls(0.0, Counter(), Counter())


@dataclass(frozen=True)
class Courses:
    """How a wall was laid course by course."""

    plan: CoursePlan
    ends: tuple[int, ...]  # how many stones the wall had before the first course, and after each


@dataclass(frozen=True, eq=False)
class FoundWall:
    """A finished wall and what it is worth."""

    build: Build
    figures: WallFigures | None  # None when it is empty
    # No less than that of the same wall once it is `judged` for the first time; in other
    # rehearsals less of it may fall.
    merit: float
    solves: Solves = field(default_factory=Solves)  # trouble with it
    courses: Courses | None = None  # None for a wall that was not planned before
    # in its rehearsals, once it was judged
    falls: RehearsalFalls = field(default_factory=RehearsalFalls.none)
    # Stones that move when it fails in its weaker direction, the fastest first, once it was judged.
    movers: tuple[int, ...] = ()

    @classmethod
    def of(
        cls, planner: Planner, courses: Courses | None = None, before: Solves | None = None
    ) -> "FoundWall":
        """Measure what a planner has built, after what trouble there was before."""
        solves = (before or Solves()) + planner.solves
        return cls.measured(planner.build, Yard.of(planner), solves, courses)

    @classmethod
    def measured(
        cls, build: Build, yard: Yard, solves: Solves | None = None, courses: Courses | None = None
    ) -> "FoundWall":
        """Measure a wall."""
        figures = figures_of(build, yard.settings.pin)
        merit = merit_of(figures, possible_filling(yard.workshop), yard.settings.goal)
        return cls(build, figures, merit, solves or Solves(), courses)

    def judged(
        self,
        yard: Yard,
        flow: NonassociativeSettings | None = None,
        least: float = -math.inf,
        rehearsals: "Rehearsals | None" = None,
    ) -> "FoundWall":
        """Return the same wall with what falls of it, and what it carries without dilatancy.

        What is known is asked for again when rehearsals, or settings of the flow, are given.  The
        least load that is found counts (DESIGN 4.8); where none is found the associative value
        stands, above which none can be.
        The wall has no merit as soon as that cannot be more than `least`.
        """
        figures, model, goal = self.figures, self.build.model, yard.settings.goal
        possible = possible_filling(yard.workshop)
        again = flow is not None or rehearsals is not None
        # In other rehearsals less may fall, or nothing.
        most = self.merit + (goal.fallen * figures.fallen if figures and again else 0.0)
        if most <= least:
            return replace(self, merit=-math.inf)
        if figures is None:
            return self
        known = figures.F_LR_coulomb
        if known is not None and not again:
            return self
        falls = self.falls
        if goal.fallen:
            most = (most - least) / goal.fallen
            found_falls = (rehearsals or Rehearsals(yard, RUNS)).falls(self.build, most)
            if found_falls is None:
                return replace(self, merit=-math.inf)
            falls, figures = found_falls, replace(figures, fallen=found_falls.share)
        carried, movers = figures.F_LR, self.movers
        # A thorough search begins as the quick one, which may find a load that is low enough.
        searches: list[NonassociativeSettings] = list(dict.fromkeys((QUICK, flow or QUICK)))
        if known is not None and flow is None:
            carried, searches = known, []
        for settings in searches:
            found = nonassociative_resistance(model, settings=settings, look=yard.until.look)
            for end in (found.left, found.right):
                alpha = 0.0 if end.status is LimitStatus.UNSTABLE else end.alpha
                if alpha is not None and alpha / found.mu <= carried:
                    carried = alpha / found.mu
                    movers = _movers(self.build, end.mechanism)
            figures = replace(figures, F_LR_coulomb=carried)
            if merit_of(figures, possible, goal) <= least:
                return replace(self, merit=-math.inf)
        figures = replace(figures, F_LR_coulomb=carried)
        merit = merit_of(figures, possible, goal)
        return replace(self, figures=figures, merit=merit, falls=falls, movers=movers)


def mean_top(wall: Wall) -> float:
    """Return the mean height of the wall's top over its columns, as a share of its height."""
    return float(np.mean(top_profile(wall.labels))) / wall.site.height_px


def is_high(wall: Wall) -> bool:
    """Say whether a wall is filled, or its top reaches as high as that of a complete one."""
    return wall.filling >= FILLED or mean_top(wall) >= FILLED_TOP


def stays_at_every_step(build: Build, until: Deadline = NEVER) -> bool:
    """Return whether a wall stays as it is when all of it is let go after each step.

    Forces that would hold it may exist that do not arise (DESIGN 4.8).  For the newest stone alone
    that is asked whenever a stone is placed; for all, which takes longer, only of the best walls.
    """
    models = (action.model for action in build.actions)
    return all(fall_of(m, assemble(m), ROUNDS, until.look) is None for m in models)


def _movers(build: Build, mechanism: Mechanism | None) -> tuple[int, ...]:
    if mechanism is None:
        return ()
    speeds = dict(zip(mechanism.block_ids, np.hypot(*mechanism.velocity.T[:2]), strict=True))
    stones = [group.placement.stone_id for group in build.wall.groups]
    fastest = sorted(stones, key=lambda stone: (-round(speeds[stone], 6), stone))
    return tuple(s for s in fastest if speeds[s] >= MOVES * speeds[fastest[0]] > 0.0)


class Rehearsals:
    """Rehearses walls of the same stones, each stone with the same errors in all of them.

    So walls that differ little are compared by what differs.  The first wall decides how often all
    are rehearsed: until stones of it have fallen in :data:`ENOUGH` runs.  It is remembered how it
    came to stand: others are built on from where they differ from it, and first in the runs in
    which it lost most.
    """

    def __init__(self, yard: Yard, runs: int, draws: int = 0) -> None:
        self._yard, self._draws = yard, (REHEARSAL_DRAWS, draws)
        self._drawn = self._runs = runs
        self._errors: BuilderErrors | None = None
        bare = RunState(bare_wall(yard.settings.mu, yard.settings.settle))
        # Of the first wall, once it was rehearsed: its steps, states and losses in each run.
        self._first: Sequence[Group] = ()
        self._states = [[bare] for _ in range(runs)]
        self._lost = [0.0] * runs

    def falls(self, build: Build, most: float = math.inf) -> RehearsalFalls | None:
        """Rehearse a wall of outlines.

        None as soon as its share is known to be above `most`, or would be if it loses no less than
        the first wall in the runs in which that lost no stone.
        """
        blocks, groups = groups_of(build.wall), build.wall.groups
        if not blocks:
            return RehearsalFalls.none()
        settings = self._yard.settings
        errors = self._errors or BuilderErrors.of_precision(HAND, mean_size(blocks))
        pairs = zip(groups, self._first, strict=False)
        same = sum(1 for _ in takewhile(lambda two: two[0] is two[1], pairs))
        built = min(same, *(len(states) - 1 for states in self._states[: self._runs]))
        put = [self._put(errors, one) for one in blocks[built:]]
        first, begins, held, lost = Counter[int](), Counter[int](), 0, [0.0] * self._runs
        rest = math.fsum(self._lost)
        for k in sorted(range(self._runs), key=self._lost.__getitem__, reverse=True):
            least = math.fsum([*lost, rest if self._lost[k] < STOPPED else 0.0])
            if least > most * self._runs * len(blocks):
                return None
            self._yard.until.look()
            states = self._states[k][: same + 1]
            pieces = [*([] for _ in range(built)), *(runs[k] for runs in put)]
            run = put_up(blocks, pieces, settings.mu, settings.settle, states)
            if run.first_fall is not None and run.begins is not None:
                first[run.first_fall] += 1
                begins[run.begins] += 1
            lost[k] = sum(end.fallen for end in run.stones)
            lost[k] += STOPPED * max(end.nearness for end in run.stones) ** NEARLY
            rest -= self._lost[k]
            if self._first:
                continue
            held += sum(one.wall.held_bytes for one in states)
            if held < KNOWN_BYTES:
                self._states[k] = states
            if first.total() == ENOUGH:
                self._runs = k + 1
                break
        share = math.fsum(lost) / self._runs / len(blocks)
        if share > most:
            return None
        if not self._first:
            self._first, self._errors, self._lost = groups, errors, lost[: self._runs]
        return RehearsalFalls(share, first, begins)

    def _put(
        self, errors: BuilderErrors, group: Sequence[Outlined]
    ) -> list[list[tuple[int, Built]]]:
        """Return how a stone and its wedges are put down in all runs."""
        numbers = [
            stratified(np.random.default_rng([*self._draws, group[0][0], k]), self._drawn, 1)
            for k in range(len(group))
        ]
        return put_down_with(errors, group, np.concatenate(numbers, axis=1))
