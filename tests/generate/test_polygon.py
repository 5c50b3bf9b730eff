import numpy as np
import pytest
import shapely

from drystone.errors import UsageError
from drystone.generate.polygon import PolygonSettings, noisy_polygon, polygon_stones


@pytest.mark.parametrize("convex", [True, False])
@pytest.mark.parametrize("noise", [0.1, 0.4, 0.8])
def test_polygons_are_simple(noise, convex):
    rng = np.random.default_rng(1)
    settings = PolygonSettings(noise=noise, convex=convex)
    outlines = [noisy_polygon(settings, rng) for _ in range(200)]
    accepted = [outline for outline in outlines if outline is not None]
    assert len(accepted) > 20
    for outline in accepted:
        polygon = shapely.Polygon(outline)
        assert polygon.is_valid
        assert polygon.area >= 0.1 * 130 * 90
        if convex:
            assert polygon.convex_hull.area == pytest.approx(polygon.area)


def test_polygons_that_cross_themselves_are_rejected():
    rng = np.random.default_rng(1)
    settings = PolygonSettings(noise=0.8, convex=False)
    assert any(noisy_polygon(settings, rng) is None for _ in range(50))


def test_corners_deviate_by_the_given_share_of_the_shorter_side():
    rng = np.random.default_rng(2)
    settings = PolygonSettings(noise=0.05, convex=False)
    corners = np.array([noisy_polygon(settings, rng) for _ in range(500)])
    assert corners.std(axis=0) == pytest.approx(np.full((6, 2), 0.05 * 90), rel=0.15)
    assert corners.mean(axis=0)[2] == pytest.approx([130, 0], abs=1)


def test_without_noise_they_are_bricks():
    settings = PolygonSettings(count=4, noise=0.0, width_px=40, height_px=20)
    stones = polygon_stones(settings, np.random.default_rng(0))
    assert [stone.mask.shape for stone in stones] == [(20, 40)] * 4
    assert stones.total_area_px == 4 * 800


@pytest.mark.parametrize("noise", [0.2, 0.7])
def test_a_set_has_the_area_of_its_bricks(noise):
    stones = polygon_stones(PolygonSettings(noise=noise), np.random.default_rng(3))
    assert len(stones) == 28
    assert stones.total_area_px == pytest.approx(28 * 130 * 90, rel=0.005)


def test_more_noise_is_more_variety():
    def spread(noise):
        stones = polygon_stones(PolygonSettings(count=60, noise=noise), np.random.default_rng(4))
        return np.std([stone.area_px for stone in stones])

    assert spread(0.1) < spread(0.3) < spread(0.7)


def test_tiny_notched_polygons_are_drawn_again_until_whole():
    settings = PolygonSettings(count=40, width_px=5, height_px=4, noise=0.5, convex=False)
    assert len(polygon_stones(settings, np.random.default_rng(5))) == 40


def test_draws_do_not_go_on_for_ever(monkeypatch):
    monkeypatch.setattr("drystone.generate.polygon.ATTEMPTS", 0)
    with pytest.raises(UsageError, match="E130 generate polygon: no stone"):
        polygon_stones(PolygonSettings(count=1), np.random.default_rng(0))


@pytest.mark.parametrize("wrong", [{"count": 0}, {"height_px": 3.0}, {"noise": -0.1}, {"noise": 3}])
def test_impossible_settings(wrong):
    with pytest.raises(UsageError, match="E130 generate polygon"):
        PolygonSettings(**wrong)
