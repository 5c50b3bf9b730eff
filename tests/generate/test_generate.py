"""Stone sets that are made: each kind by what is known of it, and all as pictures."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from drystone.errors import UsageError
from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.fourier import (
    FourierSettings,
    fourier_contour,
    fourier_descriptors,
    fourier_stones,
)
from drystone.generate.layout import (
    GAP_PX,
    accepted,
    check_room,
    is_whole,
    lay_out,
    polygon_area,
    whole_mask,
)
from drystone.generate.polygon import PolygonSettings, noisy_polygon, polygon_stones
from drystone.generate.rubble import RubbleSettings, course_sizes, rubble_outline, rubble_stones
from drystone.model.stone import Stone, StoneSet
from tests.polygons import box
from tests.strategies import repeatable

IMPOSSIBLE = {
    BrickSettings: {
        "count": [0], "height_px": [0], "aspect": [0.05, 1.49 / 12, -1e308, math.nan],
    },
    FourierSettings: {
        "count": [0], "smallest_radius_px": [31.0, 0.0], "D2": [-0.1, 1e308],
        "D3": [0.0, 1e308], "D8": [0.0, 1e308, 2.1], "points": [4, 2**63 - 1, 10**6],
        "harmonics": [64, 2], "alpha": [1e308, math.inf, math.nan], "beta": [10**18, 1000.0],
    },
    PolygonSettings: {"count": [0], "height_px": [3.0], "noise": [-0.1, 3]},
    RubbleSettings: {
        "count": [3], "courses": [0], "height_px": [15.0], "width_px": [20.0],
        "area_ratio": [0.0, 0.96], "spread": [1.5], "roughness": [0.4], "pentagons": [1.1],
        "rounding": [0.4], "tilt_deg": [-1.0, 361.0, 1e308],
    },
}  # fmt: skip


@pytest.mark.parametrize("kind", IMPOSSIBLE)
def test_impossible_settings_are_refused(kind):
    for name, values in IMPOSSIBLE[kind].items():
        for value in values:
            with pytest.raises(UsageError, match="E130 generate"):
                kind(**{name: value})
    with pytest.raises(UsageError, match="E130 generate"):
        BrickSettings(count=-1, halves=2)


@pytest.mark.parametrize(
    ("generate", "settings"),
    [
        (fourier_stones, FourierSettings(count=12, D2=0.2, largest_radius_px=50.0)),
        (polygon_stones, PolygonSettings(count=12, noise=0.7)),
        (polygon_stones, PolygonSettings(count=12, noise=0.3, convex=False)),
        (brick_stones, BrickSettings(count=12, halves=3)),
        (rubble_stones, RubbleSettings()),
    ],
)
def test_whole_stones_are_numbered_from_one_and_read_back_from_the_picture(generate, settings):
    stones, same, other = (generate(settings, np.random.default_rng(seed)) for seed in (5, 5, 6))
    labels = lay_out(stones)
    assert np.array_equal(labels, lay_out(same))
    assert not np.array_equal(labels, lay_out(other))
    assert labels.dtype == np.uint32
    assert labels.shape == (stones.source.height_px, stones.source.width_px)
    assert [stone.id for stone in stones] == list(range(1, len(stones) + 1))
    boxes = ndimage.find_objects(labels.astype(int))
    for stone, (rows, cols) in zip(stones, boxes, strict=True):
        assert is_whole(stone.mask)
        assert np.array_equal(labels[rows, cols] == stone.id, stone.mask)
        assert (cols.start, labels.shape[0] - rows.stop) == (stone.left_px, stone.bottom_px)
    assert np.count_nonzero(labels) == stones.total_area_px


@repeatable()
@given(
    st.lists(st.tuples(st.integers(1, 40), st.integers(1, 40)), min_size=1, max_size=25),
    st.sampled_from([1, 300, 4_000_000_000]),
)
def test_stones_keep_their_ids_and_never_touch_each_other_or_the_edge(sizes, first):
    stones = tuple(Stone(i, np.ones(size, bool)) for i, size in enumerate(sizes, first))
    labels = lay_out(StoneSet(stones))
    assert np.unique(labels).tolist() == [0, *(stone.id for stone in stones)]
    for stone in stones:
        near = ndimage.binary_dilation(labels == stone.id, np.ones((3, 3)), iterations=GAP_PX)
        assert not (near & (labels != stone.id) & (labels > 0)).any()
    labels[GAP_PX:-GAP_PX, GAP_PX:-GAP_PX] = 0
    assert not labels.any()


def test_stones_that_fit_into_no_image_are_refused_but_large_images_allowed():
    for settings, wrong, named in (
        (FourierSettings, {"largest_radius_px": 1e8}, "largest_radius_px or count"),
        (FourierSettings, {"count": 10**9}, "largest_radius_px or count"),
        (PolygonSettings, {"height_px": 1e8}, "width_px, height_px or count"),
        (BrickSettings, {"height_px": 10**12}, "height_px, aspect or count"),
        # No product of these is a finite number.
        (BrickSettings, {"aspect": 1e308}, "height_px, aspect or count"),
        (RubbleSettings, {"height_px": 1e308, "tilt_deg": 0.0}, "width_px or height_px"),
        (BrickSettings, {"halves": 10**9}, "height_px, aspect, count or halves"),
        # 280 million px of stone, in boxes of billions.
        (RubbleSettings, {"height_px": 1e6}, "width_px, height_px or tilt_deg"),
    ):
        with pytest.raises(UsageError, match=f"E130 .*500 million px. Make {named} smaller"):
            settings(**wrong)
    RubbleSettings(count=10_000, width_px=28_000, height_px=8_000, courses=100)
    RubbleSettings(height_px=1e6, tilt_deg=0.0)
    RubbleSettings(tilt_deg=360.0)
    check_room(5, (9_996, 9_996), ("a", "b"), "test")


def test_bricks_and_polygons_without_noise_are_exact_and_halves_lie_among_the_others():
    for generate, settings, shape in (
        (brick_stones, BrickSettings(count=7, aspect=2), (12, 24)),
        (brick_stones, BrickSettings(count=7, aspect=2.5), (12, 30)),
        (brick_stones, BrickSettings(count=7, aspect=1.5 / 12), (12, 2)),
        (polygon_stones, PolygonSettings(count=7, noise=0.0, width_px=40, height_px=20), (20, 40)),
    ):
        stones = generate(settings, np.random.default_rng(0))
        assert [stone.mask.shape for stone in stones] == [shape] * 7
        assert all(stone.mask.all() for stone in stones)
    stones = brick_stones(BrickSettings(count=20, halves=8), np.random.default_rng(0))
    widths = [stone.mask.shape[1] for stone in stones]
    assert sorted(widths) == [18] * 8 + [36] * 20
    assert widths not in (sorted(widths), sorted(widths)[::-1])


@pytest.mark.parametrize("elongation", [0.0, 0.2])
def test_descriptors_come_back_from_the_contour_and_say_its_area(elongation):
    settings = FourierSettings(count=20, D2=elongation)
    known = fourier_descriptors(settings)
    for seed in range(5):
        contour = fourier_contour(30.0, settings, np.random.default_rng(seed))
        assert contour.shape == (128, 2)
        spectrum = np.fft.rfft(np.hypot(*contour.T)) / len(contour)
        radius, descriptor = spectrum[0].real, 2 * np.abs(spectrum) / spectrum[0].real
        assert radius == pytest.approx(30.0)
        expected = [0.0, elongation, 0.05, 0.015]
        assert descriptor[[1, 2, 3, 8]] == pytest.approx(expected, abs=1e-12)
        assert descriptor[1:64] == pytest.approx(known[1:], abs=1e-12)
    expected = math.pi * 30**2 * (1 + (known**2).sum() / 2)
    for stone in fourier_stones(settings, np.random.default_rng(7)):
        assert stone.area_px == pytest.approx(expected, rel=0.01)


def test_decay_follows_the_exponents():
    descriptor = fourier_descriptors(FourierSettings(alpha=-1.0, beta=-3.0))
    expected = [0.05 / 2, 0.05 * 3 / 7, 0.015 * (8 / 9) ** 3, 0.015 / 8]
    assert descriptor[[6, 7, 9, 16]] == pytest.approx(expected)
    at_once = fourier_descriptors(FourierSettings(alpha=-1e308, beta=-1e308))
    assert np.flatnonzero(at_once).tolist() == [3, 8]


def test_phases_and_radii_are_uniform():
    rng = np.random.default_rng(3)
    contours = [fourier_contour(30.0, FourierSettings(), rng) for _ in range(300)]
    third = [np.angle(np.fft.rfft(np.hypot(*contour.T))[3]) for contour in contours]
    assert np.histogram(third, bins=4, range=(-math.pi, math.pi))[0].min() > 45
    settings = FourierSettings(count=400, smallest_radius_px=10.0, largest_radius_px=50.0)
    stones = fourier_stones(settings, np.random.default_rng(2))
    radii = np.sqrt([stone.area_px / math.pi for stone in stones])
    assert (len(radii), 9.5 < radii.min() < 11, 49 < radii.max() < 51) == (400, True, True)
    assert radii.mean() == pytest.approx(30, abs=1.5)
    assert radii.std() == pytest.approx(40 / math.sqrt(12), abs=0.8)


def test_no_contour_has_a_descriptor_above_two_and_none_crosses_itself():
    # The radius r0 (1 + cos 2 theta) touches the pole, and all that has a larger part crosses it.
    for wrong in ({"D2": 2.01}, {"D3": 2.01}, {"alpha": 4.4}, {"beta": 2.4}):
        with pytest.raises(UsageError, match="E130 generate fourier: D2, and what D3"):
            FourierSettings(**wrong)
    for allowed in ({"D2": 2.0}, {"D3": 2.0}, {"alpha": 4.3}, {"beta": 2.3}, {"D2": 1.5}):
        settings = FourierSettings(**allowed)
        assert allowed == {"D2": 1.5} or 1.6 < fourier_descriptors(settings).max() <= 2.0
        draws = (fourier_contour(30.0, settings, np.random.default_rng(seed)) for seed in range(50))
        assert all(contour is None for contour in draws)
    with pytest.raises(UsageError, match="E130 generate fourier: no stone in 1000 draws"):
        fourier_stones(FourierSettings(count=1, D2=1.5), np.random.default_rng(0))


@pytest.mark.parametrize("convex", [True, False])
@pytest.mark.parametrize("noise", [0.1, 0.8])
def test_polygons_are_simple_and_a_set_has_the_area_of_its_bricks(noise, convex):
    rng = np.random.default_rng(1)
    settings = PolygonSettings(noise=noise, convex=convex)
    outlines = [noisy_polygon(settings, rng) for _ in range(200)]
    simple = [shapely.Polygon(outline) for outline in outlines if outline is not None]
    assert len(simple) > 20
    for polygon in simple:
        assert polygon.is_valid
        assert polygon.area >= 0.1 * 130 * 90
        assert not convex or polygon.convex_hull.area == pytest.approx(polygon.area)
    settings = PolygonSettings(noise=min(noise, 0.7), convex=convex)
    stones = polygon_stones(settings, np.random.default_rng(3))
    assert len(stones) == 28
    assert stones.total_area_px == pytest.approx(28 * 130 * 90, rel=0.005)


def test_corners_deviate_by_the_given_share_of_the_shorter_side():
    rng = np.random.default_rng(2)
    settings = PolygonSettings(noise=0.05, convex=False)
    corners = np.array([noisy_polygon(settings, rng) for _ in range(500)])
    assert corners.std(axis=0) == pytest.approx(np.full((6, 2), 0.05 * 90), rel=0.15)
    assert corners.mean(axis=0)[2] == pytest.approx([130, 0], abs=1)


def test_polygons_that_are_not_whole_are_drawn_again_but_not_for_ever(monkeypatch):
    settings = PolygonSettings(count=40, width_px=5, height_px=4, noise=0.5, convex=False)
    assert len(polygon_stones(settings, np.random.default_rng(5))) == 40
    masks = map(whole_mask, [None, box(0, 0, 0.2, 0.2), box(0, 0, 2, 2)])
    assert accepted(masks, "test").shape == (2, 2)
    monkeypatch.setattr("drystone.generate.layout.ATTEMPTS", 0)
    with pytest.raises(UsageError, match="E130 generate polygon: no stone"):
        polygon_stones(PolygonSettings(count=1), np.random.default_rng(0))


@pytest.mark.parametrize("seed", range(3))
def test_the_demo_set_suits_its_wall_and_its_order_does_not_tell_the_course(seed):
    stones = rubble_stones(RubbleSettings(), np.random.default_rng(seed))
    heights, widths = np.array([stone.mask.shape for stone in stones]).T
    assert len(stones) == 30
    assert stones.total_area_px == pytest.approx(0.88 * 280 * 80, rel=0.005)
    assert 13 <= heights.min() < heights.max() <= 34
    assert 18 <= widths.min() < widths.max() <= 64
    flat = rubble_stones(RubbleSettings(tilt_deg=0.0, spread=1.0), np.random.default_rng(seed))
    heights = [stone.mask.shape[0] for stone in flat]
    assert abs(np.corrcoef(heights, np.arange(len(heights)))[0, 1]) < 0.5


def test_courses_fill_the_wall_and_too_many_stones_are_refused():
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
    least = course_sizes(RubbleSettings(count=4, courses=4), np.random.default_rng(0))
    assert least[:, 0].tolist() == pytest.approx([280.0] * 4)  # each course has a stone
    settings = RubbleSettings(count=12, width_px=24, height_px=8, courses=2, area_ratio=0.02)
    with pytest.raises(UsageError, match="E130 generate rubble: the stones must be large enough"):
        rubble_stones(settings, np.random.default_rng(0))


def test_outlines_are_rounded_and_close_to_their_box():
    rng = np.random.default_rng(1)
    outlines = [rubble_outline(40.0, 20.0, RubbleSettings(), rng) for _ in range(200)]
    assert {len(outline) for outline in outlines} == {16, 20}
    for outline in outlines:
        polygon = shapely.Polygon(outline)
        assert polygon.is_valid
        assert 0.75 * 800 < polygon.area < 1.1 * 800
        either_way = [polygon_area(ring) for ring in (outline, outline[::-1])]
        assert either_way == pytest.approx([polygon.area] * 2)
        assert polygon.area > 0.97 * polygon.convex_hull.area
    five = np.mean([len(outline) == 20 for outline in outlines])
    assert five == pytest.approx(0.3, abs=0.1)


@pytest.mark.parametrize(
    ("picture", "whole"),
    [("111/101/111", False), ("101/101", False), ("10/01", True), ("110/011", True), ("0", False)],
)
def test_whole_is_one_piece_without_holes(picture, whole):
    mask = np.array([[pixel == "1" for pixel in row] for row in picture.split("/")])
    assert is_whole(mask) is whole
