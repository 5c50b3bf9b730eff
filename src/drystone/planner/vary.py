"""What is drawn from a seed: streams of numbers, and craft weights that differ between walls."""

import math
from collections.abc import Iterable
from dataclasses import fields, replace
from typing import TypeVar

from numpy.random import Generator

from drystone.planner.search_settings import LayingSettings
from drystone.planner.settings import PlannerSettings
from drystone.selection.scored import ScoreSettings

WEIGHT_DRAWS, CHAIN_DRAWS, FIRST_DRAWS, REPAIR_DRAWS = (k * 1_000_000 for k in (2, 3, 4, 5))
"""Follow a plan's seed, and keep these streams apart from those of its steps, numbered from 0."""

TRIAL_DRAWS, REHEARSAL_DRAWS = 7, 8
"""Begin the streams of errors of builders, which are the same for all seeds of plans."""

Weights = TypeVar("Weights", ScoreSettings, LayingSettings)


def varied(settings: PlannerSettings, spread: float, rng: Generator) -> PlannerSettings:
    """Return settings with every craft weight multiplied by a random factor.

    `spread` is the standard deviation of the logarithm of the factors; 0 changes nothing.  The
    planner that gets them does not vary them again.
    """
    names = (field.name for field in fields(ScoreSettings) if field.name != "analysed")
    return replace(settings, score=multiplied(settings.score, names, spread, rng), vary=0.0)


def multiplied(weights: Weights, names: Iterable[str], spread: float, rng: Generator) -> Weights:
    """Return settings with some of their weights multiplied by random factors."""
    new = {name: getattr(weights, name) * math.exp(spread * rng.normal()) for name in names}
    return replace(weights, **new)
