"""Load factors without dilatancy of published walls, and how often there is an answer.

Walls of Ferris and Tin-Loi (2001), see drystone_lab.statics_cases.  The factors depend
on the method, which finds one of many; the least that a nonlinear solver found on the same
complementarity problems are .63898, .5574, .35582, .26374 and .2086.
"""

from dataclasses import replace

import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_load, nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone_lab.statics_cases import WALLS
from tests.statics.walls import irregular

ACCEPTED = {
    1: (0.638, 0.650),
    2: (0.550, 0.564),
    3: (0.350, 0.361),
    4: (0.262, 0.267),
    5: (0.205, 0.217),
}
QUICK = NonassociativeSettings(random_starts=0)


@pytest.mark.parametrize("wall", [w for w in WALLS if w.number in ACCEPTED], ids=lambda w: w.number)
def test_walls_of_ferris_and_tin_loi(wall):
    least, greatest = ACCEPTED[wall.number]
    both = nonassociative_resistance(wall.model, settings=QUICK)
    for result in (both.left, both.right):
        assert result.success
        assert result.check.holds
        assert least <= result.alpha <= min(greatest, wall.associative + 5e-6)


def test_descent_reaches_the_least_load_of_the_first_wall():
    without = replace(QUICK, patience=0)
    first = nonassociative_load(WALLS[0].model, "left", settings=without)
    assert first.alpha > 0.6395
    least = nonassociative_load(WALLS[0].model, "left", settings=QUICK)
    assert least.alpha == pytest.approx(0.63898, abs=5e-6)


def test_irregular_walls_with_an_answer():
    answered = asked = 0
    for seed in range(5):
        for mu in (0.58, 0.9):
            model = model_from_labels(irregular(seed, 18, 100, 70), mu).model
            associative = lateral_resistance(model)
            if not associative.stable:
                continue
            both = nonassociative_resistance(model, settings=QUICK)
            for result, above in zip(
                (both.left, both.right), (associative.left, associative.right), strict=True
            ):
                asked += 1
                answered += result.status is not LimitStatus.FAILED
                assert result.status is LimitStatus.FAILED or result.check.holds
                assert result.alpha is None or result.alpha <= above.alpha
    assert asked >= 8
    assert answered >= 0.95 * asked
