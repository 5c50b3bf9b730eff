"""Stones that were measured partly outside of the wall."""

import pytest

from drystone.errors import InputError
from drystone.model.site import Site
from drystone.planner.measured import MeasuredPose
from drystone.planner.planner import Planner
from tests.planner.scenes import blocks, greedy

LOWER, UPPER = MeasuredPose(30.0, 5.0, 0.0), MeasuredPose(30.0, 15.0, 0.0)
"""Two blocks, 10 px high, one on the other."""


@pytest.mark.parametrize(("height_px", "scale"), [(19.7, 1.0), (19.55, 1.0), (19.2, 0.5)])
def test_half_a_working_px_above_the_top_is_in_the_wall(height_px: float, scale: float) -> None:
    site = Site.from_source(60.0, height_px, scale)
    one = Planner(blocks({1: (20, 10), 2: (20, 10)}), site, settings=greedy())
    assert one.observe({1: LOWER, 2: UPPER}).stands
    assert [action.stone_id for action in one.build.actions] == [1, 2]


@pytest.mark.parametrize(("height_px", "scale"), [(19.4, 1.0), (16.0, 1.0), (18.4, 0.5)])
def test_what_is_further_above_the_top_is_not(height_px: float, scale: float) -> None:
    site = Site.from_source(60.0, height_px, scale)
    one = Planner(blocks({1: (20, 10), 2: (20, 10)}), site, settings=greedy())
    with pytest.raises(InputError, match="E198 observe: stone 2"):
        one.observe({1: LOWER, 2: UPPER})


def test_a_stone_longer_than_the_wall_is_not_in_it() -> None:
    settings = greedy().updated({"skip_too_large": True})
    one = Planner(blocks({1: (20, 10), 2: (46, 10)}), Site(45, 40), settings=settings)
    with pytest.raises(InputError, match="E198 observe: stone 2"):
        one.observe({2: MeasuredPose(22.0, 5.0, 0.0)})
