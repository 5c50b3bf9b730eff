"""Initial poses, orientation sets and the pixels of a turned stone (§3.6, Eq. 3, DESIGN 4.2)."""

import math
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import UsageError
from drystone.indices import shape_factor
from drystone.kernels.raster import quantise, rotation, wrap_deg
from drystone.model.stone import Stone
from drystone.poses import PoseBook, RecentlyUsed, initial_angle_deg, orientation_step_deg
from tests.naive import indices
from tests.naive import raster as naive
from tests.strategies import blobs, masks, repeatable, stones

L_MASK = np.array([[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 1]], bool)


@repeatable(25)
@given(mask=masks())
def test_initial_angle_maximises_shape_factor_over_whole_degrees(mask):
    factors = {a: indices.shape_factor(mask, a) for a in range(-45, 45)}
    best = max(factors.values())
    level = [a for a, factor in factors.items() if factor >= best - 1e-9]
    angle = initial_angle_deg(Stone(1, mask))
    assert angle in level
    assert abs(angle) == min(abs(a) for a in level)


@repeatable(40)
@given(blobs(max_px=30), st.floats(-180, 180), st.sampled_from([1.0, 0.5, 0.3, 0.2]))
def test_a_pose_keeps_its_area_within_one_percent_or_two_px(mask, angle, scale):
    posed = PoseBook(scale).pose(Stone(5, mask), angle)
    area = int(mask.sum()) * scale**2
    assert abs(posed.area_px - area) <= max(0.01 * area, 2.0)


@repeatable(40)
@given(
    stone=stones(2**32 - 1, max_px=6),
    angle=st.integers(-180, 179).map(float),
    scale=st.sampled_from([1.0, 0.6]),
)
def test_a_pose_is_the_first_of_sixteen_positions_with_the_right_area(stone, angle, scale):
    mask, posed = stone.mask, PoseBook(scale).pose(stone, angle)
    (cos, sin), (x0, y0) = rotation(angle), stone.local_centroid
    corners = [
        (col + i - x0, mask.shape[0] - row - 1 + j - y0)
        for row, col in np.argwhere(mask).tolist()
        for i in (0, 1)
        for j in (0, 1)
    ]
    left = min(x * cos - y * sin for x, y in corners)
    bottom = min(x * sin + y * cos for x, y in corners)
    first = quantise(-left * scale) % 1.0, quantise(-bottom * scale) % 1.0
    area = int(mask.sum()) * scale**2
    wanted = area, max(2.0, 0.01 * area)
    pixels, phase = naive.rasterised_to_area(
        mask, stone.local_centroid, angle, scale, first, wanted
    )
    x, y = min(x for x, _ in pixels), min(y for _, y in pixels)
    assert posed.anchor == (phase[0] - x, phase[1] - y)
    assert shape_factor(posed) == pytest.approx(indices.shape_factor(mask, angle))
    rows, cols = np.nonzero(posed.mask[::-1])
    assert {(x + c, y + r) for r, c in zip(rows.tolist(), cols.tolist(), strict=True)} == pixels


def test_a_book_makes_each_pose_once_and_threads_share_it():
    stones = [Stone(k, np.kron(L_MASK, np.ones((k, k), bool))) for k in range(1, 5)]
    asked = [(stone, float(angle)) for angle in range(0, 50, 5) for stone in stones] * 3
    alone = PoseBook(0.7)
    assert alone.pose(stones[0], 190.0) is alone.pose(stones[0], -170.0)
    assert alone.pose(stones[0], 190.0).angle_deg == -170.0
    expected = [alone.pose(*it).mask.tobytes() for it in asked]
    for budget in (1 << 20, 10_000):
        book = PoseBook(0.7, budget_bytes=budget)
        with ThreadPoolExecutor(4) as pool:
            poses = list(pool.map(book.pose, *zip(*asked, strict=True)))
        assert [posed.mask.tobytes() for posed in poses] == expected
        assert book._poses.held_bytes <= budget
    many, start = PoseBook(0.7), threading.Barrier(4)

    def together(_):
        start.wait()
        return many.pose(stones[3], 31.0)

    with ThreadPoolExecutor(4) as pool:
        first, *others = pool.map(together, range(4))
    assert all(posed is first for posed in others)


def test_what_was_not_used_for_longest_is_forgotten_first():
    used = RecentlyUsed[str, int](10)
    assert used.keep("a", 1, 4) == 1
    assert used.keep("b", 2, 4) == 2
    assert used.get("a") == 1
    assert used.keep("c", 3, 4) == 3
    assert [used.get(key) for key in "abc"] == [1, None, 3]
    assert used.held_bytes == 8
    assert used.keep("a", 7, 4) == 1, "the first value stays"
    assert used.held_bytes == 8
    used.keep("d", 4, 8)
    assert [used.get(key) for key in "acd"] == [None, None, 4]
    assert used.held_bytes == 8
    assert used.keep("e", 5, 11) == 5, "too large to be kept at all"
    assert [used.get(key) for key in "de"] == [4, None]


def test_orientation_sets():
    book, stone = PoseBook(), Stone(1, np.kron(L_MASK, np.ones((3, 3), bool)))
    first = book.initial_angle(stone)
    assert (first - initial_angle_deg(stone)) % 90.0 == 0.0
    for orientations, angles in (
        ("sf", [initial_angle_deg(stone)]),
        ("quarter", [wrap_deg(first + turn) for turn in (0, 90, 180, 270)]),
        ("10deg", [-180.0 + 10 * i for i in range(36)]),
        ("50deg", [-180.0 + 50 * i for i in range(8)]),
        ("360deg", [-180.0]),
    ):
        assert [posed.angle_deg for posed in book.orientations(stone, orientations)] == angles
    # Poses with the same pixels are given once.
    for size, count in (((5, 5), 1), ((3, 5), 2)):
        assert len(book.orientations(Stone(2, np.ones(size, bool)), "quarter")) == count


def test_unknown_orientation_sets_are_refused():
    for text in ("", "10", "deg", "0deg", "-5deg", "0.001deg", "361deg", "nandeg", "SF"):
        with pytest.raises(UsageError, match=r"E122 --orientations: .*Use sf, quarter, or a step"):
            orientation_step_deg(text)


@given(angle=st.floats(-2000, 2000))
@repeatable()
def test_wrap(angle):
    wrapped = wrap_deg(angle)
    assert -180.0 <= wrapped < 180.0
    assert math.cos(math.radians(wrapped - angle)) == pytest.approx(1.0)


@pytest.mark.parametrize("quarter", [0, 1, 2, 3])
def test_a_stone_lies_heavy_side_down_however_it_was_photographed(quarter):
    mask = np.ones((6, 20), bool)
    mask[:3, :7] = False  # Its top left is missing
    stone = Stone(1, np.rot90(mask, quarter))
    posed = PoseBook().orientations(stone, "quarter")
    np.testing.assert_array_equal(posed[0].mask, mask)
    assert posed[0].angle_deg == wrap_deg(-90.0 * quarter)
    assert [one.mask.shape for one in posed] == [(6, 20), (20, 6), (6, 20), (20, 6)]
