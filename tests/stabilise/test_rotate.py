"""Rotation about the end of the support (§3.7, Fig. 9b)."""

import math

import numpy as np
import pytest

from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.stabilise.rotate import rotate_to_rest, seat
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.support import support_polyline
from tests.naive import support as naive
from tests.naive.overlap import overlaps
from tests.stabilise.scenes import Pose, bar_on_the_ledge, ledge, mirrored


def rests(occupied: np.ndarray, pose: Pose) -> bool:
    posed, row, col = pose
    return naive.rests_stably(occupied, posed.mask, row, col, col + posed.anchor[0], 0.0)


@pytest.mark.parametrize("side", ["right", "left"])
def test_an_overhanging_bar_turns_towards_its_fall_until_it_rests(side: str) -> None:
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook())
    if side == "left":
        occupied, trial = mirrored(occupied, trial, PoseBook())
    assert not rests(occupied, trial)
    result = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings())
    assert result is not None
    (turned, row, col), pivots = result
    assert pivots >= 1
    # About asin(4 / 18): its free end comes down onto the ground.
    expected = -12.8 if side == "right" else 12.8
    assert turned.angle_deg == pytest.approx(expected, abs=2.5)
    assert not overlaps(occupied, turned.mask, row, col)
    assert np.array_equal(turned.mask, PoseBook().pose(turned.stone, turned.angle_deg).mask)
    assert rests(occupied, (turned, row, col))
    lowest = row + turned.height_px
    assert lowest == occupied.shape[0]  # it stands on the ground and on the ledge's edge
    support = support_polyline(occupied, turned, row, col)
    assert support is not None
    edge = support.left_x if side == "right" else occupied.shape[1] - support.right_x
    assert edge == pytest.approx(14, abs=6)  # a step of the turned edge lies on the ledge


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_centroid_goes_round_the_end_of_the_support(side: str) -> None:
    occupied = ledge(height=4, width=14)
    trial = bar_on_the_ledge(occupied, PoseBook(), col=10)
    if side == "left":
        occupied, trial = mirrored(occupied, trial, PoseBook())
    settings = StabiliseSettings(max_pivots=1, max_shift_px=1)
    result = rotate_to_rest(occupied, trial, PoseBook(), settings)
    assert result is not None
    (turned, row, col), _ = result
    # From (11, 3) right of and above A at (14, 4 px over the ground), turned with the stone.
    sign = 1 if side == "right" else -1
    angle = math.radians(-sign * turned.angle_deg)
    a_x = 14 if side == "right" else occupied.shape[1] - 14
    x = a_x + sign * (11 * math.cos(angle) + 3 * math.sin(angle))
    y = 4 + 3 * math.cos(angle) - 11 * math.sin(angle)
    assert angle > 0.1
    assert col + turned.anchor[0] == pytest.approx(x, abs=0.6)
    height = occupied.shape[0] - row - turned.height_px + turned.anchor[1]
    assert height == pytest.approx(y, abs=1.6)


def test_mirrored_scenes_have_mirrored_results() -> None:
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook())
    other_side, other = mirrored(occupied, trial, PoseBook())
    one = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings())
    two = rotate_to_rest(other_side, other, PoseBook(), StabiliseSettings())
    assert one is not None
    assert two is not None
    assert one[0][0].angle_deg == -two[0][0].angle_deg
    assert one[0][1] == pytest.approx(two[0][1], abs=1)


def test_a_stable_stone_is_left_alone() -> None:
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook(), col=0, length=20)
    result = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings())
    assert result is not None
    assert result[1] == 0
    assert result[0] == trial


@pytest.mark.parametrize(
    "limits", [{"max_turn_deg": 5.0}, {"max_pivots": 0}, {"max_turn_deg": 0.0}]
)
def test_limits_end_the_rotation(limits: dict[str, float]) -> None:
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook())
    settings = StabiliseSettings(**limits)  # type: ignore[arg-type]
    assert rotate_to_rest(occupied, trial, PoseBook(), settings) is None


def test_meeting_the_landscape_before_resting_ends_the_rotation() -> None:
    occupied = ledge()
    posed, row, col = bar_on_the_ledge(occupied, PoseBook())
    occupied[: row + 4, col + posed.width_px :] = True  # a wall close to its free end
    occupied[: row - 1, :] = True
    occupied[row - 1, 0:16] = True
    assert rotate_to_rest(occupied, (posed, row, col), PoseBook(), StabiliseSettings()) is None


def test_it_never_leaves_the_site() -> None:
    occupied = ledge(height=8, site=(24, 26))
    trial = bar_on_the_ledge(occupied, PoseBook(), col=2, length=24)
    before = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings(max_turn_deg=60))
    assert before is None or before[0][2] + before[0][0].width_px <= 26


def test_a_stone_in_the_air_does_not_rest() -> None:
    posed = PoseBook().pose(Stone(7, np.ones((6, 30), bool)), 0.0)
    assert rotate_to_rest(ledge(), (posed, 3, 10), PoseBook(), StabiliseSettings()) is None


def test_seat_takes_the_nearest_row_that_rests() -> None:
    occupied = ledge(height=4, width=14)
    posed = PoseBook().pose(Stone(9, np.ones((3, 5), bool)), 0.0)
    assert seat(occupied, posed, 17, 2, 3) == 17
    assert seat(occupied, posed, 15, 2, 3) == 17
    assert seat(occupied, posed, 19, 2, 3) == 17
    assert seat(occupied, posed, 13, 2, 3) is None
    assert seat(occupied, posed, 19, 20, 3) == 21  # on the ground
    assert seat(occupied, posed, 23, 20, 3) == 21
    assert seat(occupied, posed, 21, -1, 3) is None
    assert seat(occupied, posed, 21, 46, 3) is None
