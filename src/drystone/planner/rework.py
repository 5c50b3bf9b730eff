"""Take down the upper part of a wall and build it again, when that makes it better.

A greedy pass chooses well below and badly in the last course, when few stones are left.  Every
state of construction is kept, so the wall can go back to any of its steps; from there it is built
again with other weights, and the better wall is kept.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from drystone.metrics.measure import measure_labels
from drystone.planner.planner import Planner
from drystone.planner.vary import varied


@dataclass(frozen=True, eq=False)
class Incumbent:
    """The best wall so far.

    Parameters
    ----------
    planner : Planner
        Its :attr:`~Planner.build` is the wall.
    merit : float
        Of the finished wall.
    """

    planner: Planner
    merit: float


def rework(planner: Planner) -> Iterator[Incumbent]:
    """Improve the wall that a planner has built, round by round.

    Each round goes back by a random number of steps, varies the weights of the craft terms by
    random factors, builds to the end, and keeps the result when its merit is larger.

    Parameters
    ----------
    planner : Planner
        Whose :meth:`~Planner.steps` have come to an end.

    Yields
    ------
    incumbent : Incumbent
        The best wall after each round; the first is the wall as it was.
    """
    settings = planner.settings.rework
    best = Incumbent(planner, wall_merit(planner))
    yield best
    for number in range(1, settings.rounds + 1):
        rng = np.random.default_rng([planner.seed, 1_000_000 + number])
        states = best.planner.build.states()
        deepest = max(1, math.ceil(settings.deepest * (len(states) - 1)))
        back = int(rng.integers(1, deepest + 1))
        trial = Planner(
            planner.workshop.stones,
            planner.workshop.site,
            seed=int(rng.integers(2**31)),
            settings=varied(planner.settings, settings.spread, rng),
            executor=planner.executor,
            workshop=planner.workshop,
            profile=planner.profile,
        )
        trial.build = states[max(0, len(states) - 1 - back)]
        for _ in trial.steps():
            pass
        merit = wall_merit(trial)
        planner.failed_solves += trial.failed_solves
        planner.cold_solves += trial.cold_solves
        if merit > best.merit + 1e-12:
            best = Incumbent(trial, merit)
        yield best


def wall_merit(planner: Planner) -> float:
    """Return how good a finished wall is: a weighted sum of its figures of merit, or -inf."""
    weights = planner.settings.rework
    build = planner.build
    if not build.actions:
        return -math.inf
    resistance = build.actions[-1].resistance.value
    with planner.profile.part("metrics"):
        measured = measure_labels(
            build.wall.labels,
            wedge_ids={wedge.id for wedge in build.wall.wedges},
            wall_px=(build.wall.site.width_px, build.wall.site.height_px),
        )
    stones = planner.workshop.stones.total_area_px * build.wall.site.scale**2
    possible = min(1.0, stones / (build.wall.site.width_px * build.wall.site.height_px))
    return math.fsum(
        [
            weights.filling * build.wall.filling / possible,
            weights.resistance * min(1.0, resistance or 0.0),
            weights.vertical * (measured.F_AV or 0.0),
            -weights.horizontal * (measured.F_AH or 0.0),
            -weights.level * measured.T_LEVEL,
            -weights.flush * measured.E_FLUSH,
        ]
    )
