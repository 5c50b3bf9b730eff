import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from drystone.errors import UsageError
from drystone.generate.brick import BrickSettings, brick_stones
from drystone.generate.fourier import FourierSettings, fourier_stones
from drystone.generate.layout import GAP_PX, check_room, lay_out, stones_of
from drystone.generate.polygon import PolygonSettings, polygon_stones
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.model.stone import Stone, StoneSet
from tests.strategies import repeatable

GENERATORS = {
    "fourier": (
        fourier_stones,
        FourierSettings(count=12, D2=0.2, smallest_radius_px=10.0, largest_radius_px=50.0),
    ),
    "polygon": (polygon_stones, PolygonSettings(count=12, noise=0.7)),
    "notched": (polygon_stones, PolygonSettings(count=12, noise=0.3, convex=False)),
    "brick": (brick_stones, BrickSettings(count=12, halves=3)),
    "rubble": (rubble_stones, RubbleSettings()),
}


@pytest.fixture(params=GENERATORS)
def generated(request):
    generate, settings = GENERATORS[request.param]
    return lambda seed=5: generate(settings, np.random.default_rng(seed))


def test_a_seed_gives_the_same_stones(generated):
    assert np.array_equal(lay_out(generated()), lay_out(generated()))


def test_another_seed_gives_other_stones(generated):
    assert not np.array_equal(lay_out(generated()), lay_out(generated(seed=6)))


def test_stones_are_numbered_from_one_and_whole(generated):
    stones = generated()
    assert [stone.id for stone in stones] == list(range(1, len(stones) + 1))
    for stone in stones:
        assert ndimage.label(stone.mask, np.ones((3, 3)))[1] == 1
        assert np.array_equal(ndimage.binary_fill_holes(stone.mask), stone.mask)
        assert stone.mask[[0, -1]].any(axis=1).all()
        assert stone.mask[:, [0, -1]].any(axis=0).all()


def test_the_picture_reads_back_as_the_same_stones(generated):
    stones = generated()
    labels = lay_out(stones)
    assert labels.dtype == np.uint32
    assert labels.shape == (stones.source.height_px, stones.source.width_px)
    boxes = ndimage.find_objects(labels.astype(int))
    for stone, (rows, cols) in zip(stones, boxes, strict=True):
        assert np.array_equal(labels[rows, cols] == stone.id, stone.mask)
        assert (cols.start, labels.shape[0] - rows.stop) == (stone.left_px, stone.bottom_px)
    assert np.count_nonzero(labels) == stones.total_area_px


SIZES = st.tuples(st.integers(1, 40), st.integers(1, 40))


@repeatable()
@given(st.lists(SIZES, min_size=1, max_size=25))
def test_stones_never_touch_each_other_or_the_edge(sizes):
    labels = lay_out(stones_of([np.ones(size, bool) for size in sizes]))
    grown = np.zeros_like(labels)
    for stone in range(1, len(sizes) + 1):
        near = ndimage.binary_dilation(labels == stone, np.ones((3, 3)), iterations=GAP_PX)
        assert not (near & (labels != stone) & (labels > 0)).any()
        grown[labels == stone] = stone
    assert np.array_equal(grown, labels)
    assert not np.delete(labels, np.s_[GAP_PX:-GAP_PX], axis=0).any()
    assert not np.delete(labels, np.s_[GAP_PX:-GAP_PX], axis=1).any()


@pytest.mark.parametrize(
    ("settings", "wrong", "named"),
    [
        (FourierSettings, {"largest_radius_px": 1e8}, "largest_radius_px or count"),
        (FourierSettings, {"count": 10**9}, "largest_radius_px or count"),
        (PolygonSettings, {"height_px": 1e8}, "width_px, height_px or count"),
        (BrickSettings, {"height_px": 10**12}, "height_px, aspect or count"),
        # No product of these is a finite number.
        (BrickSettings, {"aspect": 1e308}, "height_px, aspect or count"),
        (PolygonSettings, {"width_px": 1e308}, "width_px, height_px or count"),
        (FourierSettings, {"largest_radius_px": 1e308}, "largest_radius_px or count"),
        (RubbleSettings, {"width_px": 1e308}, "width_px, height_px or tilt_deg"),
        (RubbleSettings, {"height_px": 1e308, "tilt_deg": 0.0}, "width_px or height_px"),
        (BrickSettings, {"halves": 10**9}, "height_px, aspect, count or halves"),
        (RubbleSettings, {"height_px": 1e8}, "width_px, height_px or tilt_deg"),
        # 280 million px of stone, in boxes of billions.
        (RubbleSettings, {"height_px": 1e6}, "width_px, height_px or tilt_deg"),
        (RubbleSettings, {"height_px": 1e8, "tilt_deg": 0.0}, "width_px or height_px"),
    ],
)
def test_stones_that_fit_into_no_image_are_refused(settings, wrong, named):
    with pytest.raises(UsageError, match=f"E130 .*500 million px. Make {named} smaller"):
        settings(**wrong)


def test_large_images_of_stones_are_allowed():
    RubbleSettings(count=10_000, width_px=28_000, height_px=8_000, courses=100)
    RubbleSettings(height_px=1e6, tilt_deg=0.0)
    check_room(5, (9_996, 9_996), ("a", "b"), "test")


def test_ids_of_any_stones_are_kept():
    mask = np.ones((3, 5), bool)
    labels = lay_out(StoneSet((Stone(300, mask), Stone(4_000_000_000, mask))))
    assert np.unique(labels).tolist() == [0, 300, 4_000_000_000]
