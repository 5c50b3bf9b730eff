"""What is drawn from a seed: streams of numbers, and craft weights that differ between walls."""

import math
from dataclasses import fields, replace

import numpy as np

from drystone.planner.settings import PlannerSettings
from drystone.selection.scored import ScoreSettings

WEIGHT_DRAWS, CHAIN_DRAWS, FIRST_DRAWS, REPAIR_DRAWS = (k * 1_000_000 for k in (2, 3, 4, 5))
"""Follow a plan's seed, and keep these streams apart from those of its steps, numbered from 0."""

TRIAL_DRAWS, REHEARSAL_DRAWS = 7, 8
"""Begin the streams of errors of builders, which are the same for all seeds of plans."""


def varied(settings: PlannerSettings, spread: float, rng: np.random.Generator) -> PlannerSettings:
    """Return settings with every craft weight multiplied by a random factor.

    `spread` is the standard deviation of the logarithm of the factors; 0 changes nothing.  The
    planner that gets them does not vary them again.
    """
    score = settings.score
    weights = {
        field.name: getattr(score, field.name) * math.exp(spread * rng.normal())
        for field in fields(ScoreSettings)
        if field.name != "analysed"
    }
    return replace(settings, score=replace(score, **weights), vary=0.0)
