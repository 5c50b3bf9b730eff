"""Sizes of stones, level tops and flush ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import LabelImageError
from drystone.metrics.frame import WallFrame, frame_wall
from drystone.metrics.shape import flush_deviation, level_deviation, stone_sizes, top_profile
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


def test_an_image_without_background_has_its_sizes_and_wedges_alone_are_no_wall():
    assert stone_sizes(bricks(2, 2, 5, 8)).area_px == 160
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


def test_level_and_flush_of_walls_of_bricks():
    full = bricks(4, 4, 10, 20)
    assert level_deviation(full, 10) == flush_deviation(frame_wall(full), 20) == 0.0
    higher = full.copy()  # half of it by a course
    higher[:10, 40:] = 0
    assert top_profile(higher)[[0, 79]].tolist() == [40, 30]
    assert level_deviation(higher, 10) == pytest.approx(0.5)
    toothed = full.copy()  # half a stone short at one end of every other course
    toothed[:10, 70:] = toothed[20:30, 70:] = 0
    assert flush_deviation(frame_wall(toothed), 20) == pytest.approx(0.125)
    short = frame_wall(bricks(2, 4, 10, 20), width_px=100)
    assert flush_deviation(short, 20) == pytest.approx(0.5)
    assert level_deviation(short.labels, 10) == pytest.approx((80 * 4 + 20 * 16) / 100 / 10)
    assert flush_deviation(WallFrame(bricks(2, 4, 10, 20), 5.0, 75.0), 20) == pytest.approx(0.25)
