"""How good a finished wall is: its figures of merit, weighed into one number."""

import math
from dataclasses import dataclass

from drystone.metrics.measure import measure_labels
from drystone.planner.build import Build
from drystone.planner.search_settings import GoalSettings
from drystone.planner.workshop import Workshop


@dataclass(frozen=True)
class Figures:
    """Figures of merit of a finished wall.

    Parameters
    ----------
    stones : int
        How many it has.
    F_SF, F_LR, F_AV, F_AH, T_LEVEL, E_FLUSH : float
        As :class:`drystone.metrics.measure.WallMetrics`; 0 where a figure is not defined.
    """

    stones: int
    F_SF: float
    F_LR: float
    F_AV: float
    F_AH: float
    T_LEVEL: float
    E_FLUSH: float


def figures_of(build: Build) -> Figures | None:
    """Measure a wall; None when it is empty."""
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
    )


def possible_filling(workshop: Workshop) -> float:
    """Return the area bound on F_SF: all stones, or a full wall."""
    site = workshop.site
    stones = workshop.stones.total_area_px * site.scale**2
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
        ]
    )


def _up(value: float, aim: float, urgent: float) -> float:
    """Return what a figure counts that shall be high: no more than its aim."""
    return value if aim == 0.0 else urgent * min(value, aim)


def _down(value: float, aim: float, urgent: float) -> float:
    """Return what a figure counts that shall be low: no less than its aim."""
    return value if aim == 0.0 else urgent * max(value, aim)
