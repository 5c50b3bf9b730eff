"""Where a mask rests: packed bits against loops over pixels (§3.6)."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import bits
from drystone.kernels.bits import bit_landscape
from drystone.kernels.lowering import skyline
from drystone.kernels.silhouette import silhouette
from tests.kernels.twins import both_ways
from tests.naive import placement as naive
from tests.strategies import landscapes, masks

kernel = both_ways(bits)


def resting(occupied, mask):
    return bit_landscape(occupied, skyline(occupied)).resting(silhouette(mask))


@pytest.mark.parametrize("stretch", [1, 13, 40])
@given(occupied=landscapes(9), mask=masks(5), shift=st.integers(0, 12), cut=st.integers(0, 12))
def test_rows_of_several_words_and_runs_longer_than_one(stretch, occupied, mask, shift, cut):
    wide = np.roll(np.repeat(occupied, stretch, axis=1), shift, axis=1)
    stone = np.repeat(mask, stretch, axis=1)[:, : mask.shape[1] * stretch - cut % stretch]
    fits = stone.shape[0] <= wide.shape[0] and stone.shape[1] <= wide.shape[1]
    expected = naive.resting_by_areas(wide, stone, naive.areas_by_fft) if fits else []
    found = resting(wide, stone)
    assert (found.dtype, found.flags.c_contiguous) == (np.int64, True)
    assert found.tolist() == [list(at) for at in expected]


@given(
    posts=st.lists(st.tuples(st.integers(0, 299), st.integers(1, 9)), max_size=4),
    length=st.integers(1, 300),
    heel=st.integers(0, 99),
    foot=st.integers(1, 99),
)
def test_long_masks_between_thin_posts_under_a_roof(posts, length, heel, foot):
    occupied = np.zeros((12, 300), bool)
    occupied[1] = True
    for col, height in posts:
        occupied[-height:, col] = True
    mask = np.ones((3, length), bool)
    mask[1:, :heel] = mask[1:, heel + 3 * foot :] = False
    mask[1:, min(heel, length - 1)] = True
    expected = naive.resting_by_areas(occupied, mask, naive.areas_by_fft)
    assert resting(occupied, mask).tolist() == [list(at) for at in expected]


@pytest.mark.parametrize("width", [1, 64, 65, 200])
def test_a_mask_as_large_as_the_image(width):
    occupied, mask = np.zeros((4, width), bool), np.ones((4, width), bool)
    assert resting(occupied, mask).tolist() == [[0, 0]]
    for col in (0, width // 2, width - 1):
        occupied[0, col] = True
        assert resting(occupied, mask).tolist() == []
        occupied[0, col] = False
    assert resting(mask, np.ones((1, 1), bool)).tolist() == []


def test_threads_may_share_a_landscape():
    rng = np.random.default_rng(0)
    occupied = np.vstack([np.zeros((8, 150), bool), rng.random((12, 150)) < 0.1])
    landscape = bit_landscape(occupied, skyline(occupied))
    outlines = [silhouette(np.ones((h, w), bool)) for h in range(1, 6) for w in range(1, 6)]
    alone = [landscape.resting(outline).tolist() for outline in outlines]
    with ThreadPoolExecutor(4) as pool:
        together = pool.map(landscape.resting, outlines * 4)
        assert [found.tolist() for found in together] == alone * 4
