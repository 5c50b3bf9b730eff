"""Turning, reducing and rasterising by coverage (DESIGN 4.2)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.raster import (
    PHASE_STEPS,
    Mask,
    areas_by_phase,
    quantise,
    rasterise,
    rotation,
    turn,
)
from tests.naive import raster as naive
from tests.strategies import blobs, masks, repeatable

L_SHAPE = np.array([[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 1]], bool)
PHASES = st.integers(0, PHASE_STEPS - 1).map(lambda n: n / PHASE_STEPS)


def padded_to(mask: Mask, left: int, bottom: int, window: tuple[int, int, int, int]) -> Mask:
    """A raster at its place in a window (left, bottom, right, top)."""
    whole = np.zeros((window[3] - window[1], window[2] - window[0]), bool)
    row = window[3] - bottom - mask.shape[0]
    whole[row : row + mask.shape[0], left - window[0] :][:, : mask.shape[1]] = mask
    return whole


@pytest.mark.parametrize("quarters", [-2, -1, 0, 1, 2, 3, 5])
def test_quarter_turns_of_an_l_are_counter_clockwise_and_never_mirrored(quarters: int) -> None:
    turned, left, bottom = rasterise(L_SHAPE, (0.0, 0.0), 90.0 * quarters, 1.0, (0.0, 0.0))
    assert np.array_equal(turned, np.rot90(L_SHAPE, quarters))
    corners = {0: (0, 0), 1: (-4, 0), 2: (-3, -4), 3: (0, -3)}
    assert (left, bottom) == corners[quarters % 4]


@repeatable()
@given(mask=masks(), quarters=st.integers(0, 3), phase=st.tuples(PHASES, PHASES))
def test_quarter_turns_are_exact_at_any_phase_up_to_half_a_pixel(
    mask: Mask, quarters: int, phase: tuple[float, float]
) -> None:
    whole_px = (0.0, 0.0)
    exact = rasterise(mask, whole_px, 90.0 * quarters, 1.0, whole_px)
    assert np.array_equal(exact[0], np.rot90(mask, quarters))
    shifted = rasterise(mask, whole_px, 90.0 * quarters, 1.0, (phase[0] * 0.24, phase[1] * 0.24))
    assert np.array_equal(shifted[0], exact[0])
    assert shifted[1:] == exact[1:]


def test_a_positive_angle_lifts_the_right_end_of_a_bar() -> None:
    bar = np.ones((5, 41), bool)
    turned, _, _ = rasterise(bar, (20.5, 2.5), 30.0, 1.0, (0.0, 0.0))
    top, bottom = np.flatnonzero(turned[0]).mean(), np.flatnonzero(turned[-1]).mean()
    assert top > turned.shape[1] / 2 > bottom


@pytest.mark.parametrize("quarters", [-3, -1, 0, 1, 2, 4, 7])
def test_rotation_is_exact_at_quarter_turns(quarters: int) -> None:
    cos, sin = rotation(90.0 * quarters)
    assert {abs(cos), abs(sin)} == {0.0, 1.0}
    assert cos == pytest.approx(math.cos(math.pi / 2 * quarters), abs=1e-12)
    assert sin == pytest.approx(math.sin(math.pi / 2 * quarters), abs=1e-12)


@given(angle=st.floats(-720, 720))
@repeatable()
def test_turn_is_a_rotation_by_the_angle(angle: float) -> None:
    x, y = turn(np.array([[2.0, 0.0]]), angle)[0]
    assert math.hypot(x, y) == pytest.approx(2.0)
    difference = math.degrees(math.atan2(y, x)) - angle
    assert (difference + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-9)


@given(value=st.floats(-1e6, 1e6))
@repeatable()
def test_quantise_is_exact_and_nearest(value: float) -> None:
    rounded = quantise(value)
    assert (rounded * PHASE_STEPS).is_integer()
    assert abs(rounded - value) <= 0.5 / PHASE_STEPS + 1e-9


@repeatable(80)
@given(
    mask=blobs(min_px=6, max_px=30),
    angle=st.floats(-180, 180),
    scale=st.sampled_from([1.0, 0.7, 0.5, 0.3, 0.2]),
    phase=st.tuples(PHASES, PHASES),
)
def test_rasterise_takes_pixels_covered_by_half(
    mask: Mask, angle: float, scale: float, phase: tuple[float, float]
) -> None:
    centre = (mask.shape[1] * 0.4, mask.shape[0] * 0.6)
    turned, left, bottom = rasterise(mask, centre, angle, scale, phase)
    reach = math.ceil(math.hypot(*mask.shape) * scale) + 1
    window = (-reach, -reach, reach, reach)
    exact = naive.coverage(mask, centre, angle, scale, phase, window)
    got = padded_to(turned, left, bottom, window)
    k = max(4, math.ceil(1 / scale))
    decided = abs(exact - 0.5) > 1 / k
    if (exact >= 0.5 + 1 / k).any():  # otherwise so thin that only the best pixel is kept
        assert np.array_equal(got[decided], exact[decided] >= 0.5)


@repeatable()
@given(mask=masks(), angle=st.floats(-180, 180), scale=st.sampled_from([0.05, 0.2, 0.6, 1.0]))
def test_a_stone_never_vanishes_and_is_cropped(mask: Mask, angle: float, scale: float) -> None:
    turned, _, _ = rasterise(mask, (0.3, 0.4), angle, scale, (0.25, 0.75))
    assert turned[0].any()
    assert turned[-1].any()
    assert turned[:, 0].any()
    assert turned[:, -1].any()


def test_a_whole_pixel_of_phase_moves_and_changes_nothing() -> None:
    here = rasterise(L_SHAPE, (1.2, 0.7), 33.0, 1.0, (0.25, 0.5))
    there = rasterise(L_SHAPE, (1.2, 0.7), 33.0, 1.0, (2.25, 3.5))
    assert np.array_equal(here[0], there[0])
    assert (there[1] - here[1], there[2] - here[2]) == (2, 3)


@pytest.mark.parametrize("scale", [1.0, 0.5, 0.3])
def test_areas_at_all_phases_are_those_of_rasterising_at_each(scale: float) -> None:
    mask = np.zeros((23, 31), bool)
    mask[2:20, 3:29] = True
    mask[2:9, 3:12] = False
    areas = list(areas_by_phase(mask, (14.3, 9.8), 17.0, scale, (0.125, 0.5)))
    assert len(areas) == 16
    for number, area in enumerate(areas):
        phase = (0.125 + number % 4 / 4, 0.5 + number // 4 / 4)
        assert area == rasterise(mask, (14.3, 9.8), 17.0, scale, phase)[0].sum()
