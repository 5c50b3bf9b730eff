"""Where a mask rests: compiled and packed in Python against loops over pixels (§3.6)."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.backend import compiled
from drystone.kernels.bits import BitLandscape, BitLandscapeNumpy, bit_landscape
from drystone.kernels.lowering import Positions, skyline_numpy
from drystone.kernels.raster import Mask
from drystone.kernels.silhouette import Ints, silhouette
from tests.naive import placement as naive
from tests.strategies import landscapes, masks, repeatable

absent = pytest.mark.skipif(compiled("bits") is None, reason="kernels are not compiled here")
twins = pytest.mark.parametrize(
    "pack",
    [
        pytest.param(BitLandscapeNumpy, id="numpy"),
        pytest.param(bit_landscape, id="compiled", marks=absent),
    ],
)
Pack = Callable[[Mask, Ints], BitLandscape]


def resting(pack: Pack, occupied: Mask, mask: Mask) -> Positions:
    return pack(occupied, skyline_numpy(occupied)).resting(silhouette(mask))


@twins
def test_masks_rest_where_two_loops_say(pack: Pack) -> None:
    @repeatable(200)
    @given(occupied=landscapes(16), mask=masks(8))
    def check(occupied: Mask, mask: Mask) -> None:
        found = resting(pack, occupied, mask)
        assert found.dtype == np.int64
        assert found.flags.c_contiguous
        assert found.tolist() == [list(at) for at in naive.resting_positions(occupied, mask)]

    check()


@twins
@pytest.mark.parametrize("stretch", [13, 40])
def test_rows_of_several_words_and_runs_longer_than_one(pack: Pack, stretch: int) -> None:
    @repeatable(60)
    @given(occupied=landscapes(9), mask=masks(5), shift=st.integers(0, 12), cut=st.integers(0, 12))
    def check(occupied: Mask, mask: Mask, shift: int, cut: int) -> None:
        wide = np.roll(np.repeat(occupied, stretch, axis=1), shift, axis=1)
        stone = np.repeat(mask, stretch, axis=1)[:, : mask.shape[1] * stretch - cut]
        expected = naive.resting_by_areas(wide, stone, slid) if fits(wide, stone) else []
        assert resting(pack, wide, stone).tolist() == [list(at) for at in expected]

    check()


@twins
def test_long_masks_between_thin_posts_under_a_roof(pack: Pack) -> None:
    columns = st.integers(0, 299)
    posts = st.lists(st.tuples(columns, st.integers(1, 9)), max_size=4)

    @repeatable(150)
    @given(
        posts=posts, length=st.integers(1, 300), heel=st.integers(0, 99), foot=st.integers(1, 99)
    )
    def check(posts: list[tuple[int, int]], length: int, heel: int, foot: int) -> None:
        occupied = np.zeros((12, 300), bool)
        occupied[1] = True
        for col, height in posts:
            occupied[-height:, col] = True
        mask = np.ones((3, length), bool)
        mask[1:, :heel] = mask[1:, heel + 3 * foot :] = False
        mask[1:, min(heel, length - 1)] = True
        expected = naive.resting_by_areas(occupied, mask, slid)
        assert resting(pack, occupied, mask).tolist() == [list(at) for at in expected]

    check()


@twins
def test_a_mask_fits_where_it_was_carved_out(pack: Pack) -> None:
    @repeatable(100)
    @given(mask=masks(8), top=st.integers(0, 3), left=st.integers(0, 70))
    def check(mask: Mask, top: int, left: int) -> None:
        occupied = np.ones((mask.shape[0] + top + 1, mask.shape[1] + left + 2), bool)
        occupied[top : top + mask.shape[0], left : left + mask.shape[1]] ^= mask
        assert [top, left] in resting(pack, occupied, mask).tolist()

    check()


def fits(occupied: Mask, mask: Mask) -> bool:
    return mask.shape[0] <= occupied.shape[0] and mask.shape[1] <= occupied.shape[1]


def slid(scene: Mask, mask: Mask) -> np.ndarray:
    """Overlapping pixels at every position, all positions of a pixel of the mask at once."""
    rows, cols = scene.shape[0] - mask.shape[0] + 1, scene.shape[1] - mask.shape[1] + 1
    areas = np.zeros((rows, cols), np.int64)
    for i, j in zip(*np.nonzero(mask), strict=True):
        areas += scene[i : i + rows, j : j + cols]
    return areas


@twins
def test_a_long_run_does_not_see_the_next_row(pack: Pack) -> None:
    occupied = np.zeros((4, 9), bool)
    occupied[1:, 0] = True
    found = resting(pack, occupied, np.ones((1, 8), bool))
    assert found.tolist() == [[0, 0], [3, 1]]


@twins
def test_under_a_roof_and_on_it(pack: Pack) -> None:
    occupied = np.zeros((7, 200), bool)
    occupied[3, 10:190] = True
    # As wide as what is left of the roof, and a pixel wider.
    assert [6, 0] in resting(pack, occupied, np.ones((1, 10), bool)).tolist()
    places = resting(pack, occupied, np.ones((3, 150), bool)).tolist()
    assert places == [[0, col] for col in range(51)] + [[4, col] for col in range(51)]


@twins
def test_a_mask_that_is_too_large_has_no_position(pack: Pack) -> None:
    occupied = np.zeros((4, 6), bool)
    for shape in ((5, 2), (4, 7)):
        assert resting(pack, occupied, np.ones(shape, bool)).shape == (0, 2)


@twins
@pytest.mark.parametrize("width", [1, 6, 8, 64, 65, 128, 200])
def test_a_mask_as_large_as_the_image(pack: Pack, width: int) -> None:
    occupied, mask = np.zeros((4, width), bool), np.ones((4, width), bool)
    assert resting(pack, occupied, mask).tolist() == [[0, 0]]
    for col in (0, width // 2, width - 1):
        occupied[0, col] = True
        assert resting(pack, occupied, mask).tolist() == []
        occupied[0, col] = False
    assert resting(pack, mask, np.ones((1, 1), bool)).tolist() == []


@twins
def test_threads_may_share_a_landscape(pack: Pack) -> None:
    rng = np.random.default_rng(0)
    occupied = np.vstack([np.zeros((8, 150), bool), rng.random((12, 150)) < 0.1])
    landscape = pack(occupied, skyline_numpy(occupied))
    outlines = [silhouette(np.ones((h, w), bool)) for h in range(1, 6) for w in range(1, 6)]
    alone = [landscape.resting(outline).tolist() for outline in outlines]
    with ThreadPoolExecutor(4) as pool:
        together = pool.map(landscape.resting, outlines * 4)
        assert [found.tolist() for found in together] == alone * 4
