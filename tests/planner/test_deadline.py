"""A time limit strikes once the clock is past it.  What it leaves: `search/test_plan_wall.py`."""

import math

import pytest

from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from tests.planner import scenes


def test_it_strikes_once_the_clock_is_past_it():
    clock = scenes.Ticks()
    until = Deadline.after(2.0, clock)  # looks at the clock: it is 1
    until.look()
    until.look()
    with pytest.raises(TimeIsUp):
        until.look()


def test_no_limit_never_strikes():
    assert NEVER.at == math.inf
    assert Deadline.after(math.inf).at == math.inf
    NEVER.look()
