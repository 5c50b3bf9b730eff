"""A wall that is begun, built on stone by stone."""

from numpy.random import Generator

from drystone.planner.build import Build
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.vary import varied
from drystone.planner.workshop import Workshop


def built_up(
    build: Build,
    workshop: Workshop,
    settings: PlannerSettings,
    rng: Generator,
    until: Deadline = NEVER,
) -> Planner:
    """Build on to the end, with craft weights varied; `TimeIsUp` where there is no time for it."""
    planner = Planner(
        workshop.stones,
        workshop.site,
        seed=int(rng.integers(2**31)),
        settings=varied(settings, settings.search.spread, rng),
        workshop=workshop,
    )
    planner.build = build
    for _ in planner.steps(until):
        pass
    return planner
