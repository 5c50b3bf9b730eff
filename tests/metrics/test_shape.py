"""Sizes of stones, level tops and flush ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import LabelImageError
from drystone.metrics.frame import frame_wall
from drystone.metrics.shape import flush_deviation, level_deviation, stone_sizes
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
@given(walls(), st.floats(1, 50), st.floats(1, 50))
def test_level_and_flush_are_their_slow_twins(labels, wall_width, stone_px):
    expected = naive.level_deviation(labels, stone_px)
    assert level_deviation(labels, stone_px) == pytest.approx(expected, abs=1e-12)
    frame = frame_wall(labels, wall_width)
    expected = naive.flush_deviation(frame.labels, frame.left_px, frame.right_px, stone_px)
    assert flush_deviation(frame, stone_px) == pytest.approx(expected, abs=1e-12)
