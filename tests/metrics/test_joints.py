import numpy as np
from hypothesis import given

from drystone.metrics.joints import joint_mask
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@repeatable()
@given(walls(max_px=16))
def test_is_its_slow_twin(labels):
    assert np.array_equal(joint_mask(labels), naive.joint_mask(labels))


def test_touching_stones_have_a_joint_of_two_pixels():
    labels = np.repeat([[1, 2]], 5, axis=1).repeat(4, axis=0).astype(np.uint32)
    assert np.flatnonzero(joint_mask(labels)[2, 1:-2]).tolist() == [4, 5]


def test_the_edge_of_the_image_erodes_nothing():
    joint = joint_mask(np.ones((4, 5), np.uint8))
    assert not joint[1:-2, 1:-2].any()


def test_padding_is_one_above_two_below_one_left_two_right():
    stone = ~joint_mask(np.ones((4, 5), np.uint8))
    rows, cols = np.flatnonzero(stone.any(axis=1)), np.flatnonzero(stone.any(axis=0))
    assert stone.shape == (7, 8)
    assert rows.tolist() == [1, 2, 3, 4]
    assert cols.tolist() == [1, 2, 3, 4, 5]


def test_one_stone_in_two_shades_of_id_is_two_stones():
    labels = bricks(1, 1, 6, 6)
    labels[:, 3:] = 70_000
    assert joint_mask(labels)[3, 3:5].all()
