"""The indices of ten random steps against code that was written from the paper alone."""

import numpy as np
import pytest

from drystone.generate import RubbleSettings, rubble_stones
from drystone.model.site import Site
from drystone.planner.planner import Planner
from tests.naive.planner import SlowPlanner


def test_the_indices_of_ten_random_steps() -> None:
    rng = np.random.default_rng(2024)
    compared = 0
    for seed in (1, 2):
        stones = rubble_stones(
            RubbleSettings(count=18, width_px=170, height_px=64, courses=4),
            np.random.default_rng(seed),
        )
        planner = Planner(stones, Site(170, 64), seed=seed)
        actions = [step.action for step in planner.steps()]
        slow = SlowPlanner(stones, Site(170, 64), seed)
        chosen = {*rng.choice(len(actions), size=5, replace=False).tolist()}
        for number, action in enumerate(actions):
            at, wedges = action.stabilised.placement, action.stabilised.wedges
            if number in chosen:
                height = action.proposal.course_height_px
                tried = slow.judged(at, wedges, [] if height is None else [height])
                expected, found = tried.action.indices, action.indices
                assert found.boundary is expected.boundary
                for name, value in found.as_dict().items():
                    assert value == pytest.approx(expected.as_dict()[name], abs=1e-9), name
                compared += 1
            slow.build(slow.judged(at, wedges, []) if number not in chosen else tried)
    assert compared == 10
