"""Load factors without dilatancy of published walls.

Walls of Ferris and Tin-Loi (2001), see drystone_lab.statics_cases.  The factors depend
on the method, which finds one of many; the least that a nonlinear solver found on the same
complementarity problems are .63898, .5574, .35582, .26374 and .2086.
"""

from dataclasses import replace

import pytest

from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_load, nonassociative_resistance
from drystone_lab.statics_cases import WALLS

ACCEPTED = {1: (0.63897, 0.650), 3: (0.350, 0.361), 5: (0.205, 0.217)}
QUICK = NonassociativeSettings(random_starts=0)


@pytest.mark.parametrize("wall", [w for w in WALLS if w.number in ACCEPTED], ids=lambda w: w.number)
def test_walls_of_ferris_and_tin_loi(wall):
    least, greatest = ACCEPTED[wall.number]
    both = nonassociative_resistance(wall.model, settings=QUICK)
    for result in (both.left, both.right):
        assert result.success
        assert result.check.holds
        assert least <= result.alpha <= min(greatest, wall.associative + 5e-6)
    if wall.number == 1:
        assert both.left.alpha == pytest.approx(0.63898, abs=5e-6)


def test_without_descent_the_least_load_of_the_first_wall_is_missed():
    without = replace(QUICK, patience=0)
    first = nonassociative_load(WALLS[0].model, "left", settings=without)
    assert first.alpha > 0.6395
