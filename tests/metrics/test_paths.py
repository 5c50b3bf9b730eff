import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from skimage.graph import MCP_Geometric

from drystone.metrics import paths
from drystone.metrics.joints import joint_mask
from tests.kernels.test_paths import noise
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable

JOINTS = st.builds(
    noise,
    st.tuples(st.integers(2, 14), st.integers(21, 45)),
    st.sampled_from([0.6, 0.8]),
    st.integers(0, 10**6),
)


@repeatable()
@given(JOINTS)
def test_lengths_are_those_of_the_slow_twin(joint):
    expected = pytest.approx(naive.vertical_lengths(joint), abs=1e-9)
    assert [path.length_px for path in paths.vertical_paths(joint)] == expected
    turned = joint.T
    assert [path.length_px for path in paths.horizontal_paths(turned)] == expected
    assert paths.horizontal_lengths(turned) == tuple(
        path.length_px for path in paths.horizontal_paths(turned)
    )


@repeatable()
@given(walls())
def test_pixels_lead_along_the_joints_from_top_to_bottom(labels):
    joint = joint_mask(labels)
    for path in paths.vertical_paths(joint):
        rows, cols = path.pixels.T
        assert joint[rows, cols].all()
        assert (rows[0], rows[-1]) == (0, joint.shape[0] - 1)
        assert cols[0] == cols[-1]
        steps = np.abs(np.diff(path.pixels, axis=0))
        assert (steps.max(axis=1) == 1).all()
        assert path.length_px == pytest.approx(np.hypot(*steps.T).sum())
    for path in paths.horizontal_paths(joint):
        rows, cols = path.pixels.T
        assert joint[rows, cols].all()
        assert (cols[0], cols[-1]) == (0, joint.shape[1] - 1)
        assert rows[0] == rows[-1]


def test_an_independent_solver_finds_the_same_lengths():
    joint = joint_mask(bricks(5, 4, 11, 23))
    lengths = []
    for column in range(10, joint.shape[1] - 10, joint.shape[1] // 10):
        solver = MCP_Geometric(np.where(joint, 1.0, -1.0))
        costs = solver.find_costs([(0, column)], [(joint.shape[0] - 1, column)])[0]
        lengths.append(costs[-1, column])
    found = [path.length_px for path in paths.vertical_paths(joint)]
    assert found == pytest.approx(sorted(lengths), abs=1e-9)


def test_starts_stand_ten_pixels_from_the_ends_and_a_tenth_of_the_width_apart():
    columns = [path.pixels[0, 1] for path in paths.vertical_paths(np.ones((5, 57), bool))]
    assert columns == [10, 15, 20, 25, 30, 35, 40, 45]
    assert paths.vertical_paths(np.ones((5, 20), bool)) == ()


@pytest.mark.parametrize("stone", [(2, slice(None)), (0, 10)], ids=["across", "at the start"])
def test_where_a_stone_is_in_the_way_there_is_no_path(stone):
    joint = np.ones((5, 21), bool)
    joint[stone] = False
    assert paths.vertical_paths(joint) == paths.horizontal_paths(joint.T) == ()
    assert paths.vertical_arrangement(joint) is None


@repeatable()
@given(walls(max_px=40))
def test_arrangements_are_their_slow_twins(labels):
    joint = joint_mask(labels)
    vertical = paths.vertical_arrangement(joint)
    assert vertical == pytest.approx(naive.vertical_arrangement(joint), abs=1e-9)
    horizontal = paths.horizontal_arrangement(joint)
    assert horizontal == pytest.approx(naive.vertical_arrangement(joint.T), abs=1e-9)


def test_only_the_five_shortest_count():
    # Five of eight starts lead straight down; from the others a stone is in the way.
    joint = np.ones((5, 57), bool)
    joint[2, [10, 15, 20]] = False
    assert paths.vertical_arrangement(joint) == 0.0
    joint[2, 25] = False
    assert paths.vertical_arrangement(joint) == pytest.approx(100 * (np.sqrt(2) - 1) / 2 / 5)
    assert paths.mean_excess([2.0, 2 * math.sqrt(2)], 2) == pytest.approx(50 * (np.sqrt(2) - 1))
