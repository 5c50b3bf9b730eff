"""How good a finished wall is: its figures of merit, weighed into one number."""

import math
from collections.abc import Collection
from dataclasses import dataclass

from drystone.metrics.measure import measure_labels
from drystone.planner.build import Build
from drystone.planner.search_settings import GoalSettings
from drystone.planner.workshop import Workshop

MISSING = 10.0
"""Units of merit that a pinned stone counts which is not in the wall."""


@dataclass(frozen=True)
class Figures:
    """Figures of merit of a finished wall.

    Parameters
    ----------
    stones : int
        How many it has.
    F_SF, F_LR, F_AV, F_AH, T_LEVEL, E_FLUSH : float
        As :class:`drystone.metrics.measure.WallMetrics`; 0 where a figure is not defined.
    missing : int
        How many pinned stones it lacks.
    """

    stones: int
    F_SF: float
    F_LR: float
    F_AV: float
    F_AH: float
    T_LEVEL: float
    E_FLUSH: float
    missing: int = 0


def figures_of(build: Build, pinned: Collection[int] = ()) -> Figures | None:
    """Measure a wall, and count the pinned stones that it lacks; None when it is empty."""
    if not build.actions:
        return None
    site = build.wall.site
    measured = measure_labels(
        build.wall.labels,
        wedge_ids={wedge.id for wedge in build.wall.wedges},
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
    )


def usable_area_px(workshop: Workshop) -> int:
    """Return the area of all stones that fit and are not banned, source px."""
    return sum(workshop.stones.by_id(stone_id).area_px for stone_id in workshop.fitting)


def possible_filling(workshop: Workshop) -> float:
    """Return the area bound on F_SF: all stones that may be used, or a full wall."""
    site = workshop.site
    stones = usable_area_px(workshop) * site.scale**2
    return min(1.0, stones / (site.width_px * site.height_px))


def merit_of(figures: Figures | None, possible: float, goal: GoalSettings) -> float:
    """Weigh the figures of a wall.

    Parameters
    ----------
    figures : Figures or None
        None for an empty wall, the worst of all.
    possible : float
        Largest F_SF that the stones allow.
    goal : GoalSettings
        Weights and aims.

    Returns
    -------
    float
        Higher is better.
    """
    if figures is None:
        return -math.inf
    return math.fsum(
        [
            goal.filling * _up(figures.F_SF, goal.F_SF, goal.urgent) / possible,
            goal.resistance * _up(min(1.0, figures.F_LR), goal.F_LR, goal.urgent),
            goal.vertical * _up(figures.F_AV, goal.F_AV, goal.urgent),
            -goal.horizontal * _down(figures.F_AH, goal.F_AH, goal.urgent),
            -goal.level * figures.T_LEVEL,
            -goal.flush * figures.E_FLUSH,
            -MISSING * figures.missing,
        ]
    )


def _up(value: float, aim: float, urgent: float) -> float:
    """Return what a figure counts that shall be high: no more than its aim."""
    return value if aim == 0.0 else urgent * min(value, aim)


def _down(value: float, aim: float, urgent: float) -> float:
    """Return what a figure counts that shall be low: no less than its aim."""
    return value if aim == 0.0 else urgent * max(value, aim)
