import numpy as np
import pytest
import shapely

from drystone.errors import UsageError
from drystone.generate.rubble import (
    RubbleSettings,
    course_sizes,
    rubble_outline,
    rubble_stones,
)


@pytest.mark.parametrize("seed", range(6))
def test_the_demo_set_suits_its_wall(seed):
    stones = rubble_stones(RubbleSettings(), np.random.default_rng(seed))
    heights, widths = np.array([stone.mask.shape for stone in stones]).T
    assert len(stones) == 30
    assert stones.total_area_px == pytest.approx(0.88 * 280 * 80, rel=0.005)
    assert 13 <= heights.min() < heights.max() <= 34
    assert 18 <= widths.min() < widths.max() <= 64


def test_courses_fill_the_wall():
    settings = RubbleSettings(count=31, courses=4, spread=0.3)
    sizes = course_sizes(settings, np.random.default_rng(0))
    assert len(sizes) == 31
    heights = np.array([23.0, 21.0, 19.0, 17.0])
    course = np.array([heights[heights >= height].min() for height in sizes[:, 1]])
    for height in heights:
        assert sizes[course == height, 0].sum() == pytest.approx(280)
        assert (sizes[course == height, 1] > 0.92 * height).all()
    counts = [np.count_nonzero(course == height) for height in heights]
    assert counts == sorted(counts)


def test_each_course_has_a_stone():
    sizes = course_sizes(RubbleSettings(count=4, courses=4), np.random.default_rng(0))
    assert sizes[:, 0].tolist() == pytest.approx([280.0] * 4)


def test_outlines_are_rounded_and_close_to_their_box():
    rng = np.random.default_rng(1)
    outlines = [rubble_outline(40.0, 20.0, RubbleSettings(), rng) for _ in range(200)]
    assert {len(outline) for outline in outlines} == {16, 20}
    for outline in outlines:
        polygon = shapely.Polygon(outline)
        assert polygon.is_valid
        assert 0.75 * 800 < polygon.area < 1.1 * 800
        assert polygon.area > 0.97 * polygon.convex_hull.area
    five = np.mean([len(outline) == 20 for outline in outlines])
    assert five == pytest.approx(0.3, abs=0.1)


def test_order_does_not_tell_the_course():
    stones = rubble_stones(RubbleSettings(tilt_deg=0.0, spread=1.0), np.random.default_rng(2))
    heights = np.array([stone.mask.shape[0] for stone in stones])
    assert abs(np.corrcoef(heights, np.arange(len(heights)))[0, 1]) < 0.5


def test_lengths_scale_with_the_wall():
    small, large = (
        rubble_stones(RubbleSettings(width_px=280 * k, height_px=80 * k), np.random.default_rng(3))
        for k in (1, 4)
    )
    ratio = [b.area_px / a.area_px for a, b in zip(small, large, strict=True)]
    assert ratio == pytest.approx([16] * 30, rel=0.06)


def test_stones_may_lie_any_way_round():
    assert len(rubble_stones(RubbleSettings(tilt_deg=360.0), np.random.default_rng(1))) == 30


def test_too_many_stones_for_the_pixels():
    settings = RubbleSettings(count=12, width_px=24, height_px=8, courses=2, area_ratio=0.02)
    with pytest.raises(UsageError, match="E130 generate rubble: the stones must be large enough"):
        rubble_stones(settings, np.random.default_rng(0))


@pytest.mark.parametrize(
    "wrong",
    [
        {"count": 3},
        {"courses": 0},
        {"height_px": 15.0},
        {"width_px": 20.0},
        {"area_ratio": 0.0},
        {"area_ratio": 0.96},
        {"spread": 1.5},
        {"roughness": 0.4},
        {"pentagons": 1.1},
        {"rounding": 0.4},
        {"tilt_deg": -1.0},
        {"tilt_deg": 361.0},
        {"tilt_deg": 1e308},
    ],
)
def test_impossible_settings(wrong):
    with pytest.raises(UsageError, match="E130 generate rubble"):
        RubbleSettings(**wrong)
