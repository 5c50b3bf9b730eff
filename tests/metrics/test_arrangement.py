import numpy as np
import pytest
from hypothesis import given

from drystone.metrics.arrangement import (
    horizontal_arrangement,
    mean_excess,
    vertical_arrangement,
)
from drystone.metrics.joints import joint_mask
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@repeatable()
@given(walls(max_px=40))
def test_are_their_slow_twins(labels):
    joint = joint_mask(labels)
    vertical = vertical_arrangement(joint)
    assert vertical == pytest.approx(naive.vertical_arrangement(joint), abs=1e-9)
    horizontal = horizontal_arrangement(joint)
    assert horizontal == pytest.approx(naive.vertical_arrangement(joint.T), abs=1e-9)


def test_only_the_five_shortest_count():
    straight, bent = 2.0, 2 * np.sqrt(2)
    assert mean_excess([straight] * 5 + [bent] * 4, 2) == 0.0
    assert mean_excess([straight] * 4 + [bent] * 4, 2) == pytest.approx(100 * (np.sqrt(2) - 1) / 5)
    assert mean_excess([straight, bent], 2) == pytest.approx(50 * (np.sqrt(2) - 1))


def test_no_path_is_none_not_zero():
    joint = np.ones((8, 40), bool)
    joint[3] = False
    assert mean_excess([], 7) is None
    assert vertical_arrangement(joint) is None
    assert horizontal_arrangement(joint.T) is None


def test_a_stack_bond_is_worse_than_a_running_bond():
    running = joint_mask(bricks(6, 6, 12, 30))
    stack = np.kron(np.arange(1, 37, dtype=np.uint32).reshape(6, 6), np.ones((12, 30), np.uint32))
    assert vertical_arrangement(joint_mask(stack)) < vertical_arrangement(running)
    assert horizontal_arrangement(running) < 2.0
