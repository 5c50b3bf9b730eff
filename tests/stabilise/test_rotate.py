"""Rotation about the end of the support (§3.7, Fig. 9b)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import rotate_to_rest, support_polyline
from tests.naive import support as naive
from tests.naive.overlap import overlaps
from tests.stabilise.scenes import BOOK, bar_on_the_ledge, ledge, mirrored, stairs
from tests.strategies import repeatable


def rests(occupied, pose):
    posed, row, col = pose
    return naive.rests_stably(occupied, posed.mask, row, col, col + posed.anchor[0], 0.0)


@pytest.mark.parametrize("side", ["right", "left"])
def test_an_overhanging_bar_turns_towards_its_fall_until_it_rests(side):
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook())
    if side == "left":
        occupied, trial = mirrored(occupied, trial, PoseBook())
    assert not rests(occupied, trial)
    nowhere = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings(max_pivots=0))
    assert nowhere.pose is None
    result = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings())
    assert result.pose is not None
    turned, row, col = result.pose
    assert result.pivots >= 1
    # About asin(4 / 18): its free end comes down onto the ground.
    expected = -12.8 if side == "right" else 12.8
    assert turned.angle_deg == pytest.approx(expected, abs=2.5)
    assert not overlaps(occupied, turned.mask, row, col)
    assert np.array_equal(turned.mask, PoseBook().pose(turned.stone, turned.angle_deg).mask)
    assert rests(occupied, (turned, row, col))
    lowest = row + turned.height_px
    assert lowest == occupied.shape[0]  # it stands on the ground and on the ledge's edge
    support = support_polyline(occupied, turned, row, col)
    edge = support.left_x if side == "right" else occupied.shape[1] - support.right_x
    assert edge == pytest.approx(14, abs=6)  # a step of the turned edge lies on the ledge


def test_a_stable_stone_is_left_alone():
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook(), col=0, length=20)
    result = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings())
    assert result.pivots == 0
    assert result.pose == trial
    assert result.depth == trial[1] + 6 + 1  # the rows of the bar, and the one below


@repeatable(80)
@given(
    scene=stairs(),
    settings=st.sampled_from(
        [
            StabiliseSettings(),
            StabiliseSettings(margin=0.1, max_turn_deg=70.0, step_deg=2.0),
            StabiliseSettings(max_turn_deg=40.0, max_pivots=2, new_pivot_px=0, max_shift_px=5),
            StabiliseSettings(new_pivot_px=60),
            StabiliseSettings(max_turn_deg=5.0),
        ]
    ),
)
def test_it_turns_as_a_walk_from_angle_to_angle_does(scene, settings):
    occupied, trial = scene
    result = rotate_to_rest(occupied, trial, BOOK, settings)
    expected = naive.rotated(occupied, trial, BOOK, settings)
    assert (result.pose and (result.pose, result.pivots)) == expected


def test_a_stone_in_the_air_does_not_rest():
    posed = PoseBook().pose(Stone(7, np.ones((6, 30), bool)), 0.0)
    result = rotate_to_rest(ledge(), (posed, 3, 10), PoseBook(), StabiliseSettings())
    assert result.pose is None
