"""Craft weights that differ from wall to wall, so that another seed gives another wall."""

import math
from dataclasses import fields, replace

import numpy as np

from drystone.planner.settings import PlannerSettings
from drystone.selection.scored import ScoreSettings


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
