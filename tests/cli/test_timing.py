"""Where the time of a plan with a search goes."""

import numpy as np
import pytest

from drystone.drawing.words.planned import profile_rows, profile_summary
from drystone.generate import RubbleSettings, rubble_stones
from drystone.planner.settings import method_settings
from drystone.search.plan_wall import plan_wall


@pytest.fixture(scope="module")
def searched():
    """A small wall, and three more that are searched."""
    sizes = RubbleSettings(count=8, width_px=100, height_px=36, courses=2)
    stones = rubble_stones(sizes, np.random.default_rng(1))
    changes = {"search": {"budget": 4}, "settle": {"trials": 0}, "goal": {"fallen": 0.0}}
    settings = method_settings("best").updated(changes)
    return plan_wall(stones, 100, 36, settings=settings, scale=1.0)


@pytest.mark.parametrize("jobs", [1, 2])
def test_the_search_is_a_row_and_its_workers_are_processes(searched, jobs):
    summary = profile_summary(searched, jobs)
    parts = summary["parts"]
    assert sum(parts.values()) == pytest.approx(summary["seconds"])
    assert parts["search"] > 0
    assert parts["other"] >= 0
    lines = dict(profile_rows(summary))
    assert lines["search"].endswith("%")  # no microseconds a candidate
    assert lines["processes"] == f"{jobs}; the search is by the clock"
    assert "threads" not in lines
    assert lines["steps"].endswith("(without those of the search)")
    assert lines["candidates"].endswith("(without those of the search)")
