"""What is measured of an image: the wall in it, its joints, at the working resolution."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import LabelImageError
from drystone.metrics.frame import frame_wall, reduce_labels
from drystone.metrics.paths import joint_mask
from tests.metrics.walls import walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


def wall_in(height, width, top, left, stone=(4, 6)):
    labels = np.zeros((height, width), np.uint32)
    labels[top : top + stone[0], left : left + stone[1]] = 3
    return labels


@pytest.mark.parametrize(
    ("left", "width", "width_px", "ends", "stone"),
    [
        (7, 6, None, (0.0, 6.0), range(6)),
        # An image as wide as the wall keeps its columns; in another the stones are in the middle.
        (7, 6, 30.4, (0.0, 30.0), range(7, 13)),
        (20, 6, 11, (0.0, 11.0), range(2, 8)),
        # Stones wider than the wall stick out on both sides.
        (20, 9, 6, (1.5, 7.5), range(9)),
    ],
)
def test_end_lines(left, width, width_px, ends, stone):
    frame = frame_wall(wall_in(20, 30, top=5, left=left, stone=(4, width)), width_px)
    assert (frame.left_px, frame.right_px) == ends
    assert len(frame.labels) == 4
    assert frame.labels.shape[1] == max(len(stone), ends[1] - ends[0])
    assert np.flatnonzero(frame.labels[0]).tolist() == list(stone)


def test_no_stones_and_no_scale_are_refused_and_sizes_round_half_up():
    with pytest.raises(LabelImageError, match=r"E104 .*30x20 px are 0"):
        frame_wall(np.zeros((20, 30), np.uint32))
    assert reduce_labels(np.ones((5, 7), np.uint8), 0.5).shape == (3, 4)
    with pytest.raises(ValueError, match="scale must be positive"):
        reduce_labels(np.ones((5, 7), np.uint8), 0.0)


@repeatable()
@given(walls(max_px=16))
def test_joints_are_their_slow_twin(labels):
    assert np.array_equal(joint_mask(labels), naive.joint_mask(labels))


@repeatable()
@given(walls(), st.floats(0.05, 2.5) | st.just(1.0))
def test_reduced_is_its_slow_twin_and_a_copy(labels, scale):
    reduced = reduce_labels(labels, scale)
    assert np.array_equal(reduced, naive.reduce_labels(labels, scale))
    assert reduced.dtype == labels.dtype
    assert not np.shares_memory(reduced, labels)
