"""How good a finished wall is: its figures of merit, weighed into one number."""

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

from drystone.craft.bond import bond_faults
from drystone.craft.masonry import Masonry
from drystone.craft.settings import CraftSettings
from drystone.metrics.measure import measure_labels
from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.search_settings import GoalSettings
from drystone.planner.workshop import Workshop
from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus

MISSING = 10.0
"""Units of merit that a pinned stone counts which is not in the wall."""

SCANNED = CraftSettings(sample=0.07)
"""Bond is looked at along fewer lines than `craft` does, for every wall of a search."""


@dataclass(frozen=True)
class Figures:
    """Figures of merit of a finished wall."""

    stones: int  # How many it has
    F_SF: float  # As `drystone.metrics.measure.WallMetrics`; 0 where a figure is not defined
    F_LR: float
    F_AV: float
    F_AH: float
    T_LEVEL: float
    E_FLUSH: float
    missing: int = 0  # How many pinned stones it lacks
    # Faults of its bond (`drystone.craft.bond.bond_faults`); 0 for a wall of pixels
    bond: float = 0.0
    # F_LR without dilatancy, 0 where the wall can fall by itself; None where it was not asked
    # for (`with_coulomb`)
    F_LR_coulomb: float | None = None

    @property
    def carried(self) -> float:
        """The smaller of both lateral resistances, as far as they are known."""
        return self.F_LR if self.F_LR_coulomb is None else min(self.F_LR, self.F_LR_coulomb)


def figures_of(build: Build, pinned: Collection[int] = ()) -> Figures | None:
    """Measure a wall, and count the pinned stones that it lacks; None when it is empty."""
    if not build.actions:
        return None
    site, outlines = build.wall.site, build.wall.outlines
    wedges = {wedge.id for wedge in build.wall.wedges}
    bond = 0.0
    if outlines is not None:
        bond = bond_faults(Masonry(dict(outlines.blocks), None, wedges, settings=SCANNED))
    measured = measure_labels(
        build.wall.labels,
        wedge_ids=wedges,
        wall_px=(site.width_px, site.height_px),
    )
    return Figures(
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


def with_coulomb(
    figures: Figures,
    model: RigidBlockModel,
    settings: NonassociativeSettings,
    until: Deadline = NEVER,
) -> Figures:
    """Add what a wall carries without dilatancy, the least that is found (DESIGN 4.8).

    Where nothing is found the associative value stands, above which none can be.  Where the time
    limit strikes, :class:`TimeIsUp` is raised.
    """
    found = nonassociative_resistance(model, settings=settings, look=until.look)
    least = figures.F_LR
    for end in (found.left, found.right):
        if end.status is LimitStatus.UNSTABLE:
            least = 0.0
        elif end.alpha is not None:
            least = min(least, end.alpha / found.mu)
    return replace(figures, F_LR_coulomb=least)


def usable_area_px(workshop: Workshop) -> int:
    """Return the area of all stones that fit and are not banned, source px."""
    return sum(workshop.stones.by_id(stone_id).area_px for stone_id in workshop.fitting)


def possible_filling(workshop: Workshop) -> float:
    """Return the area bound on F_SF: all stones that may be used, or a full wall."""
    site = workshop.site
    stones = usable_area_px(workshop) * site.scale**2
    return min(1.0, stones / (site.width_px * site.height_px))


def merit_of(figures: Figures | None, possible: float, goal: GoalSettings) -> float:
    """Weigh the figures of a wall."""
    if figures is None:
        return -math.inf
    return math.fsum(
        [
            goal.filling * _up(figures.F_SF, goal.F_SF, goal.urgent) / possible,
            goal.resistance * _up(min(1.0, figures.carried), goal.F_LR, goal.urgent),
            goal.vertical * _up(figures.F_AV, goal.F_AV, goal.urgent),
            -goal.horizontal * _down(figures.F_AH, goal.F_AH, goal.urgent),
            -goal.level * figures.T_LEVEL,
            -goal.flush * figures.E_FLUSH,
            -goal.bond * figures.bond,
            -MISSING * figures.missing,
        ]
    )


def _up(value: float, aim: float, urgent: float) -> float:
    """Return what a figure counts that shall be high: no more than its aim."""
    return value if aim == 0.0 else urgent * min(value, aim)


def _down(value: float, aim: float, urgent: float) -> float:
    """Return what a figure counts that shall be low: no less than its aim."""
    return value if aim == 0.0 else urgent * max(value, aim)
