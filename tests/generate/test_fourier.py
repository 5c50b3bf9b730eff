import math

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.generate.fourier import (
    FourierSettings,
    fourier_contour,
    fourier_descriptors,
    fourier_stones,
)


def recovered(contour):
    """Mean radius and descriptors of a contour, by a Fourier transform of its radius."""
    radius = np.hypot(*contour.T)
    spectrum = np.fft.rfft(radius) / len(radius)
    return spectrum[0].real, 2 * np.abs(spectrum) / spectrum[0].real


@pytest.mark.parametrize("elongation", [0.0, 0.2])
def test_descriptors_come_back_from_the_contour(elongation):
    settings = FourierSettings(D2=elongation)
    for seed in range(5):
        contour = fourier_contour(30.0, settings, np.random.default_rng(seed))
        assert contour.shape == (128, 2)
        radius, descriptor = recovered(contour)
        assert radius == pytest.approx(30.0)
        expected = [0.0, elongation, 0.05, 0.015]
        assert descriptor[[1, 2, 3, 8]] == pytest.approx(expected, abs=1e-12)
        assert descriptor[1:64] == pytest.approx(fourier_descriptors(settings)[1:], abs=1e-12)


def test_decay_follows_the_exponents():
    descriptor = fourier_descriptors(FourierSettings(alpha=-1.0, beta=-3.0))
    assert descriptor[6] == pytest.approx(0.05 / 2)
    assert descriptor[7] == pytest.approx(0.05 * 3 / 7)
    assert descriptor[16] == pytest.approx(0.015 / 8)
    assert descriptor[9] == pytest.approx(0.015 * (8 / 9) ** 3)


def test_points_are_at_equal_angles_in_order():
    contour = fourier_contour(30.0, FourierSettings(), np.random.default_rng(0))
    angle = np.unwrap(np.arctan2(contour[:, 1], contour[:, 0]))
    assert angle == pytest.approx(np.arange(128) * 2 * math.pi / 128)


def test_phases_spread_over_the_whole_circle():
    rng = np.random.default_rng(3)
    contours = [fourier_contour(30.0, FourierSettings(), rng) for _ in range(300)]
    third = [np.angle(np.fft.rfft(np.hypot(*contour.T))[3]) for contour in contours]
    assert np.histogram(third, bins=4, range=(-math.pi, math.pi))[0].min() > 45


def test_elongation_survives_the_pixels():
    stones = fourier_stones(FourierSettings(count=10, D2=0.2), np.random.default_rng(4))
    for stone in stones:
        # Second moments of r = r0 (1 + D2 cos 2 theta): their ratio is about 1 + 4 D2.
        ratio = 1 / math.sqrt(1 - stone.eccentricity**2)
        assert 1.3 < ratio < 1.7


@pytest.mark.parametrize("elongation", [0.0, 0.2])
def test_area_is_that_of_the_series(elongation):
    settings = FourierSettings(count=20, D2=elongation)
    stones = fourier_stones(settings, np.random.default_rng(7))
    expected = math.pi * 30**2 * (1 + (fourier_descriptors(settings) ** 2).sum() / 2)
    for stone in stones:
        assert stone.area_px == pytest.approx(expected, rel=0.01)


def test_radii_are_uniform():
    settings = FourierSettings(count=400, smallest_radius_px=10.0, largest_radius_px=50.0)
    stones = fourier_stones(settings, np.random.default_rng(2))
    radii = np.sqrt([stone.area_px / math.pi for stone in stones])
    assert len(radii) == 400
    assert 9.5 < radii.min() < 11
    assert 49 < radii.max() < 51
    assert radii.mean() == pytest.approx(30, abs=1.5)
    assert radii.std() == pytest.approx(40 / math.sqrt(12), abs=0.8)


def test_no_contour_has_a_descriptor_above_two():
    # The radius r0 (1 + cos 2 theta) touches the pole, and all that has a larger part crosses it.
    for wrong in ({"D2": 2.01}, {"D3": 2.01}, {"alpha": 4.4}, {"beta": 2.4}):
        with pytest.raises(UsageError, match="E130 generate fourier: D2, and what D3"):
            FourierSettings(**wrong)
    for allowed in ({"D2": 2.0}, {"D3": 2.0}, {"alpha": 4.3}, {"beta": 2.3}):
        settings = FourierSettings(**allowed)
        assert 1.6 < fourier_descriptors(settings).max() <= 2.0
        draws = (fourier_contour(30.0, settings, np.random.default_rng(seed)) for seed in range(50))
        assert all(contour is None for contour in draws)


def test_descriptors_may_decay_at_once():
    steep = FourierSettings(alpha=-1e308, beta=-1e308)
    descriptor = fourier_descriptors(steep)
    assert np.flatnonzero(descriptor).tolist() == [3, 8]
    assert fourier_contour(30.0, steep, np.random.default_rng(0)) is not None


def test_a_contour_that_would_cross_itself_is_rejected():
    assert fourier_contour(30.0, FourierSettings(D2=1.5), np.random.default_rng(0)) is None
    with pytest.raises(UsageError, match="E130"):
        fourier_stones(FourierSettings(count=1, D2=1.5), np.random.default_rng(0))


@pytest.mark.parametrize(
    "wrong",
    [
        {"count": 0},
        {"smallest_radius_px": 31.0},
        {"smallest_radius_px": 0.0},
        {"D2": -0.1},
        {"D3": 0.0},
        {"D8": 0.0},
        {"points": 4},
        {"harmonics": 64},
        {"harmonics": 2},
        {"D2": 1e308},
        {"D3": 1e308},
        {"D8": 1e308},
        {"D8": 2.1},
        {"alpha": 1e308},
        {"alpha": math.inf},
        {"alpha": math.nan},
        {"beta": 10**18},
        {"beta": 1000.0},
        {"points": 2**63 - 1},
        {"points": 10**6},
    ],
)
def test_impossible_settings(wrong):
    with pytest.raises(UsageError, match="E130 generate fourier"):
        FourierSettings(**wrong)
