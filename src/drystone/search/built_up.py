"""A wall that is begun, built on stone by stone."""

from numpy.random import Generator

from drystone.planner.build import Build
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.vary import varied
from drystone.planner.workshop import Workshop


def built_up(
    build: Build, workshop: Workshop, settings: PlannerSettings, rng: Generator
) -> Planner:
    """Build on to the end, with craft weights varied."""
    planner = Planner(
        workshop.stones,
        workshop.site,
        seed=int(rng.integers(2**31)),
        settings=varied(settings, settings.search.spread, rng),
        workshop=workshop,
    )
    planner.build = build
    for _ in planner.steps():
        pass
    return planner
