"""A photograph that is turned by 90 or 180 degrees gives the same wall."""

import numpy as np
import pytest

from drystone.generate import FourierSettings, fourier_stones
from drystone.model.stone import Stone, StoneSet
from drystone.planner.settings import METHODS, method_settings
from drystone.search.plan_wall import plan_wall

STONES = fourier_stones(
    FourierSettings(count=9, smallest_radius_px=12, largest_radius_px=26, D2=0.2),
    np.random.default_rng(7),
)
VARIANTS = {
    "paper": {"two_sided": True},
    # Falls in rehearsals hang on the last digit of a place, which a turn may change.
    "best": {"search": {"budget": 2}, "goal": {"fallen": 0.0}},
}


@pytest.mark.parametrize("method", METHODS)
def test_the_plan_does_not_depend_on_how_the_photograph_was_turned(method):
    found = []
    for quarter in range(3):
        stones = [Stone(stone.id, np.rot90(stone.mask, quarter)) for stone in STONES]
        settings = method_settings(method).updated(VARIANTS[method])
        result = plan_wall(StoneSet(tuple(stones)), 190, 90, scale=0.4, seed=3, settings=settings)
        assert len(result.wall.groups) >= 6
        found.append(result)
    for quarter, turned in enumerate(found):
        np.testing.assert_array_equal(turned.wall.labels, found[0].wall.labels)
        # The figures are those of equal numbers added up in the same order, but for rounding.
        for name, value in vars(found[0].plan.metrics).items():
            assert getattr(turned.plan.metrics, name) == pytest.approx(value, abs=1e-9), name
        for at, first in zip(turned.wall.placements, found[0].wall.placements, strict=True):
            np.testing.assert_array_equal(at.posed.mask, first.posed.mask)
            turn = at.posed.angle_deg - first.posed.angle_deg + 90.0 * quarter
            assert np.sin(np.radians(2.0 * turn)) == pytest.approx(0.0, abs=1e-9)
