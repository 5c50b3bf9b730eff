import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.metrics import paths
from drystone.metrics.paths import joint_mask
from tests.kernels.test_paths import noise
from tests.metrics.walls import walls
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
    turned = [path.pixels[:, ::-1].tolist() for path in paths.horizontal_paths(joint.T)]
    assert turned == [path.pixels.tolist() for path in paths.vertical_paths(joint)]


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


@repeatable(30)
@given(walls(max_px=36))
def test_arrangements_are_their_slow_twins(labels):
    joint = joint_mask(labels)
    found = paths.vertical_arrangement(joint), paths.horizontal_arrangement(joint)
    for each, way in zip(found, (joint, joint.T), strict=True):
        assert each == pytest.approx(naive.vertical_arrangement(way), abs=1e-9)
