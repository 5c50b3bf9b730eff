import numpy as np
import pytest
from hypothesis import given

from drystone.metrics.arrangement import horizontal_arrangement, vertical_arrangement
from drystone.metrics.joints import joint_mask
from drystone.metrics.paths import JointPath, horizontal_paths, vertical_paths
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@repeatable()
@given(walls(max_px=40))
def test_are_their_slow_twins(labels):
    joint = joint_mask(labels)
    vertical = vertical_arrangement(vertical_paths(joint))
    assert vertical == pytest.approx(naive.vertical_arrangement(joint), abs=1e-9)
    horizontal = horizontal_arrangement(horizontal_paths(joint))
    assert horizontal == pytest.approx(naive.vertical_arrangement(joint.T), abs=1e-9)


def test_only_the_five_shortest_count():
    straight = JointPath(np.array([[0, 0], [1, 0], [2, 0]]))
    bent = JointPath(np.array([[0, 0], [1, 1], [2, 0]]))
    assert vertical_arrangement([bent] * 4 + [straight] * 5) == 0.0
    assert vertical_arrangement([bent] * 4 + [straight] * 4) == pytest.approx(
        100 * (np.sqrt(2) - 1) / 5
    )


def test_no_path_is_none_not_zero():
    assert vertical_arrangement([]) is None
    assert horizontal_arrangement([]) is None


def test_a_stack_bond_is_worse_than_a_running_bond():
    running = bricks(6, 6, 12, 30)
    stack = np.kron(np.arange(1, 37, dtype=np.uint32).reshape(6, 6), np.ones((12, 30), np.uint32))
    assert f_av(stack) < f_av(running)
    assert f_ah(running) < 2.0


def f_av(labels):
    return vertical_arrangement(vertical_paths(joint_mask(labels)))


def f_ah(labels):
    return horizontal_arrangement(horizontal_paths(joint_mask(labels)))
