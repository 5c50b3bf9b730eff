"""Weights that differ from wall to wall."""

import math
from dataclasses import fields

import numpy as np

from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from drystone.planner.vary import varied
from drystone.selection.scored import ScoreSettings
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, order, rubble, same

WEIGHTS = [field.name for field in fields(ScoreSettings) if field.name != "analysed"]


def test_every_weight_gets_its_own_factor_and_nothing_else_changes():
    settings = method_settings("best")
    new = varied(settings, 0.3, np.random.default_rng(5))
    rng = np.random.default_rng(5)
    for name in WEIGHTS:
        factor = math.exp(0.3 * rng.normal())
        assert getattr(new.score, name) == getattr(settings.score, name) * factor
    assert new.vary == 0.0
    assert new.score.analysed == settings.score.analysed
    unvaried = {"score": settings.as_dict()["score"], "vary": settings.vary}
    assert new.updated(unvaried) == settings


def built(seed, vary):
    settings = greedy({"vary": vary})
    return finish(Planner(rubble(), RUBBLE_SITE, seed=seed, settings=settings))


def test_another_seed_gives_another_wall_and_the_same_seed_the_same():
    walls = {seed: built(seed, 0.3) for seed in (1, 2, 3)}
    assert len({tuple(order(planner)) for planner in walls.values()}) > 1
    assert same(built(2, 0.3), walls[2])
    # Without it nothing is random here.
    plain = [built(seed, 0.0) for seed in (1, 2)]
    assert same(*plain)
