"""Initial poses, orientation sets and the pixels of a turned stone (§3.6, Eq. 3, DESIGN 4.2)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import UsageError
from drystone.kernels.raster import Mask
from drystone.model.stone import Stone
from drystone.poses import (
    PoseBook,
    bounding_box_shape_factor,
    initial_angle_deg,
    orientation_step_deg,
    pose_at,
    wrap_deg,
)
from tests.naive import raster as naive
from tests.strategies import blobs, masks, repeatable

L_MASK = np.array([[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 1]], bool)
SCALES = st.sampled_from([1.0, 0.5, 0.3, 0.2])


@repeatable()
@given(mask=masks(), angle=st.floats(-180, 180))
def test_shape_factor_is_that_of_the_turned_polygon(mask: Mask, angle: float) -> None:
    assert bounding_box_shape_factor(Stone(1, mask), angle) == pytest.approx(
        naive.shape_factor(mask, angle)
    )


@repeatable(25)
@given(mask=masks())
def test_initial_angle_maximises_shape_factor_over_whole_degrees(mask: Mask) -> None:
    factors = {a: naive.shape_factor(mask, a) for a in range(-45, 45)}
    best = max(factors.values())
    level = [a for a, factor in factors.items() if factor >= best - 1e-9]
    angle = initial_angle_deg(Stone(1, mask))
    assert angle in level
    assert abs(angle) == min(abs(a) for a in level)


@pytest.mark.parametrize("tilt", [-40, -17, 8, 30])
def test_a_tilted_block_is_turned_upright(tilt: int) -> None:
    y, x = np.mgrid[40:-41:-1, -40:41].astype(float)
    t = math.radians(tilt)
    along, across = x * math.cos(t) + y * math.sin(t), y * math.cos(t) - x * math.sin(t)
    block = Stone(1, (abs(along) < 30) & (abs(across) < 12))
    assert initial_angle_deg(block) == pytest.approx(-tilt, abs=1)


@pytest.mark.parametrize("quarters", [0, 1, 2, 3])
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_quarter_turns_of_a_pose_are_exact_and_not_mirrored(quarters: int, scale: float) -> None:
    source = np.kron(L_MASK, np.ones((4, 4), bool))
    posed = PoseBook(scale).pose(Stone(1, source), 90.0 * quarters)
    reduced = np.kron(L_MASK, np.ones((int(4 * scale), int(4 * scale)), bool))
    assert np.array_equal(posed.mask, np.rot90(reduced, quarters))


@repeatable(40)
@given(mask=blobs(min_px=10, max_px=40), angle=st.floats(-180, 180), scale=SCALES)
def test_area_is_kept_within_one_percent_or_two_pixels(
    mask: Mask, angle: float, scale: float
) -> None:
    posed = PoseBook(scale).pose(Stone(1, mask), angle)
    area = int(mask.sum()) * scale**2
    assert abs(posed.area_px - area) <= max(0.01 * area, 2.0)


@repeatable(25)
@given(mask=blobs(), angle=st.floats(-180, 180), scale=SCALES)
def test_the_anchor_is_where_the_centroid_of_the_turned_stone_falls(
    mask: Mask, angle: float, scale: float
) -> None:
    stone = Stone(5, mask, left_px=30, bottom_px=40)
    posed = PoseBook(scale).pose(stone, angle)
    assert [(a * 64).is_integer() for a in posed.anchor] == [True, True]
    window = (-2, -2, posed.width_px + 2, posed.height_px + 2)
    exact = naive.coverage(mask, stone.local_centroid, posed.angle_deg, scale, posed.anchor, window)
    got = np.pad(posed.mask, 2)
    k = max(4, math.ceil(1 / scale))
    decided = abs(exact - 0.5) > 1 / k
    assert np.array_equal(got[decided], exact[decided] >= 0.5)


def test_a_pose_depends_on_the_pixels_not_on_the_id_or_the_place() -> None:
    one = PoseBook(0.5).pose(Stone(1, L_MASK), 25.0)
    other = PoseBook(0.5).pose(Stone(2**32 - 1, L_MASK, 100, 200), 25.0)
    assert np.array_equal(one.mask, other.mask)
    assert one.anchor == other.anchor


def test_a_pose_can_be_made_again_from_angle_and_anchor() -> None:
    stone = Stone(1, np.kron(L_MASK, np.ones((5, 5), bool)))
    posed = PoseBook(0.3).pose(stone, -37.0)
    again, left, bottom = pose_at(stone, -37.0, 0.3, (posed.anchor[0] % 1.0, posed.anchor[1] % 1.0))
    assert np.array_equal(again.mask, posed.mask)
    assert (left, bottom) == (-math.floor(posed.anchor[0]), -math.floor(posed.anchor[1]))


def test_the_book_makes_each_pose_once() -> None:
    book, stone = PoseBook(), Stone(1, L_MASK)
    assert book.pose(stone, 190.0) is book.pose(stone, -170.0)
    assert book.pose(stone, 190.0).angle_deg == -170.0


def test_orientation_sets() -> None:
    book, stone = PoseBook(), Stone(1, np.kron(L_MASK, np.ones((3, 3), bool)))
    first = book.initial_angle(stone)

    def angles(orientations: str) -> list[float]:
        return [posed.angle_deg for posed in book.orientations(stone, orientations)]

    assert angles("sf") == [first]
    assert angles("quarter") == [wrap_deg(first + turn) for turn in (0, 90, 180, 270)]
    assert angles("10deg") == [-180.0 + 10 * i for i in range(36)]
    assert angles("50deg") == [-180.0, -130.0, -80.0, -30.0, 20.0, 70.0, 120.0, 170.0]
    assert angles("360deg") == [-180.0]


def test_poses_with_the_same_pixels_are_given_once() -> None:
    square = Stone(1, np.ones((5, 5), bool))
    assert len(PoseBook().orientations(square, "quarter")) == 1
    bar = Stone(2, np.ones((3, 5), bool))
    assert len(PoseBook().orientations(bar, "quarter")) == 2


@pytest.mark.parametrize(
    "text", ["", "10", "deg", "0deg", "-5deg", "0.001deg", "361deg", "nandeg", "SF"]
)
def test_unknown_orientation_sets_are_refused(text: str) -> None:
    with pytest.raises(UsageError, match=r"E122 --orientations: .*Use sf, quarter, or a step"):
        orientation_step_deg(text)


@given(angle=st.floats(-2000, 2000))
@repeatable()
def test_wrap(angle: float) -> None:
    wrapped = wrap_deg(angle)
    assert -180.0 <= wrapped < 180.0
    assert math.cos(math.radians(wrapped - angle)) == pytest.approx(1.0)
