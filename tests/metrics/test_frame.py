import numpy as np
import pytest

from drystone.errors import LabelImageError
from drystone.metrics.frame import frame_wall


def wall_in(height, width, top, left, stone=(4, 6)):
    labels = np.zeros((height, width), np.uint32)
    labels[top : top + stone[0], left : left + stone[1]] = 3
    return labels


def test_without_a_width_the_wall_ends_where_its_stones_end():
    frame = frame_wall(wall_in(20, 30, top=5, left=7))
    assert frame.labels.shape == (4, 6)
    assert (frame.left_px, frame.right_px) == (0.0, 6.0)


def test_an_image_as_wide_as_the_wall_keeps_its_columns():
    frame = frame_wall(wall_in(20, 30, top=5, left=7), width_px=30.4)
    assert frame.labels.shape == (4, 30)
    assert np.flatnonzero(frame.labels[0]).tolist() == list(range(7, 13))
    assert (frame.left_px, frame.right_px) == (0.0, 30.0)


def test_in_another_image_the_stones_stand_in_the_middle():
    frame = frame_wall(wall_in(20, 30, top=5, left=20), width_px=11)
    assert np.flatnonzero(frame.labels[0]).tolist() == list(range(2, 8))
    assert (frame.left_px, frame.right_px) == (0.0, 11.0)


def test_stones_wider_than_the_wall_stick_out_on_both_sides():
    frame = frame_wall(wall_in(20, 30, top=5, left=20, stone=(4, 9)), width_px=6)
    assert frame.labels.shape == (4, 9)
    assert (frame.left_px, frame.right_px) == (1.5, 7.5)


def test_an_image_without_stones_says_so():
    with pytest.raises(LabelImageError, match=r"E104 .*30x20 px are 0"):
        frame_wall(np.zeros((20, 30), np.uint32))


def test_a_picture_with_colours_is_no_label_image():
    with pytest.raises(ValueError, match="two dimensions, not 3"):
        frame_wall(np.ones((4, 4, 3), np.uint32))
