"""Turning, reducing and rasterising by coverage (DESIGN 4.2)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import raster
from drystone.kernels.backend import compiled
from drystone.kernels.polygons import turn
from drystone.kernels.raster import (
    PHASE_STEPS,
    quantise,
    rasterise,
    rasterise_to_area,
    rotation,
    turned_boxes,
)
from tests.kernels.twins import both_ways
from tests.naive import raster as naive
from tests.strategies import blobs, landscapes, masks, repeatable

kernel = both_ways(raster)
FAST = compiled("raster")

PHASES = st.integers(0, PHASE_STEPS - 1).map(lambda n: n / PHASE_STEPS)


@given(angle=st.floats(-720, 720))
def test_turn_is_a_rotation_by_the_angle(angle):
    points = np.array([(2.0, 0.0), (0.0, 1.0), (-3.0, 0.5)])
    expected = points @ (1.0, 1j) * np.exp(1j * math.radians(angle))
    assert turn(points, angle) @ (1.0, 1j) == pytest.approx(expected, abs=1e-12)


@given(value=st.floats(-1e6, 1e6))
def test_quantise_is_exact_and_nearest(value):
    rounded = quantise(value)
    assert (rounded * PHASE_STEPS).is_integer()
    assert abs(rounded - value) <= 0.5 / PHASE_STEPS + 1e-9


def pixels_of(mask, left, bottom):
    rows, cols = np.nonzero(mask)
    top = bottom + mask.shape[0] - 1
    return {(left + col, top - row) for row, col in zip(rows.tolist(), cols.tolist(), strict=True)}


ANGLES = st.one_of(
    st.floats(-180, 180),
    st.integers(-4, 4).map(lambda n: 90.0 * n),
    st.integers(-180, 180).map(float),
    # So near a quarter turn that a line of samples hardly leaves its row.
    st.tuples(st.integers(-2, 2), st.integers(3, 17)).map(lambda n: 90.0 * n[0] + 10.0 ** -n[1]),
)


@given(
    mask=masks(5),
    at=st.tuples(st.floats(0, 1), st.sampled_from([0.0, 0.5, 1.0])),
    angle=ANGLES,
    scale=st.sampled_from([2.0, 1.0, 0.5, 0.3, 0.12, 0.05]),
    phase=st.tuples(PHASES, PHASES),
)
def test_rasterising_is_counting_samples_one_by_one(mask, at, angle, scale, phase):
    """A stone that no sample hits does not vanish either."""
    centre = (at[0] * mask.shape[1], at[1] * mask.shape[0])
    turned, left, bottom = rasterise(mask, centre, angle, scale, phase)
    assert all(edge.any() for edge in (turned[0], turned[-1], turned[:, 0], turned[:, -1]))
    expected = naive.rasterised(mask, centre, angle, scale, phase)
    assert not expected or pixels_of(turned, left, bottom) == expected


@given(
    mask=masks(4),
    angle=ANGLES,
    scale=st.sampled_from([1.0, 0.5, 0.2]),
    phase=st.tuples(PHASES, PHASES),
    off=st.sampled_from([0.0, 0.0, 1.0, -2.0, 0.3]),
    tolerance=st.sampled_from([0.0, 0.6, 1.0, 2.0, math.inf]),
)
def test_the_area_is_sought_at_sixteen_positions_one_after_the_other(
    mask, angle, scale, phase, off, tolerance
):
    wanted = (round(int(mask.sum()) * scale**2) + off, tolerance)
    expected, best = naive.rasterised_to_area(mask, (0.5, 0.5), angle, scale, phase, wanted)
    if expected:
        found = rasterise_to_area(mask, (0.5, 0.5), angle, scale, phase, wanted)
        assert pixels_of(*found[:3]) == expected
        assert found[3] == best


@pytest.mark.skipif(FAST is None, reason="kernels are not compiled here")
@repeatable(100)
@given(
    # Rings and loose pixels among them.
    mask=st.one_of(masks(12), blobs(), landscapes(12).filter(np.any)),
    angle=ANGLES,
    scale=st.sampled_from([2.5, 1.0, 0.5, 0.3, 0.05, 0.004]),
    phase=st.tuples(PHASES, PHASES),
    area=st.tuples(st.floats(0.5, 1.5), st.sampled_from([0.0, 2.0, math.inf])),
    order=st.sampled_from("CF"),
)
def test_compiled_pixels_are_those_of_numpy(mask, angle, scale, phase, area, order):
    wanted = (area[0] * mask.sum() * scale**2, area[1])
    source = np.array(mask, order=order)
    found = []
    for fast in (None, FAST):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(raster, "_fast", fast)
            found.append(rasterise_to_area(source, (7.3, 4.5), angle, scale, phase, wanted))
    assert found[0][0].dtype == found[1][0].dtype == bool
    assert found[0][0].tolist() == found[1][0].tolist()
    assert found[0][1:] == found[1][1:]


@pytest.mark.parametrize(
    ("scale", "expected"),
    [
        (0.5, ["######...######", "######...######", "###############", "######...######"]),
        # Covered to a quarter: enough for the neck, and for the bump on the left block.
        (0.25, ["###.####", "########"]),
        # Covered to an eighth: all that is touched is taken.
        (0.125, ["####"]),
    ],
)
def test_a_neck_too_thin_for_the_resolution_does_not_break(scale, expected):
    dumbbell = np.zeros((8, 30), bool)
    dumbbell[:, :12], dumbbell[:, 18:] = True, True
    dumbbell[4, :] = dumbbell[3, 13:15] = True
    turned, _, _ = rasterise(dumbbell, (0.0, 0.0), 0.0, scale, (0.0, 0.0))
    assert ["".join(".#"[pixel] for pixel in row) for row in turned.astype(int)] == expected


def test_a_pixel_between_the_sample_points_does_not_vanish():
    counts, _ = naive.sampled(np.ones((1, 1), bool), (0.5, 0.5), 45.0, 0.25, (0.0, 0.0))
    assert not counts
    turned, left, bottom = rasterise(np.ones((1, 1), bool), (0.5, 0.5), 45.0, 0.25, (0.0, 0.0))
    assert (turned.tolist(), left, bottom) == ([[True, True], [True, True]], -1, -1)


@pytest.mark.parametrize(("phase", "shape"), [((0.625, 0.0), (1, 2)), ((0.0, 0.375), (2, 1))])
def test_samples_on_an_edge_belong_to_the_pixel_right_of_or_below_it(phase, shape):
    """A pixel across two of the result: half of each when one of its two edges counts."""
    turned, left, bottom = rasterise(np.ones((1, 1), bool), (0.0, 0.0), 0.0, 1.0, phase)
    assert (turned.shape, left, bottom) == (shape, 0, 0)


def test_a_mask_without_pixels_is_refused():
    with pytest.raises(ValueError, match="no pixel"):
        rasterise(np.zeros((2, 3), bool), (0.0, 0.0), 10.0, 1.0, (0.0, 0.0))


def test_numpy_takes_a_large_mask_in_bands(monkeypatch):
    monkeypatch.setattr(raster, "_fast", None)
    mask = np.indices((23, 31)).sum(axis=0) % 7 > 1
    whole = rasterise(mask, (9.2, 8.1), 33.0, 0.15, (0.25, 0.5))
    monkeypatch.setattr(raster, "BAND", 1)
    banded = rasterise(mask, (9.2, 8.1), 33.0, 0.15, (0.25, 0.5))
    assert np.array_equal(whole[0], banded[0])
    assert whole[1:] == banded[1:]


@given(
    points=st.lists(st.tuples(st.floats(-99, 99), st.floats(-99, 99)), min_size=1, max_size=9),
    angles=st.lists(ANGLES, min_size=1, max_size=4),
)
def test_boxes_are_those_of_the_points_turned_one_by_one(points, angles):
    turns = [rotation(angle) for angle in angles]
    boxes = turned_boxes(np.array(points), np.array(turns))
    for (cos, sin), box in zip(turns, boxes.tolist(), strict=True):
        x = [u * cos - v * sin for u, v in points]
        y = [u * sin + v * cos for u, v in points]
        assert box == [min(x), min(y), max(x), max(y)]
