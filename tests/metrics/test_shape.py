"""Sizes of stones, level tops and flush ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import LabelImageError
from drystone.metrics.flush import flush_deviation
from drystone.metrics.frame import WallFrame, frame_wall
from drystone.metrics.level import level_deviation, top_profile
from drystone.metrics.sizes import stone_sizes
from tests.metrics.walls import bricks, walls
from tests.naive import metrics as naive
from tests.strategies import repeatable


@repeatable()
@given(walls(), st.data())
def test_sizes_are_those_of_the_slow_twin(labels, data):
    ids = sorted({int(value) for value in labels.ravel()} - {0})
    wedges = data.draw(st.sets(st.sampled_from(ids), max_size=len(ids) - 1))
    sizes = stone_sizes(labels, wedges)
    mean_height, mean_width = naive.mean_sizes(labels, wedges)
    assert sizes.count == len(ids) - len(wedges)
    assert sizes.area_px == sum(int((labels == i).sum()) for i in ids if i not in wedges)
    assert sizes.mean_height_px == pytest.approx(mean_height)
    assert sizes.mean_width_px == pytest.approx(mean_width)


def test_an_image_without_background_has_its_sizes():
    assert stone_sizes(bricks(2, 2, 5, 8)).area_px == 160


def test_wedges_alone_are_no_wall():
    with pytest.raises(LabelImageError, match=r"E104 .*background or wedges"):
        stone_sizes(np.full((4, 4), 9, np.uint32), {9})


@repeatable()
@given(walls(), st.floats(1, 50))
def test_level_is_its_slow_twin(labels, height):
    expected = naive.level_deviation(labels, height)
    assert level_deviation(labels, height) == pytest.approx(expected, abs=1e-12)


@repeatable()
@given(walls(), st.floats(1, 50), st.floats(1, 50))
def test_flush_is_its_slow_twin(labels, wall_width, stone_width):
    frame = frame_wall(labels, wall_width)
    expected = naive.flush_deviation(frame.labels, frame.left_px, frame.right_px, stone_width)
    assert flush_deviation(frame, stone_width) == pytest.approx(expected, abs=1e-12)


def test_a_full_wall_is_level_and_flush():
    labels = bricks(4, 4, 10, 20)
    assert level_deviation(labels, 10) == 0.0
    assert flush_deviation(frame_wall(labels), 20) == 0.0


def test_half_a_wall_one_course_higher():
    labels = bricks(4, 4, 10, 20)
    labels[:10, 40:] = 0
    assert top_profile(labels)[[0, 79]].tolist() == [40, 30]
    assert level_deviation(labels, 10) == pytest.approx(0.5)


def test_a_wall_that_misses_half_a_stone_at_one_end_of_every_other_course():
    labels = bricks(4, 4, 10, 20)
    for course in (0, 2):
        labels[course * 10 : course * 10 + 10, 70:] = 0
    assert flush_deviation(frame_wall(labels), 20) == pytest.approx(0.125)


def test_a_wall_short_of_its_end_lines():
    frame = frame_wall(bricks(2, 4, 10, 20), width_px=100)
    assert flush_deviation(frame, 20) == pytest.approx(0.5)
    assert level_deviation(frame.labels, 10) == pytest.approx((80 * 4 + 20 * 16) / 100 / 10)


def test_stones_that_stick_out_are_not_flush():
    frame = WallFrame(bricks(2, 4, 10, 20), 5.0, 75.0)
    assert flush_deviation(frame, 20) == pytest.approx(0.25)
